"""Claim: explicit steps are of order eight and implicit ones of order two, on trees, ball joints, drives and loops.

Source: Hairer, Norsett and Wanner 1993 (DOP853); Chung and Hulbert 1993, Bruels and Arnold 2008 (generalised-alpha,
also where steps change). Exact: explicit steps of 1e-11. Tolerances: order 8 within 0.7, order 2 within 0.1 for fixed
steps, 0.25 over the number of steps chosen by the error. Negative controls: Runge-Kutta weights and a coefficient gamma
that are off are seen in the order, and so are the method's accelerations left at the time of the last step.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.integrate import DOP853

import rover_dynamics.multibody.implicit_stepper as stepper_module
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.generalised_alpha import Method, generalised_alpha
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import ImplicitSteps, Motion, StepControl, integrate
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import pendulum
from rover_dynamics.multibody.verification.spatial import every_joint, spatial_loops

MODELS = {"pendulum": pendulum, "every joint": every_joint, "loops": spatial_loops}
TIMES = np.array([0.0, 0.2, 0.5])
LENGTHS = (0.01, 0.005, 0.0025)


def spinning_body() -> MultibodyModel:
    spinning = body("body", 2.0, (1.0, 2.0, 2.5), velocity=(0.1, 0.2, 0.3), angular_velocity=(0.3, 0.0, 2.0))
    return MultibodyModel(bodies=(spinning,), gravity=(0.0, 0.0, 0.0))


@cache
def reference(name: str) -> Motion:
    return integrate(TreeCoordinates(MODELS[name]()), TIMES, StepControl(relative=1e-11, absolute=1e-12))


def distance(motion: Motion, other: Motion) -> float:
    pairs = zip(motion.states, other.states, strict=True)
    return max(float(np.max(np.abs(a.positions - b.positions))) for a, b in pairs)


def fixed_step_orders(name: str, radius: float = 0.6) -> np.ndarray:
    errors = []
    for length in LENGTHS:
        motion = integrate(TreeCoordinates(MODELS[name]()), TIMES, ImplicitSteps(fixed=length, spectral_radius=radius))
        assert motion.steps == round(TIMES[-1] / length)
        errors.append(distance(motion, reference(name)))
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def adaptive_order(name: str) -> float:
    """Slope of the error over the number of steps, for errors of a step 1e-6 and 1e-8."""
    runs = [integrate(TreeCoordinates(MODELS[name]()), TIMES, ImplicitSteps(tolerance=tol)) for tol in (1e-6, 1e-8)]
    errors = [distance(run, reference(name)) for run in runs]
    return float(np.log(errors[0] / errors[1]) / np.log(runs[1].steps / runs[0].steps))


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("radius", [0.0, 0.6, 1.0])
def test_implicit_fixed_steps(name: str, radius: float) -> None:
    np.testing.assert_allclose(fixed_step_orders(name, radius), 2.0, atol=0.1)


@pytest.mark.parametrize("name", ["pendulum", "every joint", "loops"])
def test_implicit_steps_chosen_by_their_error(name: str) -> None:
    assert adaptive_order(name) == pytest.approx(2.0, abs=0.25)


def test_negative_control_a_wrong_coefficient(monkeypatch: pytest.MonkeyPatch) -> None:
    def off(spectral_radius: float, tolerance: float, iterations: int) -> Method:
        method = generalised_alpha(spectral_radius, tolerance, iterations)
        return method._replace(gamma=method.gamma + 0.1)

    monkeypatch.setattr(stepper_module, "generalised_alpha", off)
    assert np.all(fixed_step_orders("every joint") < 1.5)


def test_negative_control_accelerations_of_the_last_steps_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where every second step is a quarter as long."""
    towards = ImplicitSteps.towards

    def errors() -> list[float]:
        found = []
        for length in (0.01, 0.005, 0.0025):
            turn = iter(range(10_000))
            monkeypatch.setattr(
                ImplicitSteps,
                "towards",
                lambda self, left, wish, n=turn: towards(self, left, wish) * (1.0 if next(n) % 2 else 0.25),
            )
            motion = integrate(TreeCoordinates(every_joint()), TIMES, ImplicitSteps(fixed=length))
            found.append(distance(motion, reference("every joint")))
        return found

    moved = errors()
    assert np.log2(moved[1] / moved[2]) == pytest.approx(2.0, abs=0.2)
    monkeypatch.setattr(stepper_module, "rescaled_rates", lambda _a, A, _ratio: A)
    left = errors()
    assert np.log2(left[1] / left[2]) < 1.5


def explicit_order() -> float:
    ends = []
    for step in (0.5, 0.25, 0.015625):
        motion = integrate(TreeCoordinates(spinning_body()), np.array([0.0, 4.0]), StepControl(fixed=step))
        ends.append(motion.states[-1].velocities[0, 3:])
    errors = [float(np.max(np.abs(end - ends[-1]))) for end in ends[:-1]]
    return float(np.log2(errors[0] / errors[1]))


def test_explicit_steps_are_of_order_eight() -> None:
    """In closed form: tests/verification/test_multibody_rigid_body.py."""
    assert explicit_order() == pytest.approx(8.0, abs=0.7)


def test_negative_control_wrong_weights(monkeypatch: pytest.MonkeyPatch) -> None:
    """Still consistent: the weights' sum stays one."""
    weights = DOP853.B.copy()
    weights[5:7] += 1e-3 * np.array([1.0, -1.0])
    monkeypatch.setattr(DOP853, "B", weights)
    assert explicit_order() < 3.0


def test_explicit_errors_follow_the_error_asked_for() -> None:
    """A hundredfold error allowed in a step is at least thirty times the error of the motion."""
    runs = [
        integrate(TreeCoordinates(every_joint()), TIMES, StepControl(relative=error, absolute=error))
        for error in (1e-4, 1e-6, 1e-8)
    ]
    errors = [distance(run, reference("every joint")) for run in runs]
    assert errors[0] > 30.0 * errors[1] > 900.0 * errors[2]
