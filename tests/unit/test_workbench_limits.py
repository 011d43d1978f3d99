"""The findings on means and on overlap, on curves whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.curves import Around, StiffnessCurve, average_curve
from workbench.questions.fe.checks import GAP, overlap_checks
from workbench.questions.model_curves import ModelCurves, mean_curve


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


def _slope(fe: ModelCurves, around: Around) -> float:
    return mean_curve(list(fe.by_orientation.values()), around).initial_tangent(0.005)


def test_ends_of_a_mirrored_wheels_half_period_count_half() -> None:
    around = Around(period=120.0, mirrored=True)
    assert _slope(model({0.0: 9000.0, 30.0: 7000.0, 60.0: 9000.0}), around) == pytest.approx(8000.0)


def test_orientations_are_weighted_by_their_arc_of_a_period() -> None:
    one_way = Around(period=120.0)
    assert _slope(model({0.0: 9000.0, 40.0: 7000.0, 80.0: 5000.0}), one_way) == pytest.approx(7000.0)
    uneven = _slope(model({0.0: 9000.0, 10.0: 9000.0, 60.0: 5000.0}), one_way)
    assert uneven == pytest.approx((35 * 9000 + 30 * 9000 + 55 * 5000) / 120)


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
