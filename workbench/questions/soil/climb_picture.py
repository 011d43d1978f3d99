"""Picture of the rover on slopes of soil: slip, and energy a metre, over the angle; rings where it runs in ruts.

Verified by tests/end_to_end/test_climb.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from contracts.text import for_matplotlib
from workbench.charts.palette import INK
from workbench.charts.still_charts import png_bytes, stacked_axes
from workbench.questions.soil.climb import STUCK, Climbs

__all__ = ["climb_png"]

_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_LINES = ("-", "--", ":", "-.")
_TOP = 1.1
"""Of the slip that is drawn: beyond it the rover slides back."""


def climb_png(climbs: Sequence[Climbs], title: str) -> bytes:
    """PNG; upwards, a colour for each soil and a line for each tire."""
    soils, tires = (tuple(dict.fromkeys(getattr(one, name) for one in climbs)) for name in ("soil", "tire"))
    figure, (slip, energy) = stacked_axes((1.2, 1.0), (6.4, 6.4))
    for one in climbs:
        if one.direction != "up":
            continue
        style = {"color": _COLOURS[soils.index(one.soil) % 6], "linestyle": _LINES[tires.index(one.tire) % 4]}
        rows = [row for row in one.rows if row.slip is not None]
        ruts = [row for row in rows if row.slip_in_ruts is not None and row.climbs]
        rings = {"color": style["color"], "marker": "o", "markersize": 5, "fillstyle": "none", "linestyle": "none"}
        label = f"{one.soil}, {one.tire}"
        slip.plot([r.angle_deg for r in rows], [r.slip for r in rows], marker="o", markersize=3, label=label, **style)
        slip.plot([r.angle_deg for r in ruts], [r.slip_in_ruts for r in ruts], **rings)
        some = [row for row in rows if row.energy is not None and row.climbs]
        energy.plot([r.angle_deg for r in some], [r.energy for r in some], marker="o", markersize=3, **style)
        energy.plot([r.angle_deg for r in ruts], [r.energy_in_ruts for r in ruts], **rings)
    slip.axhline(STUCK, color=INK, linewidth=0.6)
    slip.set_ylim(-0.1, _TOP)
    slip.set_title(for_matplotlib(title), fontsize=10, color=INK, loc="left")
    slip.set_ylabel("slip, upwards; rings: in ruts")
    energy.set_ylabel("energy of the drives [J/m]")
    energy.set_xlabel("slope [deg]")
    slip.legend(frameon=False, fontsize=8)
    return png_bytes(figure)
