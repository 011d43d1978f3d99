"""Figures of the finite elements' verification: published curves with our points on them, and errors against cell size.

Verified by tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from contracts.published import published_table
from workbench.charts.interactive import figure_html
from workbench.charts.palette import INK, ORIENTATION_COLOURS
from workbench.questions.verification.published import (
    add_band,
    add_line,
    add_path,
    add_points,
    cantilever_figure,
    log_axes,
    low_figure,
)

__all__ = ["verification_figures"]

_BLUE, _ORANGE = ORIENTATION_COLOURS[:2]
_LAWS = {"st_venant_kirchhoff": ("St. Venant-Kirchhoff", "circle"), "neo_hookean": ("neo-Hookean", "square")}


def verification_figures(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """HTML of each figure by name, from the results of the tasks."""
    return {
        "ring": figure_html(_ring(numbers["ring"]), "verification-ring"),
        "orders": figure_html(_orders(numbers["manufactured"]), "verification-orders"),
        "cantilevers": figure_html(
            cantilever_figure(numbers["end_shear"], numbers["end_moment"]), "verification-cantilevers"
        ),
        "hemisphere": figure_html(_hemisphere(numbers["hemisphere"]), "verification-hemisphere"),
    }


def _ring(numbers: Mapping[str, Any]) -> Any:
    """Load against compression: elastica with its 1 % band, our points."""
    table = published_table("ring_between_plates_elastica")
    before = table["flat_half_over_R"] == 0.0  # the contact has not split; then 1 - c goes with 1 / sqrt(p)
    c, p = table["compression_over_D"][before], table["p"][before]
    beyond = np.linspace(c[-1], 0.62, 30)[1:]
    c, p = np.append(c, beyond), np.append(p, p[-1] * ((1.0 - c[-1]) / (1.0 - beyond)) ** 2)
    figure = low_figure("compression of the diameter [%]", "P R² / EI")
    add_band(figure, 100.0 * c, p, 0.01, "elastica ± 1 %")
    add_line(figure, 100.0 * c, p, "elastica", INK)
    add_points(figure, 100.0 * np.array(numbers["compression"]), numbers["load"], "27-node hexahedra", _BLUE, "circle")
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
                add_points(figure, sizes, found, f"{norm.upper()}, degree {degree}, {label}", colour, symbol)
                figure.data[-1].showlegend = False
            name = f"{norm.upper()}, degree {degree}: slope {order}"
            add_line(figure, sizes, found[0] * (sizes / sizes[0]) ** order, name, colour, dash)
    return figure


def _hemisphere(numbers: Mapping[str, Any]) -> Any:
    """Both radial displacements against load, published points on our lines."""
    figure = low_figure("load / full load", "displacement (R = 10)")
    for k, (way, colour) in enumerate((("outward, A", _BLUE), ("inward, B", _ORANGE))):
        add_path(figure, numbers, k, way, colour)
    return figure
