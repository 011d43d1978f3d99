"""Figures of the wheel on soil. Verified by tests/unit/test_workbench_soil.py."""

from __future__ import annotations

from collections.abc import Sequence

from workbench.charts.interactive import figure_html, low_figure
from workbench.charts.palette import ORIENTATION_COLOURS
from workbench.questions.soil.bench import Bench
from workbench.questions.soil.results import Held

__all__ = ["soil_figures"]


def soil_figures(benches: Sequence[Bench], held: Held) -> dict[str, str]:
    """HTML by name: pull over slip on each soil, and the laws beside the measured points."""
    pulls = low_figure("slip", "drawbar pull [N]")
    for bench, colour in zip(benches, ORIENTATION_COLOURS, strict=False):
        rows = [row for row in bench.rows if row.wheel.slip >= 0.0]
        slip = [row.wheel.slip for row in rows]
        for name, of, dash in (("", "wheel", "solid"), (", rigid rim", "rigid", "dot")):
            pull = [getattr(row, of).drawbar_pull for row in rows]
            style = {"color": colour, "width": 2.2, "dash": dash}
            pulls.add_scatter(x=slip, y=pull, name=f"{bench.soil}{name}", mode="lines", line=style)
    pulls.update_yaxes(rangemode="normal")
    measured = low_figure("slip", "drawbar pull [N]")
    measured.add_scatter(
        x=held.slip, y=[row[0] for row in held.measured], name="measured", mode="markers", marker={"color": "#1a1a1a"}
    )
    for one, colour in zip(held.refinements, ORIENTATION_COLOURS, strict=False):
        style = {"color": colour, "width": 3.0 if one.name == "all three" else 1.4}
        measured.add_scatter(x=held.slip, y=[row[0] for row in one.values], name=one.name, mode="lines", line=style)
    measured.update_yaxes(rangemode="normal")
    return {
        "soil_pull": figure_html(pulls, "soil-pull"),
        "soil_measured": figure_html(measured, "soil-measured"),
    }
