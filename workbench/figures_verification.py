"""Figures of the verification: published curves with our points on them, and errors against cell size.

Verified by tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from contracts.published import published_table
from workbench.figures_plotly import empty_figure, figure_html
from workbench.palette import BAND, INK, ORIENTATION_COLOURS

__all__ = ["verification_figures"]

_BLUE, _ORANGE, _GREEN, _PINK = ORIENTATION_COLOURS[:4]
_LAWS = {"st_venant_kirchhoff": ("St. Venant-Kirchhoff", "circle"), "neo_hookean": ("neo-Hookean", "square")}


def verification_figures(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """HTML of each figure by name, from the results of the tasks."""
    return {
        "ring": figure_html(_ring(numbers["ring"]), "verification-ring"),
        "orders": figure_html(_orders(numbers["manufactured"]), "verification-orders"),
        "cantilevers": figure_html(_cantilevers(numbers), "verification-cantilevers"),
        "hemisphere": figure_html(_hemisphere(numbers["hemisphere"]), "verification-hemisphere"),
    }


def _ring(numbers: Mapping[str, Any]) -> Any:
    """Load against compression: elastica with its 1 % band, our points."""
    table = published_table("ring_between_plates_elastica")
    before = table["flat_half_over_R"] == 0.0  # the contact has not split; then 1 - c goes with 1 / sqrt(p)
    c, p = table["compression_over_D"][before], table["p"][before]
    beyond = np.linspace(c[-1], 0.62, 30)[1:]
    c, p = np.append(c, beyond), np.append(p, p[-1] * ((1.0 - c[-1]) / (1.0 - beyond)) ** 2)
    figure = _figure("compression of the diameter [%]", "P R² / EI")
    _band(figure, 100.0 * c, p, 0.01, "elastica ± 1 %")
    _line(figure, 100.0 * c, p, "elastica", INK)
    _points(figure, 100.0 * np.array(numbers["compression"]), numbers["load"], "27-node hexahedra", _BLUE, "circle")
    return figure


def _orders(numbers: Mapping[str, Any]) -> Any:
    """Errors of both laws and degrees against cell size, with lines of the theoretical slope."""
    figure = _figure("cell size / edge of the cube", "error of the displacement")
    figure.update_xaxes(type="log", rangemode="normal", tickvals=[0.1, 0.15, 0.2, 0.25, 0.3])
    figure.update_yaxes(type="log", rangemode="normal", exponentformat="power", dtick=1, title_standoff=12)
    figure.update_layout(margin_l=84)
    for degree, dash in ((1, "solid"), (2, "dash")):
        for norm, colour, order in (("l2", _BLUE, degree + 1), ("h1", _ORANGE, degree)):
            for law, (label, symbol) in _LAWS.items():
                errors = numbers["laws"][law][str(degree)]
                sizes, found = 1.0 / np.array(errors["cells"]), np.array(errors[norm])
                _points(figure, sizes, found, f"{norm.upper()}, degree {degree}, {label}", colour, symbol)
                figure.data[-1].showlegend = False
            name = f"{norm.upper()}, degree {degree}: slope {order}"
            _line(figure, sizes, found[0] * (sizes / sizes[0]) ** order, name, colour, dash)
    return figure


def _cantilevers(numbers: Mapping[str, Mapping[str, Any]]) -> Any:
    """Deflection and shortening over length against load, published points on our lines."""
    figure = _figure("load / full load", "displacement / length")
    cases = (("end_shear", "shear", 10.0, (_GREEN, _BLUE)), ("end_moment", "moment", 12.0, (_PINK, _ORANGE)))
    for name, label, length, colours in cases:
        for k, way in enumerate(("shortening", "deflection")):
            _path(figure, numbers[name], k, f"{label}: {way}", colours[k], 1.0 / length)
    return figure


def _hemisphere(numbers: Mapping[str, Any]) -> Any:
    """Both radial displacements against load, published points on our lines."""
    figure = _figure("load / full load", "displacement (R = 10)")
    for k, (way, colour) in enumerate((("outward, A", _BLUE), ("inward, B", _ORANGE))):
        _path(figure, numbers, k, way, colour)
    return figure


def _path(figure: Any, numbers: Mapping[str, Any], k: int, name: str, colour: str, scale: float = 1.0) -> None:
    """One displacement of a load path: ours as a line from rest, the published ones as points."""
    table, ours = np.array(numbers["table"]), np.array(numbers["deflection"])[:, k]
    _line(figure, [0.0, *numbers["load"]], scale * np.append(0.0, ours), f"{name}, ours", colour)
    _points(figure, table[:, 0], scale * table[:, 1 + k], f"{name}, Sze et al.", colour, "circle-open")


def _figure(x: str, y: str) -> Any:
    figure = empty_figure(x, y)
    figure.update_layout(height=430, legend={"font": {"size": 11}})
    return figure


def _line(figure: Any, x: Any, y: Any, name: str, colour: str, dash: str = "solid") -> None:
    line = {"color": colour, "width": 1.8, "dash": dash}
    figure.add_scatter(x=x, y=y, name=name, mode="lines", line=line, hovertemplate="%{y:.4g}")


def _points(figure: Any, x: Any, y: Any, name: str, colour: str, symbol: str) -> None:
    marker = {"color": colour, "symbol": symbol, "size": 8}
    figure.add_scatter(x=x, y=y, name=name, mode="markers", marker=marker, hovertemplate="%{y:.4g}")


def _band(figure: Any, x: Any, y: Any, share: float, name: str) -> None:
    figure.add_scatter(
        x=np.append(x, x[::-1]),
        y=np.append(y * (1.0 - share), (y * (1.0 + share))[::-1]),
        fill="toself",
        fillcolor=BAND,
        line={"width": 0},
        name=name,
        hoverinfo="skip",
    )
