"""Claim: penalty and augmented Lagrangian agree, and the latter leaves less than a micrometre of penetration.

Source: both discretise the same contact; they differ by the penetration that the penalty needs. Tolerances: on the ring
(penalty 1e10 N/m^3, a few micrometres deep) 0.2 % of the load; on the coarse wheel at 4 mm (1e11 N/m^3) 0.5 %. The
penetration is the largest at the points of contact and, on the wheel, anywhere on its faces. Negative controls: a soft
penalty; points of contact that leave out the faces' edges, where a grouser's edge digs in.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact import obstacle as contact_obstacle
from reference_fe.contact.facets import gauss_line
from reference_fe.contact.obstacle import ContactMethod, ObstacleTerm
from reference_fe.contact.obstacles import HalfRoundRock
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.ring_between_plates import RADIUS, quarter_ring
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel

CASE = WheelLoadCase(orientation_deg=15.0, deflections=(0.002, 0.004), inner_contact=False)


def pressed_ring(method: ContactMethod, stiffness: float) -> tuple[list[ConvergedState], float]:
    """States at 10 and 20 % compression, and the penetration at the end [m]."""
    problem = quarter_ring(20, method=method, stiffness=stiffness)
    solver = NewtonSolver(problem, NewtonSettings(maximum_iterations=40))
    states = list(solve_increments(solver, [0.1 * RADIUS, 0.2 * RADIUS], []))
    (term,) = problem.surfaces.terms
    assert isinstance(term, ObstacleTerm)
    return states, term.penetration()


def test_the_two_agree_on_the_ring() -> None:
    penalty, depth = pressed_ring(ContactMethod.PENALTY, 1e10)
    augmented, small = pressed_ring(ContactMethod.AUGMENTED_LAGRANGIAN, 1e10)
    assert small < 1e-6 < depth
    assert augmented[-1].contact_force[2] == pytest.approx(penalty[-1].contact_force[2], rel=2e-3)
    assert sum(state.outcome.augmentations for state in augmented) > 0


def test_a_soft_penalty_is_caught() -> None:
    """Negative control: with 1e6 N/m^3 the penalty's load is off by more than the two may differ."""
    soft, _ = pressed_ring(ContactMethod.PENALTY, 1e6)
    augmented, _ = pressed_ring(ContactMethod.AUGMENTED_LAGRANGIAN, 1e10)
    assert abs(soft[-1].contact_force[2] / augmented[-1].contact_force[2] - 1.0) > 0.01


@functools.cache
def coarse_mesh(*, half_width: bool) -> TaggedMesh:
    return build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=half_width)


def wheel(case: WheelLoadCase, *, half_width: bool = True) -> WheelResult:
    mesh = coarse_mesh(half_width=half_width)
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)


@functools.cache
def plane_load() -> float:
    """Load of `CASE` at its last deflection [N]."""
    return float(wheel(CASE).curve.load[-1])


def test_the_two_agree_on_a_coarse_wheel() -> None:
    case = replace(CASE, contact_method=ContactMethod.AUGMENTED_LAGRANGIAN)
    penalty, augmented = wheel(CASE).curve, wheel(case).curve
    np.testing.assert_allclose(augmented.load[1:], penalty.load[1:], rtol=5e-3)
    assert augmented.columns["contact_point_penetration_m"].max() < 1e-6
    assert augmented.columns["penetration_m"].max() < 1e-6


def test_points_within_the_faces_only_are_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: multipliers at the penalty's Gauss points let the faces' edges in."""

    monkeypatch.setattr(contact_obstacle, "simpson_line", lambda _: gauss_line(5))
    curve = wheel(replace(CASE, contact_method=ContactMethod.AUGMENTED_LAGRANGIAN)).curve
    assert curve.columns["contact_point_penetration_m"].max() < 1e-6
    assert curve.columns["penetration_m"].max() > 2e-6


def test_camber_to_either_side_is_alike_and_needs_the_full_width() -> None:
    left, right = (wheel(replace(CASE, camber_deg=c), half_width=False).curve for c in (4.0, -4.0))
    np.testing.assert_allclose(left.load, right.load, rtol=1e-6, atol=1e-9)
    assert left.load[-1] < 0.95 * plane_load()
    with pytest.raises(InputError, match="full width"):
        wheel(replace(CASE, camber_deg=4.0))


def test_a_rock_carries_less_than_the_plane() -> None:
    """Over a rock the same rise loads the rim on a shorter strip; the state balances."""
    case = replace(CASE, orientation_deg=15.0, deflections=(0.001,))
    plane = wheel(case).curve
    rock = wheel(replace(case, obstacle=HalfRoundRock(radius=0.03))).curve
    assert 0.2 * plane.load[-1] < rock.load[-1] < plane.load[-1]
    assert rock.columns["force_imbalance"].max() < 1e-6


def test_friction_raises_the_load_a_little() -> None:
    """The tread spreads as it flattens; friction holds it: more load, by less than the friction coefficient."""
    rough = wheel(replace(CASE, friction=0.5)).curve.load[-1]
    assert 1.0 < rough / plane_load() < 1.1
