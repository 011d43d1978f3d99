"""Figures of the continuum's curves, and what others draw beside them: uncertainty, reference.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from contracts.curves import Around, StiffnessCurve
from contracts.errors import InputError
from contracts.footprint import Footprint
from workbench.charts.curves import DASHES, add_area, add_line, add_orientations, named
from workbench.charts.interactive import Figure, empty_figure, figure_html
from workbench.charts.palette import BAND, INK, MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.questions.fe.results import ContinuumCurves
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import ModelCurves, UserCurve
from workbench.questions.strength.yielding import judged_stress
from workbench.questions.words.plausible import plausible
from workbench.study.reference import THESIS_KIND, BandReference, ReferenceSection
from workbench.study.reference_file import load_band, read_band

__all__ = [
    "add_reference",
    "add_uncertainty",
    "add_users",
    "around_figure",
    "fe_figure",
    "footprint_figure",
    "stress_figure",
]

_TOLD_AT = 0.010, 0.020, 0.030
"""Deflections at which loads are drawn around the wheel [m]."""
_MAP = 4e-3
"""Distance of the places of a footprint's map [m]."""
_GREEN = "#009e73"
_STRONG = "rgba(0, 158, 115, 0.35)"
_LEAST = 3
"""Orientations that make a figure around the wheel."""


def fe_figure(found: ContinuumCurves, reference: ReferenceSection | None) -> str:
    """FE at each orientation, with the way back dashed, their average with the mesh uncertainty, the reference."""
    figure, fe = empty_figure(), found.fe
    add_reference(figure, reference)
    add_orientations(figure, fe.by_orientation, "FE")
    _add_unloadings(figure, found)
    add_uncertainty(figure, fe.average, found.mesh_study)
    add_line(figure, fe.average, "FE average", MODEL_COLOURS["fe"], width=4.0)
    add_users(figure, found.users)
    return figure_html(figure, "fe-curves")


def _add_unloadings(figure: Figure, found: ContinuumCurves) -> None:
    for number, (orientation, back) in enumerate(found.unloadings.items()):
        colour = ORIENTATION_COLOURS[list(found.fe.by_orientation).index(orientation) % 6]
        figure.add_scatter(
            x=back.curve.deflection * 1e3,
            y=back.curve.load,
            name=named("FE, way back", back.curve),
            legendgroup="way back",
            showlegend=number == 0,
            mode="lines",
            line={"color": colour, "width": 1.6, "dash": "dash"},
            hovertemplate=f"{orientation:g}° back: %{{y:.1f}} N",
        )


def around_figure(fe: ModelCurves, turns: Around) -> str:
    """Load against the position that faces the ground, rolling one way (solid) and the other (dashed), over one period.

    Rolling backwards meets the positions in the reverse order: F(period - phi). Nothing for a mirrored wheel, which has
    no direction, and of fewer than three orientations.
    """
    if turns.mirrored or len(fe.loaded) < _LEAST:
        return ""
    figure = empty_figure("circumferential position from where rolling began [deg]", "load on the wheel [N]")
    reached = min(curve.deflection[-1] for curve in fe.loaded.values())
    for i, deflection in enumerate(at for at in _TOLD_AT if at <= reached):
        loads = {o % turns.period: float(curve.load_at(deflection)) for o, curve in fe.loaded.items()}
        ways = {"forwards": (loads, "solid"), "backwards": ({-o % turns.period: f for o, f in loads.items()}, "dash")}
        for way, (found, dash) in ways.items():
            angles = sorted(found)
            figure.add_scatter(
                x=[*angles, angles[0] + turns.period],
                y=[*(found[o] for o in angles), found[angles[0]]],
                name=f"{1e3 * deflection:g} mm, {way}",
                mode="lines+markers",
                line={"color": ORIENTATION_COLOURS[i], "width": 2, "dash": dash},
                hovertemplate="%{y:.1f} N",
            )
    return figure_html(figure, "fe-around")


def stress_figure(curve: StiffnessCurve, strengths: Mapping[str, float]) -> str:
    """Stress of each part that is held against yield, against load at one orientation, with the yield strength.

    Nothing where no part has one.
    """
    figure = empty_figure("load on the wheel [N]", "largest stress [MPa]")
    found = {part: judged_stress(curve, part) for part in strengths}
    stresses = {part: stress * 1e-6 for part, stress in found.items() if stress is not None}
    if not stresses:
        return ""
    for i, (part, stress) in enumerate(stresses.items()):
        style = {"color": ORIENTATION_COLOURS[i % 6], "width": 2.5, "dash": DASHES[i % 6]}
        figure.add_scatter(x=curve.load, y=stress, name=part.replace("_", " "), mode="lines", line=style)
    for strength in sorted({strengths[p] for p in stresses}):
        figure.add_hline(
            y=strength * 1e-6,
            line={"color": INK, "width": 1, "dash": "dash"},
            annotation={"text": f"yield strength {strength * 1e-6:.0f} MPa", "font": {"size": 12}},
            annotation_position="top left",
        )
    return figure_html(figure, "stress-curves")


