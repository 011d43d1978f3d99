"""Figures of wheels in motion. Verified by tests/unit/test_workbench_ancf_dynamics.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, MODEL_COLOURS

if TYPE_CHECKING:
    from contracts.series import TimeSeries
    from workbench.questions.ancf_dynamics.results import AncfMotions
    from workbench.study.model import Study

__all__ = ["motion_figures"]


def motion_figures(study: Study, results: AncfMotions) -> dict[str, str]:
    """One of each motion, by its name."""
    return {motion.name: _figure(motion.name, motion.series, results.radius) for motion in results.motions}


def _figure(name: str, series: TimeSeries, radius: float) -> str:
    """Height of the hub over the nominal radius [mm] and load of the ground [N] against time.

    series : with the columns hub_z_m and load_z_N
    """
    figure = empty_figure("time [s]", "vertical load [N]")
    time, height, load = series.time, 1e3 * (series["hub_z_m"] - radius), series["load_z_N"]
    line = {"color": MODEL_COLOURS["ancf"], "width": 2.5}
    figure.add_scatter(x=time, y=load, name="load", mode="lines", line=line, hovertemplate="%{y:.0f} N")
    figure.add_scatter(
        x=time,
        y=height,
        name="hub above the nominal radius",
        mode="lines",
        line={"color": INK, "width": 1.5, "dash": "dot"},
        yaxis="y2",
        hovertemplate="%{y:.1f} mm",
    )
    title = {"text": "hub [mm]", "font": {"size": 13}, "standoff": 14}
    right = {"title": title, "overlaying": "y", "side": "right", "showgrid": False, "zeroline": False}
    figure.update_layout(yaxis2={**right, "tickmode": "auto", "ticks": "outside", "tickcolor": "#9aa0a6"}, margin_r=84)
    return figure_html(figure, f"ancf-{name}")
