"""Claim: a block pressed on a rough plane sticks elastically, then slides at the limit force mu N (Coulomb).

Source: statics. The block's foot is held flat by stiff material, so that every point has the same pressure and slip;
the pressing force is the integral of the pressure. Tolerances: the tangential force of the sliding block is mu N to
1e-6 (Newton tolerance 1e-8); the stick stiffness is that of the stick law on the foot's area to 1e-3 (the block's
compliance).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import pytest

from contracts.materials import Material
from reference_fe.contact_obstacle import ObstacleContact
from reference_fe.domain import Domain
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.static_problem import StaticProblem
from reference_fe.supports import Support
from tests.structured_hexahedra import block_mesh

STIFF = Material(name="stiff", young_modulus=1e14, poisson_ratio=0.0, density=1.0, yield_strength=1.0, source="stiff")
PENALTY, SIDE, SINK, DRAG = 1e9, 0.1, 1e-4, 1e-3
FRICTION = 0.3


@dataclass(frozen=True, slots=True, kw_only=True)
class Dragged:
    """Drag of the block's top [m], tangential and normal force on the foot [N], Newton iterations."""

    drag: float
    tangential: float
    normal: float
    iterations: int


@functools.cache
def drag_the_block(friction: float, direction_deg: float = 0.0) -> tuple[Dragged, ...]:
    """Foot at depth SINK from the start, top dragged to DRAG in steps that are accepted one by one."""
    direction = np.array([np.cos(np.deg2rad(direction_deg)), np.sin(np.deg2rad(direction_deg))])
    contact = ObstacleContact(
        faces=("z0",), normal=(0.0, 0.0, 1.0), distance_at_touch=0.0, stiffness=PENALTY, friction=friction
    )
    value = (DRAG * direction[0], DRAG * direction[1], 0.0)
    problem = StaticProblem(
        Domain.from_tagged(block_mesh((2, 2, 1), lambda X: SIDE * X)),
        {"body": STIFF},
        [Support(faces=("z1",), value=value)],
        contact=contact,
    )
    solver, states = NewtonSolver(problem, NewtonSettings()), []
    (term,) = problem.surfaces.terms
    for factor in (0.0, 0.01, 0.02, 0.1, 0.5, 1.0):
        problem.set_control(factor)
        term.set_control(SINK)  # the plane stands still while the block is dragged
        outcome = solver.solve()
        assert outcome.converged
        problem.surfaces.accept()
        force = problem.contact_force()
        state = Dragged(
            drag=factor * DRAG,
            tangential=float(-force[:2] @ direction),
            normal=float(force[2]),
            iterations=outcome.iterations,
        )
        assert abs(force[0] * direction[1] - force[1] * direction[0]) < 1e-6 * force[2]
        states.append(state)
    return tuple(states)


@pytest.mark.parametrize("direction_deg", [0.0, 37.0])
def test_it_sticks_then_slides_at_the_limit(direction_deg: float) -> None:
    states = drag_the_block(FRICTION, direction_deg)
    assert states[0].normal == pytest.approx(PENALTY * SINK * SIDE**2, rel=1e-3)
    for state in states[1:3]:  # 10 and 20 micrometres: below mu p / k = 30
        assert state.tangential / state.drag == pytest.approx(PENALTY * SIDE**2, rel=1e-3)
        assert state.tangential < FRICTION * state.normal
    for state in states[3:]:
        assert state.tangential == pytest.approx(FRICTION * state.normal, rel=1e-6)


def test_newton_needs_few_iterations_with_the_consistent_tangent() -> None:
    assert max(state.iterations for state in drag_the_block(FRICTION)) <= 5


def test_without_friction_nothing_resists() -> None:
    """Negative control: the same block on a smooth plane feels no tangential force; with half mu, half of it."""
    assert max(abs(state.tangential) for state in drag_the_block(0.0)) < 1e-6 * drag_the_block(0.0)[0].normal
    half = drag_the_block(0.5 * FRICTION)[-1]
    assert half.tangential < 0.51 * FRICTION * half.normal
