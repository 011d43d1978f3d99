"""Picture of a bench: pull, torque and sinkage over slip, rigid beside flexible.

Verified by tests/end_to_end/test_drawbar.py.
"""

from __future__ import annotations

import numpy as np

from contracts.text import for_matplotlib
from workbench.charts.palette import INK
from workbench.charts.still_charts import png_bytes, stacked_axes
from workbench.questions.soil.bench import Bench

__all__ = ["bench_png"]

_FLEXIBLE, _RIGID = "#0072b2", "#9aa0a6"


def bench_png(bench: Bench, title: str) -> bytes:
    """PNG; the band is what the ranges of the soil's numbers leave open."""
    rows = [row for row in bench.rows if not (bench.towed and row is bench.rows[-1])] or list(bench.rows)
    slip = np.array([row.wheel.slip for row in rows])
    figure, (pull, torque, sinkage) = stacked_axes((1.2, 1.0, 1.0), (6.4, 7.2))
    if any(row.high > row.low for row in rows):
        pull.fill_between(slip, [r.low for r in rows], [r.high for r in rows], color=_FLEXIBLE, alpha=0.15, linewidth=0)
    both = bench.carcass != "rigid"
    for axis, name, factor in ((pull, "drawbar_pull", 1.0), (torque, "torque", 1.0), (sinkage, "sinkage", 1e3)):
        if both:
            stiff = [factor * getattr(row.rigid, name) for row in rows]
            axis.plot(slip, stiff, color=_RIGID, marker="o", markersize=3, label="rigid rim")
        values = [factor * getattr(row.wheel, name) for row in rows]
        label = "flexible wheel" if both else "rigid wheel"
        axis.plot(slip, values, color=_FLEXIBLE, marker="o", markersize=3, label=label)
    pull.axhline(0.0, color=INK, linewidth=0.6)
    pull.set_title(for_matplotlib(title), fontsize=10, color=INK, loc="left")
    pull.set_ylabel("drawbar pull [N]")
    torque.set_ylabel("torque [N m]")
    sinkage.set_ylabel("sinkage [mm]")
    sinkage.set_xlabel("slip")
    sinkage.invert_yaxis()
    pull.legend(frameon=False, fontsize=9)
    return png_bytes(figure)
