"""Models that cannot be are refused, each with one clear message."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.multibody.body import body, rotation_to
from rover_dynamics.multibody.force import AppliedForce
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.joint import planar, revolute, spherical, universal
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion import StepControl
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.multibody.state import moved, rotations, start_state

A, B = body("a", 1.0, (1, 1, 1)), body("b", 1.0, (1, 1, 1), (1, 0, 0))
HINGE = revolute("hinge", A, B, at=(0, 0, 0), axis=(0, 0, 1))


def test_bodies() -> None:
    with pytest.raises(InputError, match=r"mass of body 'x' = 0 kg: must be finite and > 0"):
        body("x", 0.0, (1, 1, 1))
    with pytest.raises(InputError, match="word other than 'ground'"):
        body("ground", 1.0, (1, 1, 1))
    with pytest.raises(InputError, match="above the sum of the other two"):
        body("x", 1.0, (1, 1, 3))
    with pytest.raises(InputError, match="> 0 about every axis"):
        body("x", 1.0, (1, 1, 0))
    with pytest.raises(InputError, match="symmetric"):
        body("x", 1.0, np.arange(9.0).reshape(3, 3))
    with pytest.raises(InputError, match="position of body 'x'"):
        body("x", 1.0, (1, 1, 1), (0, np.nan, 0))
    with pytest.raises(InputError, match="unit quaternion"):
        body("x", 1.0, (1, 1, 1), rotation=(1, 1, 0, 0))
    with pytest.raises(InputError, match="right-handed"):
        body("x", 1.0, (1, 1, 1), rotation=np.diag([1.0, 1.0, -1.0]))


def test_joints() -> None:
    with pytest.raises(InputError, match="joint 'loop' = 'a' and 'a': must join two different bodies"):
        spherical("loop", A, A, at=(0, 0, 0))
    with pytest.raises(InputError, match="or the word 'ground'"):
        spherical("ball", "a", B, at=(0, 0, 0))
    with pytest.raises(InputError, match="must be at right angles"):
        universal("cross", A, B, at=(0, 0, 0), axis=(0, 0, 1), second_axis=(0, 1, 1))
    with pytest.raises(InputError, match="joint axis"):
        planar("plane", A, B, at=(0, 0, 0), normal=(0, 0, 0))
    with pytest.raises(InputError, match="along the first"):
        rotation_to(np.array([0.0, 0, 1]), np.array([0.0, 0, 2]))


def test_names() -> None:
    with pytest.raises(InputError, match="at least one"):
        MultibodyModel(bodies=())
    with pytest.raises(InputError, match="body 'a' = 2 times"):
        MultibodyModel(bodies=(A, A))
    with pytest.raises(InputError, match="joint 'hinge' = 2 times"):
        MultibodyModel(bodies=(A, B), joints=(HINGE, HINGE))
    with pytest.raises(InputError, match="body named in joint 'hinge' = 'b': is not in the model; it has: a"):
        MultibodyModel(bodies=(A,), joints=(HINGE,))
    with pytest.raises(InputError, match="joint named in drive = 'pin'"):
        MultibodyModel(bodies=(A, B), joints=(HINGE,), drives=(Drive(joint="pin", law=Hold()),))
    drive = Drive(joint="hinge", law=Hold(), coordinate="distance")
    with pytest.raises(InputError, match="revolute joint has no distance"):
        MultibodyModel(bodies=(A, B), joints=(HINGE,), drives=(drive,))
    model = MultibodyModel(bodies=(A, B), joints=(HINGE,))
    with pytest.raises(InputError, match="'c'"):
        model.number("c")
    with pytest.raises(InputError, match="'pin'"):
        model.joint("pin")


def test_a_force_on_an_unknown_body_is_refused() -> None:
    force = AppliedForce(body="c", function=lambda _t, _r, _R, _u: np.zeros(6))
    equations = AbsoluteCoordinates(MultibodyModel(bodies=(A,), forces=(force,)))
    with pytest.raises(InputError, match="'c': is not in the model"):
        equations.rates(0.0, equations.start())


def test_step_control() -> None:
    with pytest.raises(InputError, match="fixed step"):
        StepControl(fixed=0.0)
    with pytest.raises(InputError, match="relative error"):
        StepControl(relative=-1.0)


def test_states_move_in_world_axes() -> None:
    state = start_state((A, B))
    change = np.zeros((2, 6))
    change[1] = 0.1, 0.2, 0.3, 0.0, 0.0, np.pi / 2
    after = moved(state, change)
    np.testing.assert_allclose(after.positions[1], [1.1, 0.2, 0.3])
    np.testing.assert_allclose(rotations(after.orientations)[1] @ [1, 0, 0], [0, 1, 0], atol=1e-15)
    np.testing.assert_array_equal(after.orientations[0], state.orientations[0])
