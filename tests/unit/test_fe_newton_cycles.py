"""A Newton iteration that goes round in circles is given up, one that only rests is not."""

from __future__ import annotations

import pytest

from reference_fe.solver.newton import _is_cycling, _is_stalled

ROUND = [6.4e-3, 1.6e-3, 4.0e-4, 1.1e-4, 3.3e-5, 2.3e-5]


@pytest.mark.parametrize(
    ("history", "cycling"),
    [
        ([1.0, 30.0, *ROUND, *ROUND], True),
        ([1.0, 30.0, *ROUND, *ROUND[:-1]], False),
        ([1.0, 30.0, *ROUND, *[0.9 * value for value in ROUND]], False),
        ([1.0, 8.0e-4, 8.0e-4, 8.0e-4], True),
        ([1.0, 8.0e-4, 8.0e-4], False),
        ([1.0, 2e-3, 3e-4, 2e-3, 3e-4], False),
        ([1.0, 2e-3, 3e-4, 2e-3, 3e-4, 2e-3, 3e-4], True),
        ([1.0, float("inf"), float("inf"), float("inf")], False),
        ([1.0], False),
    ],
)
def test_cycles(history: list[float], cycling: bool) -> None:
    assert _is_cycling(history) is cycling


@pytest.mark.parametrize(
    ("last", "tolerance", "stalled"),
    [
        ([4e-9, 4e-9, 4e-9, 4e-9], 1e-10, True),
        ([4e-8, 5e-8, 3e-8, 4e-8], 1e-9, True),
        ([4e-9, 4e-9, 4e-9, 4e-9], 1e-11, False),
        ([4.6e-6, 4.6e-6, 4.6e-6, 4.6e-6], 1e-7, False),
        ([4e-5, 4e-5, 4e-5, 4e-5], 1e-6, False),
        ([8e-7, 6.4e-7, 5.1e-7, 4.1e-7], 1e-8, False),
        ([9e-9, 9e-9, 9e-9, 9e-9], 1e-8, False),
        ([4e-8, 4e-9, 4e-9, 4e-9], 1e-10, False),
    ],
    ids=["round-off", "uneven", "far above", "contact", "contact, loose", "falls slowly", "reached", "has just come"],
)
def test_only_round_off_stalls(last: list[float], tolerance: float, stalled: bool) -> None:
    """Contact that looks for its set stood still at 4.6e-6 with friction; a smaller increment found it."""
    assert _is_stalled([1.0, 0.1, *last], tolerance) is stalled
