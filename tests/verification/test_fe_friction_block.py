"""Claim: a block pressed on a rough plane sticks elastically, then slides at the limit force mu N (Coulomb).

Source: statics. Tolerances: the tangential force of the sliding block is mu N to 1e-6 (Newton tolerance 1e-8); the
stick stiffness is that of the stick law on the foot's area to 1e-3 (the block's compliance); the energy it loses is
mu N s. The model is reference_fe/verification/sliding_block.py.
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


def test_sliding_dissipates_the_limit_force_times_the_way() -> None:
    """Closed form mu N s between stops of full sliding, to 1e-6; nothing is dissipated before."""
    found = run(FRICTION, 37.0)
    way, slip = np.diff(found.drag)[3:], slice(3, None)
    assert np.diff(found.dissipated)[3:] == pytest.approx(FRICTION * found.normal[4:] * way, rel=1e-6)
    assert np.abs(found.dissipated[:3]).max() < 1e-12 * found.dissipated[-1]
    assert found.slip_energy[slip] == pytest.approx(found.tangential[slip] ** 2 / (2.0 * PENALTY * SIDE**2), rel=1e-3)


def test_the_work_of_dragging_is_dissipated_or_stored() -> None:
    """To 1e-6 of the work, the block's own energy; negative control: without the dissipation 96 % are lacking."""
    found = run(FRICTION, 0.0)
    means = 0.5 * (found.tangential[1:] + found.tangential[:-1])
    work = np.cumsum(means * np.diff(found.drag))
    assert found.dissipated[1:] + found.slip_energy[1:] == pytest.approx(work, rel=1e-6, abs=1e-6 * work[-1])
    assert found.slip_energy[-1] < 0.05 * work[-1]


def test_newton_needs_few_iterations_with_the_consistent_tangent() -> None:
    assert run(FRICTION, 0.0).iterations.max() <= 5


def test_without_friction_nothing_resists() -> None:
    """Negative control: the same block on a smooth plane feels no tangential force; with half mu, half of it."""
    smooth, half = run(0.0), run(0.5 * FRICTION)
    assert np.abs(smooth.tangential).max() < 1e-6 * smooth.normal[0]
    assert half.tangential[-1] < 0.51 * FRICTION * half.normal[-1]
