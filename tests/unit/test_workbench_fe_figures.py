"""Figures of the continuum's curves: what a wheel without a mirror plane shows around its axle."""

from __future__ import annotations

import json

import numpy as np
import pytest

from contracts.curves import Around, StiffnessCurve
from workbench.charts.interactive import empty_figure
from workbench.questions.fe.figures import add_reference, around_figure
from workbench.questions.model_curves import ModelCurves, RunNumbers, mean_curve
from workbench.study.reference import ReferenceSection

DEFLECTION = np.linspace(0.0, 0.025, 6)


def _fe(slopes: dict[float, float]) -> ModelCurves:
    curves = {
        o: StiffnessCurve(model="fe", orientation_deg=o, deflection=DEFLECTION, load=slope * DEFLECTION)
        for o, slope in slopes.items()
    }
    runs = dict.fromkeys(curves, RunNumbers())
    return ModelCurves(model="fe", by_orientation=curves, average=mean_curve(list(curves.values())), runs=runs)


def _lines(html: str) -> dict[str, dict[str, list[float]]]:
    start = html.index(">", html.index("application/json")) + 1
    return {one["name"]: one for one in json.loads(html[start : html.index("</script>", start)])["data"]}


def test_rolling_backwards_meets_the_loads_in_the_other_order() -> None:
    lines = _lines(around_figure(_fe({0.0: 8e3, 20.0: 9e3, 90.0: 7e3}), Around(period=120.0)))
    assert set(lines) == {f"{at} mm, {way}" for at in (10, 20) for way in ("forwards", "backwards")}
    assert lines["10 mm, forwards"]["x"] == [0.0, 20.0, 90.0, 120.0]
    assert lines["10 mm, forwards"]["y"] == pytest.approx([80.0, 90.0, 70.0, 80.0])
    assert lines["10 mm, backwards"]["x"] == [0.0, 30.0, 100.0, 120.0]
    assert lines["10 mm, backwards"]["y"] == pytest.approx([80.0, 70.0, 90.0, 80.0])


def test_a_mirrored_wheel_has_no_direction() -> None:
    slopes = {0.0: 8e3, 20.0: 9e3, 60.0: 7e3}
    assert around_figure(_fe(slopes), Around(period=120.0, mirrored=True)) == ""
    assert around_figure(_fe({0.0: 8e3, 20.0: 9e3}), Around(period=120.0)) == ""


def test_the_references_band_is_wider_than_the_line_that_may_cover_it() -> None:
    figure = empty_figure()
    add_reference(figure, ReferenceSection(thesis_words=True))
    (band,) = figure.data
    assert band.line.width > 2.5  # of the FE average
