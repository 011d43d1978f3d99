"""The continuum's curves among those of the thesis' tires; the plausible set, its band and some of its wheels.

Verified by tests/end_to_end/test_report.py and tests/unit/test_workbench_plausible.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geometry.springs import leg_sides, polar, spring_leg, station_angles
from geometry.wheel import WheelDesign
from workbench.charts.curves import add_area, add_line, add_plain
from workbench.charts.interactive import Figure, empty_figure, figure_html
from workbench.charts.palette import BAND, INK, MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.study.wheel_design import wheel_design

if TYPE_CHECKING:
    from workbench.questions.words.results import Words
    from workbench.study.model import Study

__all__ = ["centrelines", "words_figures"]

Array = NDArray[np.float64]
_PITCH = 320.0
"""Between the middles of two wheels drawn side by side [mm]."""
_FAINT = "rgba(128, 134, 139, 0.18)"
_TIRES = "rgba(0, 114, 178, 0.16)"
"""The ANCF curves' colour: green is the reference's."""


def words_figures(study: Study, words: Words) -> dict[str, str]:
    """Thin: each orientation of the wheel; thick: the average by arc; the nearest tire's curves and the brush line.

    Shaded: what the means of all tires span that the thesis' text allows.
    """
    figure = empty_figure()
    _span_of_tires(figure, words)
    for orientation, curve in words.fe.loaded.items():
        add_line(figure, curve, f"FE {orientation:g}°", MODEL_COLOURS["fe"], width=0.8)
    add_line(figure, words.average, "FE average by arc", MODEL_COLOURS["fe"], width=4.0)
    for i, (orientation, curve) in enumerate(words.tire.loaded.items()):
        add_line(
            figure, curve, f"ANCF {orientation:g}°", MODEL_COLOURS["ancf"], width=2.0, dash=("dash", "dashdot")[i % 2]
        )
    add_line(figure, words.brush, "brush line", MODEL_COLOURS["brush"], width=2.0, dash="dot")
    return {
        "words": figure_html(figure, "words-curves"),
        "band": figure_html(_band(words), "words-band"),
        "wheels": figure_html(_wheels(words), "words-wheels"),
    }


def _span_of_tires(figure: Figure, words: Words) -> None:
    means = [tire.average for tire in words.readings.values()]
    at = np.linspace(0.0, min(mean.deflection[-1] for mean in means), 60)
    loads = np.array([mean.load_at(at) for mean in means])
    low, high = loads.min(axis=0), loads.max(axis=0)
    add_area(figure, 1e3 * at, low, high, "means of the ANCF tires that the text allows", _TIRES)


def _band(words: Words) -> Figure:
    """What the averages and all orientations of the set span, this wheel's average and the ANCF tire's mean."""
    figure, band = empty_figure(), words.plausible.band
    at = 1e3 * band.deflection
    spans = {"any orientation of the set": ("_any", _FAINT), "averages of the set": ("", BAND)}
    for name, (which, colour) in spans.items():
        low, high = (band.columns[f"load_{end}{which}_N"] for end in ("low", "high"))
        add_area(figure, at, low, high, name, colour)
    add_line(figure, words.average, "FE average by arc", MODEL_COLOURS["fe"], width=3.0)
    add_line(figure, words.tire.average, "ANCF mean", MODEL_COLOURS["ancf"], width=2.0, dash="dash")
    add_line(figure, words.brush, "brush line", MODEL_COLOURS["brush"], width=2.0, dash="dot")
    return figure


def _wheels(words: Words) -> Figure:
    """Sections of some wheels of the set side by side, in order of stress, from the middle of the first one."""
    figure = empty_figure("", "")
    shown = words.plausible.shown
    for i, wheel in enumerate(shown):
        design = wheel_design(words.plausible.point(wheel).study)
        for name, lines in centrelines(design).items():
            x, z = (1e3 * np.concatenate([np.append(line[:, k], np.nan) for line in lines]) for k in (0, 1))
            colour = INK if name in ("rim", "hub") else ORIENTATION_COLOURS[int(name != design.spring_sets[0].name)]
            add_plain(figure, x + _PITCH * i, z, name.replace("_", " "), colour, width=1.6)
            figure.data[-1].showlegend = i == 0
        text = f"{wheel.point}: {1e-6 * wheel.stress:.0f} MPa"
        figure.add_annotation(x=_PITCH * i, y=-175.0, text=text, showarrow=False, font={"size": 13})
    half = 0.5 * _PITCH
    figure.update_xaxes(visible=False, range=[-half, _PITCH * (len(shown) - 0.5)], rangemode="normal")
    figure.update_yaxes(visible=False, range=[-190.0, 150.0], rangemode="normal", scaleanchor="x")
    figure.update_layout(showlegend=False, height=280, hovermode=False, margin={"l": 0, "r": 0, "t": 0, "b": 0})
    return figure


def centrelines(design: WheelDesign) -> dict[str, list[Array]]:
    """Lines of a wheel's section by part, each (n, 2) [m]: middle of the rim with its grousers, hub, springs."""
    rim, hub = design.tire.inner_radius, design.outer_hub.outer_radius
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    lines = {"rim": [_arc(0.5 * (rim + design.tire.outer_radius), turn)], "hub": [_arc(hub, turn)]}
    if (fins := design.grousers) is not None:
        outer = design.tire.outer_radius
        angles = fins.phase + 2.0 * np.pi / fins.count * np.arange(fins.count)
        lines["rim"] += [np.array([polar(outer, a), polar(outer + fins.height, a)]) for a in angles]
    for springs in design.spring_sets:
        lines[springs.name] = [
            spring_leg(springs, (hub, rim), station, side).points
            for station in station_angles(springs)
            for side in leg_sides(springs)
        ]
    return lines


def _arc(radius: float, angles: Array) -> Array:
    return np.array([polar(radius, angle) for angle in angles])
