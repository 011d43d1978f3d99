"""Claim: static equilibrium is found where closed forms have it, with its reactions; what falls is refused.

Source: a pendulum with a torsion spring, k a = m g L sin a; a plate on four springs that push only; a slider-crank, by
virtual work. Tolerances: 1e-8 rad, 1e-7 m, from accelerations below 1e-8; efforts 1e-6 N m. Negative control: a spring
stiffer by 0.1 % rests elsewhere.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.force import AppliedForce, HingeTorque
from rover_dynamics.multibody.joint import prismatic, revolute
from rover_dynamics.multibody.model import Drive, Force, MultibodyModel
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.multibody.state import rotations
from rover_dynamics.multibody.static_equilibrium import static_equilibrium
from rover_dynamics.multibody.verification.mechanisms import slider_crank

J, G = (0.01, 0.01, 0.01), 9.81


def torsion_pendulum(k: float = 5.0) -> MultibodyModel:
    """An arm of 1 m and 1 kg that starts to the side; its spring is relaxed straight up."""
    arm = body("arm", 1.0, J, (1.0, 0, 0))
    hinge = revolute("hinge", "ground", arm, at=(0, 0, 0), axis=(0, 1, 0))
    spring = HingeTorque(joint="hinge", torque=lambda _t, a, rate: -k * (a + np.pi / 2) - 0.1 * rate)
    return MultibodyModel(bodies=(arm,), joints=(hinge,), forces=(spring,))


def angle_from_upright(k: float) -> float:
    found = static_equilibrium(torsion_pendulum(k))
    assert found.stable
    x, _, z = found.state.positions[0]
    return float(np.arctan2(x, z))


def test_pendulum_on_a_torsion_spring() -> None:
    exact = brentq(lambda a: 5.0 * a - G * np.sin(a), 1.0, 3.0, xtol=1e-14)
    assert angle_from_upright(5.0) == pytest.approx(exact, abs=1e-8)


def test_another_stiffness_rests_elsewhere() -> None:
    """Negative control."""
    assert abs(angle_from_upright(5.005) - angle_from_upright(5.0)) > 1e-4


def plate_on_springs(k: float) -> MultibodyModel:
    """A plate, free to slide and turn on the level, on four legs that push up only while they touch."""
    feet = np.array([[0.5, 0.3, 0], [0.5, -0.3, 0], [-0.5, 0.3, 0], [-0.5, -0.3, 0]])

    def push(foot: np.ndarray) -> Force:
        def wrench(_t: float, r: np.ndarray, R: np.ndarray, _u: np.ndarray) -> np.ndarray:
            arm = R @ foot
            force = np.array([0.0, 0.0, k * max(-(r + arm)[2], 0.0)])
            return np.concatenate([force, np.cross(arm, force)])

        return AppliedForce(body="plate", function=wrench)

    plate = body("plate", 10.0, (1.0, 1.0, 1.5), (0.2, -0.1, 0.05), rotation=_leaning(0.1))
    return MultibodyModel(bodies=(plate,), forces=tuple(push(foot) for foot in feet))


def _leaning(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def test_a_plate_falls_on_its_legs_and_keeps_its_neutral_directions() -> None:
    found = static_equilibrium(plate_on_springs(1000.0))
    np.testing.assert_allclose(found.state.positions[0], [0.2, -0.1, -10.0 * G / 4000.0], atol=1e-7)
    np.testing.assert_allclose(rotations(found.state.orientations)[0][2], [0, 0, 1], atol=1e-7)
    assert (found.neutral, found.stable) == (3, True)
    assert found.acceleration < 1e-8


def test_a_loop_hangs_and_its_held_crank_has_the_effort_of_the_weights() -> None:
    """Slider-crank under its weight, held at 60 degrees: moment of the weights by virtual work."""
    r, rod, a = 0.1, 0.3, np.pi / 3
    b = np.arcsin(r * np.sin(a) / rod)
    model = slider_crank(gravity=(0.0, -G, 0.0))
    held = replace(model, drives=(Drive(joint="main bearing", law=Hold(value=a)),))
    effort = static_equilibrium(held).reactions.efforts[0]
    slope = r * np.cos(a) / (rod * np.cos(b))  # db / da
    height_rate = 1.0 * 0.5 * r * np.cos(a) + 0.5 * (0.5 * rod * np.cos(b) * slope)
    assert effort == pytest.approx(G * height_rate, abs=1e-6)


def test_a_free_slider_crank_hangs_down() -> None:
    found = static_equilibrium(replace(slider_crank(), bodies=slider_crank().bodies))
    assert found.stable
    assert found.state.positions[0, 1] == pytest.approx(-0.05, abs=1e-8)


def test_what_falls_is_refused() -> None:
    weight = body("weight", 1.0, J)
    rail = prismatic("rail", "ground", weight, at=(0, 0, 0), axis=(0, 0, 1))
    with pytest.raises(ConvergenceError, match=r"no static equilibrium found.*support what falls"):
        static_equilibrium(MultibodyModel(bodies=(weight,), joints=(rail,)), iterations=30)
    with pytest.raises(InputError, match="tolerance"):
        static_equilibrium(torsion_pendulum(), tolerance=0.0)