def footprint_figure(footprints: Mapping[float, Footprint]) -> str:
    """Mean pressure on the ground at the first orientation, from above, around places 4 mm apart."""
    if not footprints:
        return ""
    first, *_ = footprints.values()
    count = math.ceil(float(np.abs(first.place).max()) / _MAP) + 1
    grid = _MAP * np.arange(-count, count + 1, dtype=np.float64)
    pressure = first.spread(grid, grid)
    figure = empty_figure("forward of the hub [mm]", "left of the wheel's middle [mm]")
    figure.add_heatmap(
        x=1e3 * grid,
        y=1e3 * grid,
        z=1e-6 * pressure.T,
        colorscale=[[0.0, "#ffffff"], [0.15, "#9ecae1"], [1.0, "#08306b"]],
        colorbar={"title": {"text": "MPa"}},
        hovertemplate="%{x:.0f} mm forward, %{y:.0f} mm left: %{z:.2f} MPa<extra></extra>",
    )
    figure.update_layout(hovermode="closest")
    figure.update_xaxes(rangemode="normal")
    figure.update_yaxes(rangemode="normal", scaleanchor="x")
    return figure_html(figure, "footprint")


def add_uncertainty(figure: Figure, average: StiffnessCurve, study: MeshStudy | None) -> None:
    """The average's numerical uncertainty as a grey band; nothing if no mesh study gives one."""
    if study is None:
        return
    try:
        low, high = study.band(average)
    except InputError:
        return
    name = "numerical uncertainty of the FE average"
    add_area(figure, average.deflection * 1e3, high, low, name, "rgba(26, 26, 26, 0.22)")


def add_reference(figure: Figure, reference: ReferenceSection | None) -> None:
    """Slope and band of ``[reference]`` by their kinds: a line near the origin, intervals at loads, an area."""
    if reference is None:
        return
    if reference.thesis_words:
        band = load_band(plausible().band)
        add_area(
            figure,
            1e3 * band.deflection,
            band.low,
            band.high,
            f"{THESIS_KIND} band: the thesis' words",
            _STRONG,
            _GREEN,
        )
    if (slope := reference.slope) is not None:
        end = 1.6e3 * slope.up_to
        figure.add_scatter(
            x=[0.0, end],
            y=[0.0, 1e-3 * slope.value * end],
            mode="lines",
            line={"color": _GREEN, "width": 7},
            opacity=0.35,
            name=f"{slope.kind} slope {1e-3 * slope.value:g} N/mm",
            hoverinfo="skip",
        )
    if reference.band is not None:
        _add_band(figure, reference.band)


def _add_band(figure: Figure, band: BandReference) -> None:
    if band.file is not None:
        loads = read_band(Path(band.file))
        add_area(figure, 1e3 * loads.deflection, loads.low, loads.high, f"{band.kind} band", _STRONG, _GREEN)
        return
    figure.add_scatter(
        x=[500.0 * (p.low + p.high) for p in band.points],
        y=[p.load for p in band.points],
        mode="markers",
        marker={"color": _GREEN, "symbol": "line-ns-open", "size": 14},
        error_x={"type": "data", "array": [500.0 * (p.high - p.low) for p in band.points], "color": _GREEN,
                 "thickness": 4, "width": 9},
        name=f"{band.kind} band",
        hovertemplate="%{x:.1f} mm",
    )  # fmt: skip
    for p in band.points:
        figure.add_shape(type="rect", x0=1e3 * p.low, x1=1e3 * p.high, y0=p.load - 5.0, y1=p.load + 5.0,
                         fillcolor=BAND, line={"width": 0}, layer="below")  # fmt: skip


def add_users(figure: Figure, users: Sequence[UserCurve]) -> None:
    """Curves of the study's reference, with their uncertainty."""
    for i, user in enumerate(users):
        colour = ("#cc79a7", "#56b4e9", "#f0e442")[i % 3]
        at, load, width = 1e3 * user.curve.deflection, user.curve.load, user.uncertainty
        figure.add_scatter(
            x=at,
            y=load,
            name=f"{user.label} ({user.kind})",
            mode="markers+lines",
            marker={"symbol": "star", "size": 8},
            line={"color": colour, "width": 1.5},
            error_y={"type": "data", "array": width, "color": colour, "thickness": 1, "width": 4},
            hovertemplate="%{y:.1f} N",
        )
