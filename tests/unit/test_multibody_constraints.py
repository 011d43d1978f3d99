"""Constraint equations: rates and accelerations of every kind of joint against finite differences of a known motion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rover_dynamics.multibody.body import Frame, RigidBody, body
from rover_dynamics.multibody.constraint_kernels import Row
from rover_dynamics.multibody.constraints import Constraints, build_constraints, redundant_equations, wrapped
from rover_dynamics.multibody.joint import (
    LOCKED,
    Joint,
    JointKind,
    cylindrical,
    fixed,
    planar,
    prismatic,
    revolute,
    spherical,
    universal,
)
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion_law import Hold, Turn
from rover_dynamics.multibody.state import State, start_state

FREEDOMS = {
    JointKind.FIXED: 0,
    JointKind.REVOLUTE: 1,
    JointKind.PRISMATIC: 1,
    JointKind.CYLINDRICAL: 2,
    JointKind.SPHERICAL: 3,
    JointKind.UNIVERSAL: 2,
    JointKind.PLANAR: 3,
}


def two_bodies() -> tuple[RigidBody, RigidBody]:
    rng = np.random.default_rng(0)
    turns = Rotation.random(2, random_state=1).as_matrix()
    a, b = (body(name, 1.0, (1, 1, 1), rng.normal(size=3), rotation=R) for name, R in zip("ab", turns, strict=True))
    return a, b


def joints(a: RigidBody, b: RigidBody) -> tuple[Joint, ...]:
    return (
        fixed("fixed", a, b),
        revolute("revolute", a, b, at=(1, 2, 3), axis=(1, 1, 0)),
        prismatic("prismatic", a, b, at=(1, 0, 0), axis=(0, 1, 1)),
        cylindrical("cylindrical", "ground", b, at=(0, 1, 0), axis=(1, 0, 0)),
        spherical("spherical", a, b, at=(1, 1, 1)),
        universal("universal", a, b, at=(1, 0, 2), axis=(0, 0, 1), second_axis=(1, 0, 0)),
        planar("planar", a, "ground", at=(0, 0, 0), normal=(1, 2, 3)),
    )


def constraints_of(kind: JointKind) -> tuple[Constraints, tuple[RigidBody, ...]]:
    bodies = two_bodies()
    joint = next(j for j in joints(*bodies) if j.kind is kind)
    drives = (Drive(joint=joint.name, law=Turn(end=1.0, lasts=1.0), coordinate="distance"),)
    model = MultibodyModel(
        bodies=bodies, joints=(joint,), drives=drives if kind in (JointKind.PRISMATIC, JointKind.CYLINDRICAL) else ()
    )
    return build_constraints(model), bodies


class Course:
    """Two bodies with constant acceleration and angular velocities w + t w', integrated from the middle."""

    def __init__(self, bodies: tuple[RigidBody, ...]) -> None:
        rng = np.random.default_rng(5)
        self.r, self.u, self.u_dot = rng.normal(size=(2, 3)), rng.normal(size=(2, 6)), rng.normal(size=(2, 6))
        self.R = Rotation.from_quat([b.orientation for b in bodies], scalar_first=True) * Rotation.random(
            2, random_state=2
        )

    def at(self, h: float) -> State:
        w, w_dot = self.u[:, 3:], self.u_dot[:, 3:]
        turn = h * w + 0.5 * h * h * w_dot + h**3 / 12.0 * np.cross(w_dot, w)  # Magnus series to h^4
        R = Rotation.from_rotvec(turn) * self.R
        return State(
            positions=self.r + h * self.u[:, :3] + 0.5 * h * h * self.u_dot[:, :3],
            orientations=R.as_quat(scalar_first=True),
            velocities=self.u + h * self.u_dot,
        )


@pytest.mark.parametrize("kind", list(JointKind))
def test_rates_and_accelerations_are_derivatives_of_the_defects(kind: JointKind) -> None:
    constraints, bodies = constraints_of(kind)
    course, t, h = Course(bodies), 0.4, 1e-3
    now = constraints.at(t, course.at(0.0))
    C = [constraints.at(t + k * h, course.at(k * h)).defects for k in (-2, -1, 0, 1, 2)]
    rate = (C[0] - 8 * C[1] + 8 * C[3] - C[4]) / (12 * h)
    second = (-C[0] + 16 * C[1] - 30 * C[2] + 16 * C[3] - C[4]) / (12 * h * h)
    u, u_dot = course.u.ravel(), course.u_dot.ravel()
    np.testing.assert_allclose(now.jacobian @ u - now.rates, rate, atol=1e-8)
    np.testing.assert_allclose(now.jacobian @ u_dot - now.accelerations, second, atol=1e-6)
    assert np.max(np.abs(now.accelerations)) > 1e-2


