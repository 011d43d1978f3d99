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

from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import Motion, StepControl, integrate
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import constraint_defects
from rover_dynamics.multibody.verification.spatial import every_joint, spatial_loops

TIMES = np.linspace(0.0, 0.5, 6)


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


@pytest.mark.parametrize("model", [every_joint(), spatial_loops()], ids=["every joint", "loops"])
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
    model = replace(spatial_loops(), drives=())
    tree, parts = TreeCoordinates(model), PartitionedCoordinates(model)
    freedoms = len(tree.free) - len(tree.loops.dependent)
    assert len(parts.independent) == freedoms == 2  # of the spatial and of the plane four-bar
    assert len(tree.redundant) == len(parts.equations.redundant) == 3
