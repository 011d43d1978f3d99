"""Figures of the rover's scenarios, named after the thesis'. Verified by tests/unit/test_workbench_rover.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from contracts.series import TimeSeries
from workbench.figures_plotly import empty_figure, figure_html
from workbench.palette import INK, ORIENTATION_COLOURS

__all__ = ["rover_figures"]

FloatArray = NDArray[np.float64]
RADIAL_STIFFNESS = 8250.0
"""Table II [N/m]."""


def rover_figures(series: Mapping[str, TimeSeries]) -> dict[str, str]:
    """HTML by name; series by scenario."""
    drop, straight, traction = series["drop"], series["straight"], series["traction"]
    found = {
        "fig18": _against_time(drop, "body_z_m", "height of the body's centre [mm]", 1e3),
        "fig19": _against_time(drop, "front_right_load_N", "wheel load, front right [N]"),
        "fig20": _sweep(series["load_sweep"]),
        "fig23": _against_time(straight, "body_vx_m_s", "speed [mm/s]", 1e3, reference=1e3 * 70.0 / 3600.0),
        "fig24": _against_time(straight, "front_right_deflection_m", "deflection, front right [mm]", 1e3),
        "fig25": _against_time(traction, "front_right_tractive_N", "tractive force, front right [N]"),
    }
    return found | {"step": _wheels(series["step"])}


def _against_time(
    series: TimeSeries, column: str, label: str, scale: float = 1.0, reference: float | None = None
) -> str:
    figure = empty_figure("time [s]", label)
    _line(figure, series.time, scale * series[column], label, 0)
    figure.update_yaxes(rangemode="normal")
    if reference is not None:
        figure.add_hline(y=reference, line={"color": INK, "width": 1.2, "dash": "dot"}, annotation_text="70 m/h")
    return figure_html(figure, f"rover-{series.scenario}-{column.replace('_', '-')}")


def _sweep(series: TimeSeries) -> str:
    """Wheel load against deflection, with the tire's static line."""
    figure = empty_figure("deflection [mm]", "wheel load [N]")
    deflection, load = series["front_right_deflection_m"], series["front_right_load_N"]
    _line(figure, 1e3 * deflection, RADIAL_STIFFNESS * deflection, "8250 N/m", 1)
    figure.add_scatter(x=1e3 * deflection, y=load, name="rover, front right", mode="markers", marker={"size": 8})
    return figure_html(figure, "rover-load-sweep")


def _wheels(series: TimeSeries) -> str:
    """Loads of the wheels on the left while the rover climbs."""
    figure = empty_figure("time [s]", "wheel load, left side [N]")
    for k, end in enumerate(("front", "center", "rear")):
        _line(figure, series.time, series[f"{end}_left_load_N"], end, k)
    return figure_html(figure, "rover-step")


def _line(figure: object, x: FloatArray, y: FloatArray | Sequence[float], name: str, colour: int) -> None:
    figure.add_scatter(  # type: ignore[attr-defined]
        x=x, y=y, name=name, mode="lines", line={"color": ORIENTATION_COLOURS[colour], "width": 2.0}
    )
