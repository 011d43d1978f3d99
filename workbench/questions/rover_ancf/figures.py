"""Figures of the rover on ANCF tires beside the brush tires. Verified by tests/unit/test_workbench_rover_ancf.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from workbench.charts.curves import add_plain
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.questions.rover.oscillation import spectrum

if TYPE_CHECKING:
    from workbench.questions.rover_ancf.results import AncfRover
    from workbench.study.model import Study

__all__ = ["rover_ancf_figures"]

FloatArray = NDArray[np.float64]
_WHEEL = "front_right"


def rover_ancf_figures(study: Study, results: AncfRover) -> dict[str, str]:
    """HTML by name, after the thesis' figures."""
    return {
        "rover_ancf_fig18": _both(results, "drop", f"{_WHEEL}_load_N", "wheel load, front right [N]", until=1.0),
        "rover_ancf_fig19": _both(
            results, "drop", f"{_WHEEL}_deflection_m", "deflection, front right [mm]", 1e3, until=1.0
        ),
        "rover_ancf_fig22": _sweep(results),
        "rover_ancf_fig23": _both(results, "straight", "body_vx_m_s", "speed [mm/s]", 1e3),
        "rover_ancf_fig24": _both(
            results, "straight", f"{_WHEEL}_deflection_m", "deflection, front right [mm]", 1e3, since=15.0, until=35.0
        ),
        "rover_ancf_fig25": _both(
            results, "traction", f"{_WHEEL}_tractive_N", "tractive force, front right [N]", until=2.0
        ),
        "rover_ancf_spectrum": _spectrum(results),
    }


def _both(
    results: AncfRover,
    name: str,
    column: str,
    label: str,
    scale: float = 1.0,
    *,
    since: float = 0.0,
    until: float = np.inf,
) -> str:
    """One column of one scenario on both kinds of tires between two times."""
    figure = empty_figure("time [s]", label)
    for tire, drive in (("brush", results.brush[name]), ("ancf", results[name])):
        series = drive.series
        if series is not None:
            inside = (series.time >= since) & (series.time <= until)
            add_plain(figure, series.time[inside], scale * series[column][inside], tire, MODEL_COLOURS[tire])
    figure.update_yaxes(rangemode="normal")
    return figure_html(figure, f"rover-ancf-{name}-{column.replace('_', '-')}")


def _sweep(results: AncfRover) -> str:
    """Wheel load against deflection on spokes and between them, with the FE average and the brush tire."""
    figure = empty_figure("deflection [mm]", "wheel load [N]")
    brush = results.brush["load_sweep"].series
    add_plain(figure, 1e3 * results.fe.deflection, results.fe.load, "FE average", MODEL_COLOURS["fe"])
    if brush is not None:
        add_plain(
            figure, 1e3 * brush[f"{_WHEEL}_deflection_m"], brush[f"{_WHEEL}_load_N"], "brush", MODEL_COLOURS["brush"]
        )
    for k, (name, words) in enumerate((("load_sweep", "on a spoke"), ("load_sweep_between", "between spokes"))):
        rows = np.array([[d, N] for run, N, d, _ in results.sweep if run == name]).reshape(-1, 2)
        add_plain(
            figure, 1e3 * rows[:, 0], rows[:, 1], f"ANCF, {words}", ORIENTATION_COLOURS[(0, 5)[k]], mode="lines+markers"
        )
    return figure_html(figure, "rover-ancf-load-sweep")


def _spectrum(results: AncfRover) -> str:
    """Amplitudes of the tractive force, with half the step and a finer grid."""
    figure = empty_figure("frequency [Hz]", "amplitude of the tractive force [N]")
    runs = {"traction": "ANCF", "traction_half_step": "half the step", "traction_fine_grid": "twice the contact points"}
    for k, (name, words) in enumerate(runs.items()):
        if results[name].series is None:
            continue
        time, force = results.window(name, f"{_WHEEL}_tractive_N", (0.2, 2.0))
        add_plain(figure, *spectrum(time, force), words, (INK, *ORIENTATION_COLOURS)[k])
    return figure_html(figure, "rover-ancf-spectrum")