def test_driven_angle_and_its_derivatives_about_a_moving_axis() -> None:
    """The bodies turn together about any axis, and the second about the joint's own by w t + w' t^2 / 2 more."""
    base = Rotation.random(random_state=3)
    frame = Frame(position=np.zeros(3), rotation=np.eye(3))
    a, b = body("a", 1.0, (1, 1, 1)), body("b", 1.0, (1, 1, 1))
    joint = Joint(name="hinge", kind=JointKind.REVOLUTE, first="a", second="b", first_frame=frame, second_frame=frame)
    drive = Drive(joint="hinge", law=Turn(end=2.0, lasts=1.0))
    constraints = build_constraints(MultibodyModel(bodies=(a, b), joints=(joint,), drives=(drive,)))
    spin, w, w_dot, h, t = np.array([0.3, -0.7, 0.5]), 0.8, -1.7, 1e-3, 0.4

    def state(s: float) -> State:
        first = Rotation.from_rotvec(s * spin) * base
        second = first * Rotation.from_rotvec([0, 0, 1.1 + w * s + 0.5 * w_dot * s * s])
        axis = first.apply([0, 0, 1])
        velocities = np.zeros((2, 6))
        velocities[:, 3:] = spin, spin + (w + w_dot * s) * axis
        orientations = np.array([first.as_quat(scalar_first=True), second.as_quat(scalar_first=True)])
        return State(positions=np.zeros((2, 3)), orientations=orientations, velocities=velocities)

    row = next(k for k, e in enumerate(constraints.equations) if e.kind is Row.ANGLE)
    now = constraints.at(t, state(0.0))
    values = [constraints.at(t + k * h, state(k * h)).defects[row] for k in (-1, 0, 1)]
    u_dot = np.zeros(12)
    axis = base.apply([0, 0, 1])
    u_dot[9:] = w_dot * axis + w * np.cross(spin, axis)
    rate = (now.jacobian @ state(0.0).velocities.ravel() - now.rates)[row]
    assert rate == pytest.approx((values[2] - values[0]) / (2 * h), abs=1e-5)
    second = (values[0] - 2 * values[1] + values[2]) / h**2
    assert (now.jacobian @ u_dot - now.accelerations)[row] == pytest.approx(second, abs=1e-4)


@pytest.mark.parametrize("kind", list(JointKind))
def test_joints_are_closed_as_given_and_leave_their_freedoms(kind: JointKind) -> None:
    constraints, bodies = constraints_of(kind)
    values = constraints.at(0.0, start_state(bodies))
    assert np.max(np.abs(values.defects)) < 1e-14
    own = [k for k, e in enumerate(constraints.equations) if e.drive is None]
    assert np.linalg.matrix_rank(values.jacobian.toarray()[own]) == 6 - FREEDOMS[kind] == len(own)
    assert len(LOCKED[kind].translations) + len(LOCKED[kind].right_angles) == len(own)


def test_equations_given_twice_are_redundant_and_named() -> None:
    a, b = two_bodies()
    twice = (spherical("ball", a, b, at=(1, 1, 1)), revolute("hinge", a, b, at=(1, 1, 1), axis=(0, 0, 1)))
    constraints = build_constraints(MultibodyModel(bodies=(a, b), joints=twice))
    rows = redundant_equations(constraints.at(0.0, start_state((a, b))).jacobian)
    assert len(rows) == 3
    assert all("no motion along" in str(constraints.equations[k]) for k in rows)
    rest = constraints.part(np.setdiff1d(np.arange(len(constraints.equations)), rows))
    assert len(redundant_equations(rest.at(0.0, start_state((a, b))).jacobian)) == 0


def test_angles_are_wrapped() -> None:
    assert wrapped(2.0 * np.pi + 0.1) == pytest.approx(0.1)
    assert wrapped(-np.pi) == pytest.approx(-np.pi)


def test_drives_say_what_they_are() -> None:
    a, b = two_bodies()
    hinge = revolute("hinge", a, b, at=(1, 1, 1), axis=(0, 0, 1))
    model = MultibodyModel(bodies=(a, b), joints=(hinge,), drives=(Drive(joint="hinge", law=Hold()),))
    assert str(build_constraints(model).equations[-1]) == "drive of 'hinge'"
