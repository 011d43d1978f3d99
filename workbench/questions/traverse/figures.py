"""Figure of the question on the way between two samples. Verified by tests/unit/test_workbench_traverse.py."""

from __future__ import annotations

import numpy as np

from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import ORIENTATION_COLOURS
from workbench.questions.traverse.results import WIDTHS, Traverse

__all__ = ["traverse_figures"]


def traverse_figures(found: Traverse) -> dict[str, str]:
    """HTML by name: of each wheel, how many cycles of its load have a range or more."""
    figure = empty_figure("range of the wheel's load [N]", "cycles of that range or more")
    for tire, run in found.runs.items():
        for k, (wheel, counts) in enumerate(zip(found.wheels, run.load_cycles, strict=False)):
            more = np.cumsum(np.array(counts)[::-1])[::-1]
            line = {
                "color": ORIENTATION_COLOURS[k % len(ORIENTATION_COLOURS)],
                "width": 1.8,
                "dash": "solid" if tire == "brush" else "dash",
            }
            name = f"{wheel.replace('_', ' ')}, {tire}"
            x = WIDTHS["load"] * np.arange(len(more))
            figure.add_scatter(x=x, y=more, name=name, mode="lines", line={**line, "shape": "hv"})
    figure.update_yaxes(type="log", rangemode="normal")
    return {"traverse_cycles": figure_html(figure, "traverse-cycles")}
