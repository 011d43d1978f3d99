"""Figure of the ANCF wheel beside the solid model. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contracts.errors import InputError
from workbench.charts.curves import DASHES, MARKERS
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import ORIENTATION_COLOURS
from workbench.questions.ancf_wheel.results import differences

if TYPE_CHECKING:
    from workbench.questions.ancf_wheel.results import AncfWheelRuns
    from workbench.study.model import Study

__all__ = ["ancf_wheel_figures"]


def ancf_wheel_figures(study: Study, runs: AncfWheelRuns) -> dict[str, str]:
    """Difference of load at each orientation against deflection, with both limits."""
    figure = empty_figure()
    for i, (curve, solid) in enumerate(runs.pairs):
        other = (i + i // 6) % 6  # the colours repeat: with other dashes and symbols
        try:
            at, found = differences(curve, solid)
        except InputError:
            continue
        figure.add_scatter(
            x=1e3 * at,
            y=100.0 * found,
            name=f"{curve.orientation_deg:g}°",
            mode="lines+markers",
            line={"color": ORIENTATION_COLOURS[i % 6], "dash": DASHES[other]},
            marker={"symbol": MARKERS[other], "size": 8},
            hovertemplate="%{y:.2f} %",
        )
    limit = 100.0 * study.tolerances.ancf_wheel_largest
    for y in (-limit, limit):
        figure.add_hline(y=y, line={"width": 1, "dash": "dot", "color": "#777"})
    figure.update_yaxes(title_text="Load against the solid model [%]")
    figure.update_xaxes(title_text="Deflection [mm]")
    return {"ancf_wheel": figure_html(figure, "ancf-wheel-differences")}
