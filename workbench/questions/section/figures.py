"""Figure of the planar beside the solid model. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import DASHES, MARKERS, add_line, named
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS, ORIENTATION_COLOURS

if TYPE_CHECKING:
    from workbench.questions.section.results import SectionRuns
    from workbench.study.model import Study

__all__ = ["section_figures"]


def section_figures(study: Study, runs: SectionRuns) -> dict[str, str]:
    """Section model at each orientation as lines, the solid model's points on them, both averages."""
    figure, section, fe = empty_figure(), runs.section, runs.fe
    for i, (orientation, curve) in enumerate(section.by_orientation.items()):
        colour = ORIENTATION_COLOURS[i % 6]
        add_line(figure, curve, f"section {orientation:g}°", colour, width=1.8, dash=DASHES[i % 6])
        solid = fe.by_orientation.get(orientation)
        if solid is not None:
            figure.add_scatter(
                x=solid.deflection * 1e3,
                y=solid.load,
                name=named(f"solid {orientation:g}°", solid),
                mode="markers",
                marker={"symbol": MARKERS[i % 6], "size": 6, "color": colour},
                hovertemplate="%{y:.1f} N",
            )
    add_line(figure, section.average, "section average", MODEL_COLOURS["section"], width=4.0)
    add_line(figure, fe.average, "solid average", MODEL_COLOURS["fe"], width=2.0, dash="dot")
    return {"section": figure_html(figure, "section-curves")}
