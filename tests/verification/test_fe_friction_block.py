"""Claim: a block pressed on a rough plane sticks elastically, then slides at the limit force mu N (Coulomb).

Source: statics. Tolerances: the tangential force of the sliding block is mu N to 1e-6 (Newton tolerance 1e-8); the
stick stiffness is that of the stick law on the foot's area to 1e-3 (the block's compliance). The model is
reference_fe/verification/sliding_block.py.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from reference_fe.verification.sliding_block import FRICTION, PENALTY, SIDE, SINK, dragged_block

run = functools.cache(dragged_block)


@pytest.mark.parametrize("direction_deg", [0.0, 37.0])
def test_it_sticks_then_slides_at_the_limit(direction_deg: float) -> None:
    found = run(FRICTION, direction_deg)
    assert np.all(np.abs(found.sideways) < 1e-6 * found.normal)
    assert found.normal[0] == pytest.approx(PENALTY * SINK * SIDE**2, rel=1e-3)
    stick, slip = slice(1, 3), slice(3, None)  # 10 and 20 micrometres: below mu p / k = 30
    assert found.tangential[stick] / found.drag[stick] == pytest.approx(PENALTY * SIDE**2, rel=1e-3)
    assert np.all(found.tangential[stick] < FRICTION * found.normal[stick])
    assert found.tangential[slip] == pytest.approx(FRICTION * found.normal[slip], rel=1e-6)


def test_newton_needs_few_iterations_with_the_consistent_tangent() -> None:
    assert run(FRICTION, 0.0).iterations.max() <= 5


def test_without_friction_nothing_resists() -> None:
    """Negative control: the same block on a smooth plane feels no tangential force; with half mu, half of it."""
    smooth, half = run(0.0), run(0.5 * FRICTION)
    assert np.abs(smooth.tangential).max() < 1e-6 * smooth.normal[0]
    assert half.tangential[-1] < 0.51 * FRICTION * half.normal[-1]
