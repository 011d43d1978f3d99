"""Figure of the ANCF tire's curves. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import add_line, add_orientations
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS

if TYPE_CHECKING:
    from workbench.questions.ancf.results import AncfTireResults
    from workbench.study.model import Study

__all__ = ["ancf_figures"]


def ancf_figures(study: Study, results: AncfTireResults) -> dict[str, str]:
    """ANCF at each orientation and their average, with the FE average behind."""
    figure, ancf = empty_figure(), results.ancf
    add_line(figure, results.fe_average, "FE average", MODEL_COLOURS["fe"], width=2.0, dash="dot")
    add_orientations(figure, ancf.by_orientation, "ANCF", first_colour=1)
    add_line(figure, ancf.average, "ANCF average", MODEL_COLOURS["ancf"], width=4.0)
    return {"ancf": figure_html(figure, "ancf-curves")}
