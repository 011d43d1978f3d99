"""Figure of the ANCF tire's curves. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from contracts.curves import StiffnessCurve
from workbench.charts.curves import add_line, add_orientations
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS
from workbench.questions.model_curves import ModelCurves

__all__ = ["ancf_figure"]


def ancf_figure(fe: StiffnessCurve, ancf: ModelCurves) -> str:
    """ANCF at each orientation and their average, with the FE average behind."""
    figure = empty_figure()
    add_line(figure, fe, "FE average", MODEL_COLOURS["fe"], width=2.0, dash="dot")
    add_orientations(figure, ancf.by_orientation, "ANCF", first_colour=1)
    add_line(figure, ancf.average, "ANCF average", MODEL_COLOURS["ancf"], width=4.0)
    return figure_html(figure, "ancf-curves")
