"""The models' averages together. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from collections.abc import Sequence

from contracts.curves import StiffnessCurve
from workbench.charts.curves import add_line
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS
from workbench.questions.fe.figures import add_band, add_uncertainty, add_users
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import UserCurve
from workbench.study.model import Band

__all__ = ["models_figure"]


def models_figure(
    fe: StiffnessCurve,
    study: MeshStudy | None,
    users: Sequence[UserCurve],
    band: Band | None,
    *,
    ancf: StiffnessCurve | None,
    brush: StiffnessCurve | None,
) -> str:
    """The averages of all models together, with the band and the user's curves."""
    figure = empty_figure()
    add_band(figure, band)
    add_uncertainty(figure, fe, study)
    add_line(figure, fe, "FE average", MODEL_COLOURS["fe"], width=4.0)
    if ancf is not None:
        add_line(figure, ancf, "ANCF average", MODEL_COLOURS["ancf"], width=4.0, dash="dash")
    if brush is not None:
        add_line(figure, brush, "brush line", MODEL_COLOURS["brush"], width=3.0, dash="dot")
    add_users(figure, users)
    return figure_html(figure, "model-curves")
