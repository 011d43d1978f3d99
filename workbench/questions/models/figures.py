"""The models' averages together. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import add_line
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS
from workbench.questions.fe.figures import add_reference, add_uncertainty, add_users

if TYPE_CHECKING:
    from workbench.questions.models.results import ComparedModels
    from workbench.study.model import Study

__all__ = ["models_figures"]


def models_figures(study: Study, results: ComparedModels) -> dict[str, str]:
    """The averages of all models together, with the reference."""
    figure, continuum, fe = empty_figure(), results.continuum, results.continuum.fe.average
    add_reference(figure, study.reference)
    add_uncertainty(figure, fe, continuum.mesh_study)
    add_line(figure, fe, "FE average", MODEL_COLOURS["fe"], width=2.5)
    if results.ancf is not None:
        add_line(figure, results.ancf.average, "ANCF average", MODEL_COLOURS["ancf"], width=4.0, dash="dash")
    if results.brush is not None:
        add_line(figure, results.brush, "brush line", MODEL_COLOURS["brush"], width=3.0, dash="dot")
    add_users(figure, continuum.users)
    return {"models": figure_html(figure, "model-curves")}
