"""Distances between curves, on curves whose distance is known exactly."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.models.metrics import compare_curves, largest_spread


def _line(slope: float, end: float = 0.03, offset: float = 0.0, start: float = 0.0) -> StiffnessCurve:
    d = np.linspace(start, end, 31)
    return StiffnessCurve(model="line", orientation_deg=None, deflection=d, load=slope * d + offset)


def test_equal_curves_have_no_distance() -> None:
    metrics = compare_curves(_line(8250.0), _line(8250.0))
    assert (metrics.relative_l2, metrics.max_error) == (0.0, 0.0)


def test_ten_percent_steeper_line() -> None:
    metrics = compare_curves(_line(9075.0), _line(8250.0))
    assert metrics.relative_l2 == pytest.approx(0.1, rel=1e-12)
    assert metrics.max_error == pytest.approx(825.0 * 0.03, rel=1e-12)
    assert metrics.max_error_at == pytest.approx(0.03)
    assert metrics.tangent == pytest.approx(9075.0)
    assert metrics.tangent_reference == pytest.approx(8250.0)


def test_range_is_the_common_one_and_ends_at_the_reference_load() -> None:
    metrics = compare_curves(_line(9000.0, end=0.02, start=0.005), _line(8000.0))
    assert (metrics.start, metrics.end) == (0.005, 0.02)
    assert compare_curves(_line(9000.0), _line(8000.0), max_load=160.0).end == pytest.approx(0.02)


def test_a_reference_that_begins_above_the_load_is_compared_whole() -> None:
    stiff = _line(8000.0, offset=300.0)
    assert compare_curves(_line(9000.0), stiff, max_load=250.0).end == pytest.approx(0.03)


def test_curves_that_share_nothing_are_refused() -> None:
    with pytest.raises(InputError, match="share no range"):
        compare_curves(_line(1.0, end=0.01), _line(1.0, end=0.03, start=0.02))
    with pytest.raises(InputError, match="is zero"):
        compare_curves(_line(1.0), _line(0.0))


def test_no_load_at_all_lies_as_far_off_as_the_reference_is_long() -> None:
    assert compare_curves(_line(0.0), _line(8250.0)).relative_l2 == pytest.approx(1.0)


def test_loads_beyond_reason_are_refused() -> None:
    assert compare_curves(_line(8250e8), _line(8250e8)).reference_load == pytest.approx(8250e8 * 0.03)
    for slopes in ((1e200, 8250.0), (8250.0, 1e300)):
        with pytest.raises(InputError, match="must not exceed 1e"):
            compare_curves(_line(slopes[0]), _line(slopes[1]))


def test_spread_of_two_lines() -> None:
    assert largest_spread([_line(9000.0), _line(7000.0)], 0.02) == pytest.approx(0.25)
