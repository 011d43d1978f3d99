"""Figures of the rover's scenarios, named after the thesis'. Verified by tests/unit/test_workbench_rover.py."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contracts.series import TimeSeries
from workbench.charts.curves import add_plain
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, ORIENTATION_COLOURS

__all__ = ["rover_figures"]

FloatArray = NDArray[np.float64]
RADIAL_STIFFNESS = 8250.0
"""Table II [N/m]."""
SPEED = 1e3 * 70.0 / 3600.0
"""70 m/h [mm/s]."""


LAWS = {"drop": "builds up", "drop_printed": "as printed"}
"""Scenario -> damper law."""
TOUCHDOWN = (0.06, 0.16)
"""First touch at 73 ms, and what follows [s]."""


def rover_figures(series: Mapping[str, TimeSeries]) -> dict[str, str]:
    """HTML by name; series by scenario."""
    straight, traction = series["straight"], series["traction"]
    drops = {law: series[name] for name, law in LAWS.items()}
    found = {
        "fig18": _against_time(drops, "body_z_m", "height of the body's centre [mm]", 1e3),
        "fig19": _against_time(drops, "front_right_load_N", "wheel load, front right [N]"),
        "touchdown": _against_time(drops, "front_right_load_N", "wheel load, front right [N]", between=TOUCHDOWN),
        "fig20": _sweep(series["load_sweep"]),
        "fig23": _against_time({"speed": straight}, "body_vx_m_s", "speed [mm/s]", 1e3, reference=SPEED),
        "fig24": _against_time(
            {"deflection": straight}, "front_right_deflection_m", "deflection, front right [mm]", 1e3
        ),
        "fig25": _against_time({"force": traction}, "front_right_tractive_N", "tractive force, front right [N]"),
    }
    return found | {"step": _wheels(series["step"])}


def _against_time(
    series: Mapping[str, TimeSeries],
    column: str,
    label: str,
    scale: float = 1.0,
    *,
    reference: float | None = None,
    between: tuple[float, float] | None = None,
) -> str:
    """One column of one scenario or of several, by what they are called."""
    figure = empty_figure("time [s]", label)
    for k, (name, one) in enumerate(series.items()):
        low, high = between or (0.0, np.inf)
        inside = (one.time >= low) & (one.time <= high)
        add_plain(figure, one.time[inside], scale * one[column][inside], name, ORIENTATION_COLOURS[k])
    figure.update_yaxes(rangemode="normal")
    if between is not None:
        figure.update_xaxes(range=between)
    if reference is not None:
        figure.add_hline(y=reference, line={"color": INK, "width": 1.2, "dash": "dot"}, annotation_text="70 m/h")
    first = next(iter(series.values())).scenario
    return figure_html(figure, f"rover-{first}-{column.replace('_', '-')}{'-closer' if between else ''}")


def _sweep(series: TimeSeries) -> str:
    """Wheel load against deflection, with the tire's static line."""
    figure = empty_figure("deflection [mm]", "wheel load [N]")
    deflection, load = series["front_right_deflection_m"], series["front_right_load_N"]
    add_plain(figure, 1e3 * deflection, RADIAL_STIFFNESS * deflection, "8250 N/m", ORIENTATION_COLOURS[1])
    figure.add_scatter(x=1e3 * deflection, y=load, name="rover, front right", mode="markers", marker={"size": 8})
    return figure_html(figure, "rover-load-sweep")


def _wheels(series: TimeSeries) -> str:
    """Loads of the wheels on the left while the rover climbs."""
    figure = empty_figure("time [s]", "wheel load, left side [N]")
    for k, end in enumerate(("front", "center", "rear")):
        add_plain(figure, series.time, series[f"{end}_left_load_N"], end, ORIENTATION_COLOURS[k])
    return figure_html(figure, "rover-step")
