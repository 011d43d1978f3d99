"""Claim: reactions of joints are those of statics and of Newton's equations, in all formulations.

Source: pendulum, m (g cos a + L w^2) along the arm; cantilever of two welded bodies; a rod on
a hinge and a slider, shared by the lever. All kinds of joints: test_multibody_formulations.py.
Tolerances: 1e-9 N, rounding of the assembled start; the pendulum 1e-6 N, from its steps. Negative control: the moment
about another point is not the joint's.
"""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.joint import fixed, planar, revolute
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion import StepControl, integrate
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.multibody.partitioned_coordinates import PartitionedCoordinates
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import pendulum

FORMULATIONS = [AbsoluteCoordinates, PartitionedCoordinates, TreeCoordinates]
Make = type[AbsoluteCoordinates] | type[TreeCoordinates]
J = (0.01, 0.01, 0.01)
G = 9.81


@pytest.mark.parametrize("make", FORMULATIONS)
def test_pendulum_pulls_by_weight_and_centripetal_force(make: Make) -> None:
    formulation, t = make(pendulum()), 0.7
    motion = integrate(formulation, np.array([0.0, t]), StepControl(relative=1e-10, absolute=1e-11))
    arm, v = motion.states[-1].positions[0], motion.states[-1].velocities[0, :3]
    force = formulation.reactions(t, motion.coordinates[-1]).of("pin")
    pull = v @ v + G * -arm[1]  # m = L = 1
    np.testing.assert_allclose(force[:3], -pull * arm, atol=1e-6)
    np.testing.assert_allclose(force[3:], 0.0, atol=1e-6)


def cantilever(first: str = "ground") -> MultibodyModel:
    """Two bodies welded in a row to the ground, either end of the wall's weld named first."""
    a, b = body("a", 2.0, J, (0.5, 0, 0)), body("b", 3.0, J, (1.5, 0, 0))
    ends = ("ground", a) if first == "ground" else (a, "ground")
    joints = (fixed("wall", *ends, at=(0, 0, 0)), fixed("middle", a, b, at=(1.0, 0, 0)))
    return MultibodyModel(bodies=(a, b), joints=joints)


@pytest.mark.parametrize("make", FORMULATIONS)
def test_cantilever_carries_weight_and_its_moment(make: Make) -> None:
    formulation = make(cantilever())
    reactions = formulation.reactions(0.0, formulation.start())
    np.testing.assert_allclose(reactions.of("wall"), [0, 0, 5 * G, 0, -(1.0 + 4.5) * G, 0], atol=1e-9)
    np.testing.assert_allclose(reactions.of("middle"), [0, 0, 3 * G, 0, -1.5 * G, 0], atol=1e-9)
    turned = make(cantilever("a"))
    on_ground = turned.reactions(0.0, turned.start()).of("wall")
    np.testing.assert_allclose(on_ground, [0, 0, -5 * G, 0, 5.5 * G, 0], atol=1e-9)
    with pytest.raises(InputError, match="'floor'"):
        reactions.of("floor")


@pytest.mark.parametrize("make", FORMULATIONS)
def test_a_rod_on_a_hinge_and_a_slider_shares_its_weight_by_the_lever(make: Make) -> None:
    """The loop is closed by a joint that only holds in z; the hinge's drive elsewhere has an effort."""
    rod, shoe = body("rod", 4.0, J, (0.25, 0, 0)), body("shoe", 1.0, J, (1.0, 0, 0))
    joints = (
        revolute("hinge", "ground", rod, at=(0, 0, 0), axis=(0, 1, 0)),
        revolute("ball", rod, shoe, at=(1.0, 0, 0), axis=(0, 1, 0)),
        planar("floor", "ground", shoe, at=(1.0, 0, 0), normal=(0, 0, 1)),
    )
    formulation = make(MultibodyModel(bodies=(rod, shoe), joints=joints))
    reactions = formulation.reactions(0.0, formulation.start())
    assert reactions.of("hinge")[2] == pytest.approx(4.0 * G * 0.75, abs=1e-9)
    assert reactions.of("floor")[2] == pytest.approx(4.0 * G * 0.25 + G, abs=1e-9)


@pytest.mark.parametrize("make", FORMULATIONS)
@pytest.mark.parametrize("turned", [False, True])
def test_a_held_hinge_needs_the_moment_of_the_weight(make: Make, turned: bool) -> None:
    arm = body("arm", 2.0, J, (0.5, 0, 0))
    ends = (arm, "ground") if turned else ("ground", arm)
    hinge = revolute("hinge", *ends, at=(0, 0, 0), axis=(0, -1, 0))
    model = MultibodyModel(bodies=(arm,), joints=(hinge,), drives=(Drive(joint="hinge", law=Hold()),))
    formulation = make(model)
    reactions = formulation.reactions(0.0, formulation.start())
    sign = -1.0 if turned else 1.0
    assert reactions.efforts[0] == pytest.approx(sign * G, abs=1e-9)
    np.testing.assert_allclose(reactions.of("hinge"), sign * np.array([0, 0, 2 * G, 0, -G, 0]), atol=1e-9)


def test_the_moment_is_that_about_the_joint() -> None:
    """Negative control: about the second body's centre of mass it is another."""
    formulation = TreeCoordinates(cantilever())
    wrench = formulation.reactions(0.0, formulation.start()).of("wall")
    about_centre = wrench[3:] + np.cross([-0.5, 0, 0], wrench[:3])
    assert abs(about_centre[1] - -5.5 * G) > 1.0
