"""Figures of the plates' verification: the pendulum's path, Sze's cantilevers, errors against the number of plates.

Verified by tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from workbench.charts.interactive import figure_html
from workbench.charts.palette import INK, ORIENTATION_COLOURS
from workbench.questions.verification.published import add_line, add_points, cantilever_figure, log_axes, low_figure

__all__ = ["ancf_verification_figures"]

_BLUE, _ORANGE, _GREEN = ORIENTATION_COLOURS[:3]
_STUDIES = {
    "ancf_end_moment": "strip rolled to a circle",
    "ancf_end_shear": "end shear force",
    "ancf_frequencies": "free ring, frequency",
    "ancf_self_weight": "own weight",
    "ancf_bending": "narrow cantilever, relieved",
    "ancf_arch": "arch",
}


def ancf_verification_figures(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """HTML of each figure by name, from the results of the tasks."""
    cantilevers = cantilever_figure(numbers["ancf_end_shear"], numbers["ancf_end_moment"])
    return {
        "ancf_pendulum": figure_html(_pendulum(numbers["ancf_pendulum"]), "verification-ancf-pendulum"),
        "ancf_distance": figure_html(_distance(numbers["ancf_pendulum"]), "verification-ancf-distance"),
        "ancf_cantilevers": figure_html(cantilevers, "verification-ancf-cantilevers"),
        "ancf_convergence": figure_html(_convergence(numbers), "verification-ancf-convergence"),
    }


def _pendulum(numbers: Mapping[str, Any]) -> Any:
    """Path of the free corner, published points on our lines."""
    figure = low_figure("time [s]", "free corner [m]")
    time, ours, published = (np.array(numbers[key]) for key in ("time_s", "corner_m", "published_m"))
    for i, (axis, colour) in enumerate(zip("xyz", (_ORANGE, _GREEN, _BLUE), strict=True)):
        add_line(figure, time, ours[:, i], f"{axis}, ours", colour)
        add_points(figure, time, published[:, i], f"{axis}, reference", colour, "circle-open")
    return figure


def _distance(numbers: Mapping[str, Any]) -> Any:
    """Distance of the corner from the reference with two time steps, and the limit."""
    figure = low_figure("time [s]", "distance from the reference [m]")
    time = numbers["time_s"]
    for (step, distance), colour in zip(numbers["distance_m"].items(), (_ORANGE, _BLUE), strict=True):
        add_line(figure, time, distance, f"{step} of the stable step", colour)
    add_line(figure, [time[0], time[-1]], [1e-5, 1e-5], "limit", INK, "dash")
    figure.update_yaxes(type="log", rangemode="normal", exponentformat="power", dtick=1, title_standoff=12)
    figure.update_layout(margin_l=84)
    return figure


def _convergence(numbers: Mapping[str, Mapping[str, Any]]) -> Any:
    """Errors against the number of plates, with a line of slope 4."""
    figure = low_figure("plates", "error")
    log_axes(figure, [8, 12, 16, 24, 32, 48])
    for (name, label), colour in zip(_STUDIES.items(), ORIENTATION_COLOURS, strict=False):
        meshes = numbers[name]["meshes"]
        plates, errors = [int(mesh.split()[0]) for mesh in meshes], list(meshes.values())
        add_line(figure, plates, errors, label, colour)
        add_points(figure, plates, errors, label, colour, "circle")
        figure.data[-1].showlegend = False
    add_line(figure, [12, 48], [3.0, 3.0 / 4.0**4], "slope 4", INK, "dash")
    return figure
