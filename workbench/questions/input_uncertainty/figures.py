"""The band of the samples, and which input moves what. Verified by tests/unit/test_workbench_input_uncertainty.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contracts.errors import InputError
from workbench.charts.curves import add_area, add_line, add_plain
from workbench.charts.interactive import Figure, empty_figure, figure_html
from workbench.charts.palette import BAND, INK, MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.study.key_units import parts_of
from workbench.study.sweep import tied_keys

if TYPE_CHECKING:
    from workbench.questions.input_uncertainty.results import Output, Sampled
    from workbench.study.model import Study

__all__ = ["in_words", "inputs_figures", "shown_outputs"]

_LEFT, _RIGHT, _APART, _BAR = -2.9, 1.05, 0.2, 9.0
"""Ends of the axis of correlations, whose left part the names take; half the distance of two bars, their width."""


def inputs_figures(study: Study, found: Sampled) -> dict[str, str]:
    """Band and bars."""
    return {
        "input_band": figure_html(_band(found), "inputs-band"),
        "input_ranks": figure_html(_ranks(study, found), "inputs-ranks"),
    }


def _band(found: Sampled) -> Figure:
    """Shaded: 5 to 95 %; lines: median, the wheel as it is."""
    figure = empty_figure()
    try:
        band = found.band
    except InputError:
        return figure
    low, high = (band.columns[f"load_p{p}_N"] for p in (5, 95))
    at = 1e3 * band.deflection
    add_area(figure, at, low, high, "90 % of the samples", BAND)
    add_plain(figure, at, band.columns["load_p50_N"], "median", MODEL_COLOURS["section"], 1.6)
    add_line(figure, band, "the wheel as it is", MODEL_COLOURS["fe"], width=3.0)
    return figure


def shown_outputs(found: Sampled) -> tuple[Output, Output]:
    """Those whose correlations are drawn: the load at the first deflection, and stress over yield strength."""
    return found.outputs[1], found.outputs[-1]


def _ranks(study: Study, found: Sampled) -> Figure:
    """Two bars for each input, the strongest on top; dashed: where a correlation is told from none."""
    figure = empty_figure("rank correlation [-]", "")
    outputs = shown_outputs(found)
    strength = [
        max((abs(o.rank[i]) for o in outputs if np.isfinite(o.rank[i])), default=0.0)
        for i in range(len(found.samples.keys))
    ]
    order = np.argsort(strength)
    for k, (output, colour) in enumerate(zip(outputs, ORIENTATION_COLOURS[:2], strict=True)):
        places = np.arange(len(order)) + _APART * (1 - 2 * k)
        x = np.column_stack([np.zeros(len(order)), output.rank[order], np.full(len(order), np.nan)]).ravel()
        y = np.repeat(places, 3)
        add_plain(figure, x, y, output.name, colour, _BAR)
    for sign in (-1.0, 1.0):
        figure.add_vline(x=sign * outputs[0].limit, line={"color": INK, "width": 1, "dash": "dash"})
    figure.add_vline(x=0.0, line={"color": INK, "width": 1})
    for place, i in enumerate(order):
        figure.add_annotation(
            x=_LEFT,
            y=place,
            text=in_words(study, found.samples.keys[i]),
            showarrow=False,
            xanchor="left",
            font={"size": 12},
        )
    figure.update_xaxes(range=[_LEFT, _RIGHT], rangemode="normal", tickvals=[-1.0, -0.5, 0.0, 0.5, 1.0])
    figure.update_yaxes(visible=False, tickvals=[], range=[-0.7, len(order) - 0.3], rangemode="normal")
    figure.update_layout(hovermode="closest", height=130 + 34 * len(order), margin={"l": 16})
    return figure


def in_words(study: Study, key: str) -> str:
    """What a key is called: ``"springs outer points 1"`` for ``wheel.springs[0].points[0][1]``."""
    parts = parts_of(tied_keys(key)[0][1])
    if parts[0] == "materials":
        return " ".join(str(part) for part in parts[1:]).replace("_", " ")
    if parts[:2] == ["wheel", "springs"] and isinstance(parts[2], int):
        tied = len(tied_keys(key)) > 1
        owner = "springs" if tied else study.parametric.springs[parts[2]].name
        rest = parts[3:]
    else:
        owner, rest = (
            ("", parts[1:]) if parts[0] == "wheel" else (str(parts[0]) if parts[0] != "fe" else "ground", parts[1:])
        )
    words = " ".join(str(part + 1) if isinstance(part, int) else str(part) for part in rest[:2])
    return f"{owner} {words}".replace("_", " ").strip()
