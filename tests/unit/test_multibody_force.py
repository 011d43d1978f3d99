"""Forces: springs, hinge torques and users' functions act on both bodies alike, along and about the right lines."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.force import AppliedForce, HingeTorque, SpringDamper
from rover_dynamics.multibody.joint import revolute
from rover_dynamics.multibody.model import BodyMotions, Force, MultibodyModel
from rover_dynamics.multibody.state import moved, rotations, start_state

A, B = body("a", 1.0, (1, 1, 1), (0.1, 0.2, 0.3)), body("b", 1.0, (1, 1, 1), (1.0, -0.4, 0.2))
HINGE = revolute("hinge", A, B, at=(0.5, 0, 0), axis=(1, 2, 2))
MODEL = MultibodyModel(bodies=(A, B), joints=(HINGE,))
VELOCITIES = np.array([[0.3, -0.2, 0.5, 1.0, 0.4, -0.6], [-0.1, 0.7, 0.2, -0.3, 0.8, 0.9]])
SPRING = SpringDamper(
    first="a",
    second="b",
    first_point=np.array([0.2, 0.1, 0.0]),
    second_point=np.array([-0.1, 0.0, 0.3]),
    stiffness=100.0,
    damping=7.0,
    free_length=0.5,
)


def wrenches(force: Force, change: np.ndarray | None = None, velocities: np.ndarray = VELOCITIES) -> np.ndarray:
    state = start_state((A, B)) if change is None else moved(start_state((A, B)), change)
    out = np.zeros((2, 6))
    force.add(0.0, BodyMotions(state.positions, rotations(state.orientations), velocities), MODEL, out)
    return out


def test_a_springs_force_is_the_gradient_of_its_energy() -> None:
    def energy(change: np.ndarray) -> float:
        state = moved(start_state((A, B)), change)
        R = rotations(state.orientations)
        ends = state.positions + np.einsum("nij,nj->ni", R, [SPRING.first_point, SPRING.second_point])
        return 50.0 * float(np.linalg.norm(ends[1] - ends[0]) - 0.5) ** 2

    found, h = wrenches(SPRING, velocities=np.zeros((2, 6))), 1e-6
    for k in np.ndindex(2, 6):
        e = np.zeros((2, 6))
        e[k] = h
        assert found[k] == pytest.approx(-(energy(e) - energy(-e)) / (2 * h), abs=1e-6)


def test_a_damper_takes_power_and_acts_on_both_bodies_alike() -> None:
    damping = wrenches(SPRING) - wrenches(SPRING, velocities=np.zeros((2, 6)))
    assert np.sum(damping * VELOCITIES) < -0.1
    np.testing.assert_allclose(damping[0, :3], -damping[1, :3], atol=1e-14)
    moment = damping[:, 3:] + np.cross([A.position, B.position], damping[:, :3])
    np.testing.assert_allclose(moment.sum(axis=0), 0.0, atol=1e-14)


def test_a_hinge_torque_sees_angle_and_rate_and_acts_about_the_axis() -> None:
    seen: list[tuple[float, float, float]] = []

    def torque(t: float, angle: float, rate: float) -> float:
        seen.append((t, angle, rate))
        return 3.0

    axis, change = np.array([1.0, 2.0, 2.0]) / 3.0, np.zeros((2, 6))
    change[1, 3:] = 0.4 * axis
    found = wrenches(HingeTorque(joint="hinge", torque=torque), change)
    np.testing.assert_allclose(found[1, 3:], 3.0 * axis, atol=1e-14)
    np.testing.assert_allclose(found[0], -found[1], atol=1e-14)
    np.testing.assert_allclose(seen[0], (0.0, 0.4, (VELOCITIES[1, 3:] - VELOCITIES[0, 3:]) @ axis), atol=1e-12)


def test_a_users_force_is_added_to_its_body() -> None:
    force = AppliedForce(body="b", function=lambda _t, r, _R, u: np.concatenate([r, u[:3]]))
    found = wrenches(force)
    np.testing.assert_allclose(found[1], [*B.position, *VELOCITIES[1, :3]])
    assert not found[0].any()


def test_impossible_springs_are_refused() -> None:
    ends = {"first": "a", "second": "b", "first_point": np.zeros(3), "second_point": np.zeros(3)}
    for wrong in ({"stiffness": -1.0, "free_length": 1.0}, {"stiffness": 1.0, "free_length": 0.0}):
        with pytest.raises(InputError, match="spring between 'a' and 'b'"):
            SpringDamper(**ends, **wrong)  # type: ignore[arg-type]
    meets = SpringDamper(
        first="a",
        second="b",
        first_point=B.position - A.position,
        second_point=np.zeros(3),
        stiffness=1.0,
        free_length=1.0,
    )
    with pytest.raises(InputError, match="must be > 0"):
        wrenches(meets)
