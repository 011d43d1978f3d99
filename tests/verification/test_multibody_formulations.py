"""Claim: the three formulations give one motion, and hold every constraint, with all joints and with loops.

Source: equation 2.26 in absolute coordinates with projection, its partition into independent coordinates (section
2.5.3), and joint coordinates by Featherstone's recursions. Tolerances: errors of 1e-10 are
asked for in a step; positions agree to 1e-8 m and velocities to 1e-7, reactions to 1e-6 N; constraints hold to 1e-10.
Negative control: a joint of another kind moves otherwise.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.multibody.body import RigidBody, body
from rover_dynamics.multibody.force import HingeTorque, SpringDamper
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.joint import (
    cylindrical,
    fixed,
    planar,
    prismatic,
    revolute,
    spherical,
    universal,
)
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion import Motion, StepControl, integrate
from rover_dynamics.multibody.motion_law import Turn
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import constraint_defects

TIMES = np.linspace(0.0, 0.3, 4)
Z = (0.0, 0.0, 1.0)


def every_joint(*, ball_at_the_end: bool = True) -> MultibodyModel:
    """A chain with all kinds of joint, some given from the second body, two of them driven."""
    rng, moments = np.random.default_rng(3), (0.1, 0.2, 0.15)
    a, b, c, d, e, f, g, h = (body(n, 1.0 + 0.3 * k, moments, rng.normal(size=3)) for k, n in enumerate("abcdefgh"))
    end = {"at": (0.3, 0.3, 0.3)}
    joints = (
        revolute("base", "ground", a, at=(0, 0, 0), axis=(0, 1, 0.2)),
        universal("cross", b, a, at=(0.5, 0, 0), axis=(0, 0, 1), second_axis=(1, 1, 0)),
        cylindrical("tube", c, b, at=(1, 0, 0), axis=(1, 0, 1)),
        spherical("ball", c, d, at=(1, 1, 0)),
        planar("plane", d, e, at=(1, 1, 1), normal=(0, 1, 1)),
        prismatic("slide", f, e, at=(1, 2, 0), axis=(1, 0, 0)),
        fixed("weld", f, g),
        spherical("end", h, g, **end) if ball_at_the_end else revolute("end", h, g, axis=(0, 1, 0), **end),
    )
    drives = (
        Drive(joint="base", law=Turn(end=1.0, lasts=1.0)),
        Drive(joint="tube", law=Turn(end=0.5, lasts=0.7), coordinate="distance"),
    )
    spring = SpringDamper(
        first="ground",
        second="h",
        first_point=np.array([2.0, 0, 0]),
        second_point=np.array([0.1, 0, 0]),
        stiffness=20.0,
        damping=1.0,
        free_length=0.5,
    )
    return MultibodyModel(bodies=(a, b, c, d, e, f, g, h), joints=joints, drives=drives, forces=(spring,))


def loops() -> MultibodyModel:
    """A spatial four-bar (hinges, ball, cross) and, on its crank, a driven plane four-bar with redundant equations."""
    J = (0.02, 0.03, 0.025)
    crank, rod, rocker = body("crank", 1.0, J, (0.1, 0, 0)), body("rod", 1.0, J, (0.5, 0.2, 0.2)), _rocker(J)
    left, top, right = (
        body(n, 0.5, J, at) for n, at in (("l", (0, 0.1, 1)), ("t", (0.2, 0.2, 1)), ("r", (0.4, 0.1, 1)))
    )
    joints = (
        revolute("crank", "ground", crank, at=(0, 0, 0), axis=(0, 0.1, 1)),
        spherical("ball", crank, rod, at=(0.2, 0, 0)),
        universal("cross", rod, rocker, at=(0.8, 0.4, 0.4), axis=(0, 1, 0), second_axis=(0, 0, 1)),
        revolute("rocker", "ground", rocker, at=(0.8, 0.4, 0.0), axis=(1, 0, 0)),
        revolute("left", "ground", left, at=(0, 0, 1), axis=Z),
        revolute("upper left", left, top, at=(0, 0.2, 1), axis=Z),
        revolute("upper right", top, right, at=(0.4, 0.2, 1), axis=Z),
        revolute("right", "ground", right, at=(0.4, 0, 1), axis=Z),
    )
    drives = (Drive(joint="upper right", law=Turn(end=0.6, lasts=0.5)),)
    motor = HingeTorque(joint="crank", torque=lambda t, _angle, rate: 0.1 * np.cos(5.0 * t) - 0.05 * rate)
    bodies = (crank, rod, rocker, left, top, right)
    return MultibodyModel(bodies=bodies, joints=joints, drives=drives, forces=(motor,))


def _rocker(J: tuple[float, float, float]) -> RigidBody:
    return body("rocker", 1.0, J, (0.8, 0.4, 0.2))


def motions(model: MultibodyModel) -> list[tuple[Motion, np.ndarray, np.ndarray]]:
    """Each formulation's motion, reactions and efforts at the times."""
    out = []
    for make in (AbsoluteCoordinates, PartitionedCoordinates, TreeCoordinates):
        formulation = make(model)
        motion = integrate(formulation, TIMES, StepControl(relative=1e-10, absolute=1e-11))
        reactions = [formulation.reactions(t, y) for t, y in zip(TIMES, motion.coordinates, strict=True)]
        out.append((motion, np.array([r.wrenches for r in reactions]), np.array([r.efforts for r in reactions])))
    return out


def difference(first: Motion, second: Motion) -> tuple[float, float]:
    pairs = list(zip(first.states, second.states, strict=True))
    return (
        max(float(np.max(np.abs(a.positions - b.positions))) for a, b in pairs),
        max(float(np.max(np.abs(a.velocities - b.velocities))) for a, b in pairs),
    )


@pytest.mark.parametrize("model", [every_joint(), loops()], ids=["every joint", "loops"])
def test_one_motion_with_all_constraints_held(model: MultibodyModel) -> None:
    found = motions(model)
    for motion, _, efforts in found:
        for t, state in zip(TIMES, motion.states, strict=True):
            assert max(constraint_defects(model, t, state)) < 1e-10
        np.testing.assert_allclose(efforts, found[0][2], atol=1e-6)
        position, velocity = difference(motion, found[0][0])
        assert position < 1e-8
        assert velocity < 1e-7
    assert np.max(np.abs(found[0][0].states[-1].positions - found[0][0].states[0].positions)) > 0.05


def test_reactions_of_every_joint_agree() -> None:
    """By multipliers, and by the balance of all bodies behind the joint; nothing is redundant here."""
    found = motions(every_joint())
    for _, wrenches, _ in found[1:]:
        np.testing.assert_allclose(wrenches, found[0][1], atol=1e-6)
    assert np.max(np.abs(found[0][1])) > 10.0


def test_another_joint_moves_otherwise() -> None:
    """Negative control: with a hinge for the last ball joint."""
    made = [TreeCoordinates(model) for model in (every_joint(), every_joint(ball_at_the_end=False))]
    first, second = (integrate(m, TIMES, StepControl(relative=1e-8, absolute=1e-9)) for m in made)
    assert difference(first, second)[0] > 1e-4


def test_partition_has_as_many_independent_velocities_as_freedoms() -> None:
    model = replace(loops(), drives=())
    tree, parts = TreeCoordinates(model), PartitionedCoordinates(model)
    freedoms = len(tree.free) - len(tree.loops.dependent)
    assert len(parts.independent) == freedoms == 2  # of the spatial and of the plane four-bar
    assert len(tree.redundant) == len(parts.equations.redundant) == 3
