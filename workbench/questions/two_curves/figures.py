"""Two curves with their bands, their difference and their tangents: one figure to hover and zoom, one still.

Verified by tests/unit/test_workbench_compared_page.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.text import for_matplotlib
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, MODEL_COLOURS
from workbench.charts.still_charts import png_bytes, stacked_axes
from workbench.questions.two_curves.pair import CurvePair

__all__ = ["compared_figure", "compared_still"]

type Array = NDArray[np.float64]
_CURVE, _REFERENCE = MODEL_COLOURS["ancf"], MODEL_COLOURS["fe"]
_TOLERANCE, _UNCERTAINTY = (0, 158, 115), (26, 26, 26)
_ROWS = ("load [N]", "difference [N]", "tangent [N/mm]")


def compared_figure(pair: CurvePair) -> str:
    """The piece of the page: loads, difference and tangents over one abscissa."""
    figure = empty_figure(f"{pair.reference.kind} [mm]", _ROWS[0])
    figure.update_layout(height=820, xaxis={"anchor": "y3", "rangemode": "normal"})
    for axis, title, domain in (
        ("yaxis", _ROWS[0], [0.48, 1.0]),
        ("yaxis2", _ROWS[1], [0.25, 0.43]),
        ("yaxis3", _ROWS[2], [0.0, 0.2]),
    ):
        style = {**figure.layout.yaxis.to_plotly_json(), "title": {"text": title}, "domain": domain}
        figure.update_layout({axis: style})
    figure.update_layout(yaxis2={"rangemode": "normal", "zeroline": True, "zerolinecolor": "#9aa0a6"})
    d = 1e3 * pair.samples.deflection
    for axis, name, low, high, shade, strength in _bands(pair):
        figure.add_scatter(
            x=np.concatenate([d, d[::-1]]),
            y=np.concatenate([high, low[::-1]]),
            fill="toself",
            fillcolor=f"rgba{(*shade, strength)}",
            line={"width": 0},
            name=name,
            legendgroup=name,
            showlegend=axis == "y",
            hoverinfo="skip",
            yaxis=axis,
        )
    for axis, name, y, colour, dash, unit in _lines(pair):
        figure.add_scatter(
            x=d, y=y, name=name, legendgroup=name, showlegend=axis == "y", mode="lines", yaxis=axis,
            line={"color": colour, "width": 2.5, "dash": dash}, hovertemplate=f"%{{y:.4g}} {unit}",
        )  # fmt: skip
    for one, colour in ((pair.reference, _REFERENCE), (pair.curve, _CURVE)):
        inside = _inside(pair, one.curve.deflection)
        figure.add_scatter(
            x=1e3 * one.curve.deflection[inside], y=one.curve.load[inside], mode="markers", showlegend=False,
            marker={"color": colour, "size": 6}, hoverinfo="skip",
        )  # fmt: skip
    return figure_html(figure, "compared")


def compared_still(pair: CurvePair) -> bytes:
    """The same as the content of a PNG file, in the file's own words for both curves."""
    figure, axes = stacked_axes((5.0, 2.0, 2.0), (9.0, 8.5))
    places = dict(zip(("y", "y2", "y3"), axes, strict=True))
    d = 1e3 * pair.samples.deflection
    for axis, name, low, high, shade, strength in _bands(pair):
        tint = tuple(part / 255.0 for part in shade)
        places[axis].fill_between(d, low, high, color=tint, alpha=strength, linewidth=0.0, label=name)
    for axis, name, y, colour, dash, _ in _lines(pair):
        style = "-" if dash == "solid" else "--"
        places[axis].plot(d, y, color=colour, linestyle=style, label=for_matplotlib(name))
    for one, colour in ((pair.reference, _REFERENCE), (pair.curve, _CURVE)):
        inside = _inside(pair, one.curve.deflection)
        axes[0].plot(1e3 * one.curve.deflection[inside], one.curve.load[inside], "o", color=colour, markersize=3.5)
    axes[1].axhline(0.0, color=INK, linewidth=0.8)
    axes[0].legend(frameon=False)
    for one, title in zip(axes, _ROWS, strict=True):
        one.set_ylabel(title)
    axes[2].set_xlabel(f"{pair.reference.kind} [mm]")
    return png_bytes(figure)


def _bands(pair: CurvePair) -> list[tuple[str, str, Array, Array, tuple[int, int, int], float]]:
    """Axis, name, lower and upper edge, colour and opacity of each band."""
    samples, found = pair.samples, []
    if pair.judgement.tolerance is not None:
        width = pair.judgement.tolerance * np.abs(samples.reference)
        name = f"reference ± {100.0 * pair.judgement.tolerance:.3g} % (tolerance)"
        found.append(("y", name, samples.reference - width, samples.reference + width, _TOLERANCE, 0.18))
        found.append(("y2", name, -width, width, _TOLERANCE, 0.18))
    if samples.uncertainty is not None:
        name, width = "uncertainty of the difference", samples.uncertainty
        found.append(("y", name, samples.reference - width, samples.reference + width, _UNCERTAINTY, 0.18))
        found.append(("y2", name, -width, width, _UNCERTAINTY, 0.18))
    return found


def _lines(pair: CurvePair) -> list[tuple[str, str, Array, str, str, str]]:
    """Axis, name, ordinate, colour, dash and unit of each line."""
    samples = pair.samples
    curve, reference = pair.curve.curve.model, f"{pair.reference.curve.model} (reference)"
    return [
        ("y", reference, samples.reference, _REFERENCE, "solid", "N"),
        ("y", curve, samples.load, _CURVE, "dash", "N"),
        ("y2", curve, samples.load - samples.reference, _CURVE, "dash", "N"),
        ("y3", reference, 1e-3 * samples.reference_tangent, _REFERENCE, "solid", "N/mm"),
        ("y3", curve, 1e-3 * samples.tangent, _CURVE, "dash", "N/mm"),
    ]


def _inside(pair: CurvePair, deflection: Array) -> Any:
    """Which points of a curve lie in the range compared."""
    return (deflection >= pair.metrics.start) & (deflection <= pair.metrics.end)
