"""Figures of the verification: our lines and points beside those published, errors against cell size or plates.

Verified by tests/unit/test_workbench_verification.py, tests/unit/test_workbench_verification_ancf.py and
tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from contracts.published import published_table
from workbench.charts.curves import add_area
from workbench.charts.interactive import figure_html, log_axes, log_axis, low_figure
from workbench.charts.palette import INK, ORIENTATION_COLOURS

__all__ = ["ancf_verification_figures", "verification_figures"]

_BLUE, _ORANGE, _GREEN, _PINK = ORIENTATION_COLOURS[:4]
_LAWS = {"st_venant_kirchhoff": ("St. Venant-Kirchhoff", "circle"), "neo_hookean": ("neo-Hookean", "square")}
_STUDIES = {
    "ancf_end_moment": "strip rolled to a circle",
    "ancf_end_shear": "end shear force",
    "ancf_frequencies": "free ring, frequency",
    "ancf_self_weight": "own weight",
    "ancf_bending": "narrow cantilever, relieved",
    "ancf_arch": "arch",
}


def verification_figures(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """HTML of each figure by name, from the results of the tasks."""
    return {
        "ring": figure_html(_ring(numbers["ring"]), "verification-ring"),
        "orders": figure_html(_orders(numbers["manufactured"]), "verification-orders"),
        "cantilevers": figure_html(
            _cantilever_figure(numbers["end_shear"], numbers["end_moment"]), "verification-cantilevers"
        ),
        "hemisphere": figure_html(_hemisphere(numbers["hemisphere"]), "verification-hemisphere"),
        "hinged_roof": figure_html(_snapping(numbers["hinged_roof"], ("centre",), "mm"), "verification-hinged-roof"),
        "pulled_cylinder": figure_html(
            _snapping(numbers["pulled_cylinder"], ("A, outward", "B, inward", "C, inward"), "R = 4.953"),
            "verification-pulled-cylinder",
        ),
    }


def _ring(numbers: Mapping[str, Any]) -> Any:
    """Load against compression: elastica with its 1 % band, our points."""
    table = published_table("ring_between_plates_elastica")
    before = table["flat_half_over_R"] == 0.0  # the contact has not split; then 1 - c goes with 1 / sqrt(p)
    c, p = table["compression_over_D"][before], table["p"][before]
    beyond = np.linspace(c[-1], 0.62, 30)[1:]
    c, p = np.append(c, beyond), np.append(p, p[-1] * ((1.0 - c[-1]) / (1.0 - beyond)) ** 2)
    figure = low_figure("compression of the diameter [%]", "P R² / EI")
    add_area(figure, 100.0 * c, 0.99 * p, 1.01 * p, "elastica ± 1 %")
    _add_line(figure, 100.0 * c, p, "elastica", INK)
    _add_points(figure, 100.0 * np.array(numbers["compression"]), numbers["load"], "27-node hexahedra", _BLUE, "circle")
    return figure


def _orders(numbers: Mapping[str, Any]) -> Any:
    """Errors of both laws and degrees against cell size, with lines of the theoretical slope."""
    figure = low_figure("cell size / edge of the cube", "error of the displacement")
    log_axes(figure, [0.1, 0.15, 0.2, 0.25, 0.3])
    for degree, dash in ((1, "solid"), (2, "dash")):
        for norm, colour, order in (("l2", _BLUE, degree + 1), ("h1", _ORANGE, degree)):
            for law, (label, symbol) in _LAWS.items():
                errors = numbers["laws"][law][str(degree)]
                sizes, found = 1.0 / np.array(errors["cells"]), np.array(errors[norm])
                _add_points(figure, sizes, found, f"{norm.upper()}, degree {degree}, {label}", colour, symbol)
                figure.data[-1].showlegend = False
            name = f"{norm.upper()}, degree {degree}: slope {order}"
            _add_line(figure, sizes, found[0] * (sizes / sizes[0]) ** order, name, colour, dash)
    return figure


def _hemisphere(numbers: Mapping[str, Any]) -> Any:
    """Both radial displacements against load, published points on our lines."""
    figure = low_figure("load / full load", "displacement (R = 10)")
    for k, (way, colour) in enumerate((("outward, A", _BLUE), ("inward, B", _ORANGE))):
        _add_path(figure, numbers, k, way, colour)
    return figure


def _snapping(numbers: Mapping[str, Any], ways: Sequence[str], unit: str) -> Any:
    """Load against each displacement along a path that turns back, published points on our curve."""
    figure = low_figure(f"displacement [{unit}]", "load / full load")
    table, load, ours = (np.array(numbers[key]) for key in ("table", "load", "deflection"))
    for k, (way, colour) in enumerate(zip(ways, (_BLUE, _ORANGE, _GREEN), strict=False)):
        _add_line(figure, [0.0, *ours[:, k]], [0.0, *load], f"{way}, ours", colour)
        _add_points(figure, table[:, 1 + k], table[:, 0], f"{way}, Sze et al.", colour, "circle-open")
    return figure


def ancf_verification_figures(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """HTML of each figure by name, from the results of the tasks."""
    cantilevers = _cantilever_figure(numbers["ancf_end_shear"], numbers["ancf_end_moment"])
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
        _add_line(figure, time, ours[:, i], f"{axis}, ours", colour)
        _add_points(figure, time, published[:, i], f"{axis}, reference", colour, "circle-open")
    return figure


def _distance(numbers: Mapping[str, Any]) -> Any:
    """Distance of the corner from the reference with two time steps, and the limit."""
    figure = low_figure("time [s]", "distance from the reference [m]")
    time = numbers["time_s"]
    for (step, distance), colour in zip(numbers["distance_m"].items(), (_ORANGE, _BLUE), strict=True):
        _add_line(figure, time, distance, f"{step} of the stable step", colour)
    _add_line(figure, [time[0], time[-1]], [1e-5, 1e-5], "limit", INK, "dash")
    log_axis(figure)
    return figure


def _convergence(numbers: Mapping[str, Mapping[str, Any]]) -> Any:
    """Errors against the number of plates, with a line of slope 4."""
    figure = low_figure("plates", "error")
    log_axes(figure, [8, 12, 16, 24, 32, 48])
    for (name, label), colour in zip(_STUDIES.items(), ORIENTATION_COLOURS, strict=False):
        meshes = numbers[name]["meshes"]
        plates, errors = [int(mesh.split()[0]) for mesh in meshes], list(meshes.values())
        _add_line(figure, plates, errors, label, colour)
        _add_points(figure, plates, errors, label, colour, "circle")
        figure.data[-1].showlegend = False
    _add_line(figure, [12, 48], [3.0, 3.0 / 4.0**4], "slope 4", INK, "dash")
    return figure


def _cantilever_figure(shear: Mapping[str, Any], moment: Mapping[str, Any]) -> Any:
    """Deflection and shortening over length of Sze, Liu and Lo's two cantilevers against load, their points on ours."""
    figure = low_figure("load / full load", "displacement / length")
    cases = ((shear, "shear", 10.0, (_GREEN, _BLUE)), (moment, "moment", 12.0, (_PINK, _ORANGE)))
    for numbers, label, length, colours in cases:
        for k, way in enumerate(("shortening", "deflection")):
            _add_path(figure, numbers, k, f"{label}: {way}", colours[k], 1.0 / length)
    return figure


def _add_path(figure: Any, numbers: Mapping[str, Any], k: int, name: str, colour: str, scale: float = 1.0) -> None:
    """One displacement of a load path: ours as a line from rest, the published ones as points."""
    table, ours = np.array(numbers["table"]), np.array(numbers["deflection"])[:, k]
    _add_line(figure, [0.0, *numbers["load"]], scale * np.append(0.0, ours), f"{name}, ours", colour)
    _add_points(figure, table[:, 0], scale * table[:, 1 + k], f"{name}, Sze et al.", colour, "circle-open")


def _add_line(figure: Any, x: Any, y: Any, name: str, colour: str, dash: str = "solid") -> None:
    """A curve."""
    line = {"color": colour, "width": 1.8, "dash": dash}
    figure.add_scatter(x=x, y=y, name=name, mode="lines", line=line, hovertemplate="%{y:.4g}")


def _add_points(figure: Any, x: Any, y: Any, name: str, colour: str, symbol: str) -> None:
    """Single points."""
    marker = {"color": colour, "symbol": symbol, "size": 8}
    figure.add_scatter(x=x, y=y, name=name, mode="markers", marker=marker, hovertemplate="%{y:.4g}")
