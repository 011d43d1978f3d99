"""Figures of load over orientation. Verified by tests/end_to_end/test_full_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import ORIENTATION_COLOURS

if TYPE_CHECKING:
    from workbench.questions.orientations.results import OrientationMap
    from workbench.study.model import Study

__all__ = ["orientation_figures"]

_LINES_EVERY = 5e-3
_MAP_EVERY = 1e-3


def orientation_figures(study: Study, found: OrientationMap) -> dict[str, str]:
    """Load against orientation at a few deflections, and the map of load over orientation and deflection."""
    deflections, fine = found.deflections(_LINES_EVERY), found.deflections(_MAP_EVERY)
    lines = empty_figure("orientation [deg]")
    for i, (deflection, loads) in enumerate(zip(deflections, found.loads(deflections), strict=True)):
        lines.add_scatter(
            x=found.orientations,
            y=loads,
            name=f"{1e3 * deflection:g} mm",
            mode="lines+markers",
            line={"color": ORIENTATION_COLOURS[i % 6], "width": 2.0},
            hovertemplate="%{y:.1f} N",
        )
    surface = empty_figure("orientation [deg]", "radial deflection [mm]")
    surface.add_contour(
        x=found.orientations,
        y=1e3 * fine,
        z=found.loads(fine),
        colorscale="Viridis",
        contours={"showlabels": True, "labelfont": {"size": 12, "color": "white"}},
        colorbar={"title": {"text": "load [N]"}},
        hovertemplate="%{x:g}°, %{y:g} mm: %{z:.1f} N<extra></extra>",
    )
    surface.update_layout(hovermode="closest")
    return {
        "orientation_lines": figure_html(lines, "orientation-lines"),
        "orientation_map": figure_html(surface, "orientation-map"),
    }
