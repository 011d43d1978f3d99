"""The findings on means and on overlap, on curves whose answers are known."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contracts.curves import Around, StiffnessCurve, average_curve
from workbench.questions.fe.checks import GAP, circumferential_tangent_check, overlap_checks
from workbench.questions.model_curves import ModelCurves

BAND: Any = SimpleNamespace(initial_tangent=8000.0, source="test")
TOLERANCES: Any = SimpleNamespace(initial_tangent_up_to=0.005, initial_tangent=0.03)


def model(slopes: dict[float, float], gap: float = 1e-3, end: float = 0.04) -> ModelCurves:
    """Straight lines of given slopes [N/m]; the gap falls linearly from ``gap`` to minus ``gap``."""
    d = np.linspace(0.0, end, 41)
    curves = {
        angle: StiffnessCurve(
            model="fe",
            orientation_deg=angle,
            deflection=d,
            load=slope * d,
            columns={GAP: gap * (1.0 - 2.0 * d / end)},
        )
        for angle, slope in slopes.items()
    }
    return ModelCurves(model="fe", by_orientation=curves, average=average_curve(list(curves.values())), runs={})


def test_ends_of_a_mirrored_wheels_half_period_count_half() -> None:
    around = Around(period=120.0, mirrored=True)
    check = circumferential_tangent_check(model({0.0: 9000.0, 30.0: 7000.0, 60.0: 9000.0}), BAND, TOLERANCES, around)
    assert check.value == pytest.approx(8000.0)
    assert check.status == "pass"


def test_orientations_are_weighted_by_their_arc_of_a_period() -> None:
    one_way = Around(period=120.0)
    even = model({0.0: 9000.0, 40.0: 7000.0, 80.0: 5000.0})
    assert circumferential_tangent_check(even, BAND, TOLERANCES, one_way).value == pytest.approx(7000.0)
    uneven = model({0.0: 9000.0, 10.0: 9000.0, 60.0: 5000.0})
    check = circumferential_tangent_check(uneven, BAND, TOLERANCES, one_way)
    assert check.value == pytest.approx((35 * 9000 + 30 * 9000 + 55 * 5000) / 120)
    assert check.status == "fail"


def test_one_orientation_has_no_mean_around_the_wheel() -> None:
    assert circumferential_tangent_check(model({0.0: 8000.0}), BAND, TOLERANCES, Around()).status == "error"


def test_overlap_counts_up_to_the_load() -> None:
    at_160, at_250 = overlap_checks(model({0.0: 8000.0}), inner_contact=True)
    assert (at_160.value, at_160.status) == (pytest.approx(0.0), "pass")  # 160 N at 20 mm, where the gap is zero
    assert at_250.value == pytest.approx(1e-3 * (2 * 31 / 40 - 1))  # last point up to 250 N: 31 mm
    assert (at_250.status, at_250.role) == ("fail", "gate")
    without = overlap_checks(model({0.0: 8000.0}), inner_contact=False)[1]
    assert (without.status, without.role) == ("fail", "finding")
    assert "switched off" in without.title


def test_overlap_is_not_evaluated_beyond_the_curves() -> None:
    found = overlap_checks(model({0.0: 5000.0}), inner_contact=True)
    assert [(c.status, c.role) for c in found] == [("fail", "gate"), ("error", "finding")]
