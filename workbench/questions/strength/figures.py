"""Figures of the question on strength. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.charts.curves import add_plain
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, ORIENTATION_COLOURS
from workbench.questions.strength.yielding import StrengthResults, utilisation

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["strength_figures"]


def strength_figures(study: Study, results: StrengthResults) -> dict[str, str]:
    """Utilisation of the most stressed part at each orientation, and of each part at its worst orientation."""
    around = empty_figure("load on the wheel [N]", "largest stress / yield strength")
    for i, (orientation, curve) in enumerate(results.curves.items()):
        most = np.max(list(utilisation(curve, results.yield_strength).values()), axis=0)
        add_plain(around, curve.load, most, f"{orientation:g}°", ORIENTATION_COLOURS[i % 6], mode="lines+markers")
    parts = empty_figure("load on the wheel [N]", "largest stress / yield strength")
    for i, (part, (orientation, _)) in enumerate(results.by_part.items()):
        curve = results.curves[orientation]
        name = f"{part.replace('_', ' ')}, {orientation:g}°"
        used = utilisation(curve, results.yield_strength)[part]
        add_plain(parts, curve.load, used, name, ORIENTATION_COLOURS[i % 6], width=2.5)
    for figure in (around, parts):
        figure.add_hline(y=1.0, line={"color": INK, "width": 1, "dash": "dash"}, annotation={"text": "yield"})
    return {
        "yield_by_orientation": figure_html(around, "yield-by-orientation"),
        "yield_by_part": figure_html(parts, "yield-by-part"),
    }
