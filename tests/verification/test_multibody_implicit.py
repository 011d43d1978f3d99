"""Claim: implicit steps move any model, hold all constraints, pass singular positions, and are few for stiff forces.

Source: the same equations by explicit steps of order 8 and small errors; a ball dropped 0.1 m onto a plane of penalty
k = 1e7 N/m with an overdamped contact falls as h - g t^2 / 2 and rests at -m g / k; the N-four-bar in
contracts/published/iftomm_four_bar.csv. Tolerances: constraints to 1e-10 at position, velocity and, over the largest
acceleration, at acceleration level; motions to 5e-5 m with 1e-8 a step in half a second; four-bar to 2e-3 m, with 1e-7
a step over two turns; a tenth of the explicit steps or evaluations. Negative controls: positions not closed are seen
at all levels; another stiffness rests elsewhere; the soft contact saves no steps.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from contracts.errors import ConvergenceError, InputError
from contracts.published import published_table
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.constraints import build_constraints
from rover_dynamics.multibody.force import AppliedForce, SpringDamper
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.joint import revolute
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import Event, ImplicitSteps, Motion, StepControl, integrate
from rover_dynamics.multibody.state import State
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.tree_jacobians import body_jacobian
from rover_dynamics.multibody.verification.andrews import andrews_squeezer
from rover_dynamics.multibody.verification.mechanisms import n_four_bar, pendulum, slider_crank, tip_of_four_bar
from rover_dynamics.multibody.verification.spatial import every_joint, spatial_loops

MODELS: dict[str, tuple[Callable[[], MultibodyModel], float]] = {
    "pendulum": (pendulum, 0.5),
    "every joint": (every_joint, 0.5),
    "spatial loops": (spatial_loops, 0.5),
    "slider-crank": (slider_crank, 0.5),
    "squeezer": (andrews_squeezer, 0.005),
}
G = 9.81
TIMES = np.linspace(0.0, 2.0, 21)


def defects(equations: TreeCoordinates, t: float, y: np.ndarray) -> np.ndarray:
    """Largest defect of all equations, redundant ones too: position, velocity, acceleration over the largest one."""
    state, motion = equations.state(t, y), equations.motion(t, y)
    values = build_constraints(equations.model).at(t, state)
    joints = equations.accelerations(t, motion).joints
    u_dot = motion.accelerations[:-1].ravel() + body_jacobian(equations.tree, motion) @ joints
    scale = max(1.0, float(np.max(np.abs(u_dot))))
    levels = (
        values.defects,
        values.jacobian @ state.velocities.ravel() - values.rates,
        (values.jacobian @ u_dot - values.accelerations) / scale,
    )
    return np.array([np.max(np.abs(level), initial=0.0) for level in levels])


@pytest.mark.parametrize("name", MODELS)
def test_constraints_hold_at_all_levels(name: str) -> None:
    make, end = MODELS[name]
    times, equations = np.linspace(0.0, end, 7), TreeCoordinates(make())
    motion = integrate(equations, times, ImplicitSteps(tolerance=1e-6, first=1e-5))
    for t, y in zip(motion.times, motion.coordinates, strict=True):
        assert np.all(defects(equations, t, y) < 1e-10)


def test_negative_control_a_loop_left_open_is_seen() -> None:
    equations = TreeCoordinates(spatial_loops())
    y = equations.corrected(0.0, equations.start())
    y[int(equations.tree.q_at[-1]) - 1] += 1e-6
    y[-1] += 1e-6
    assert np.all(defects(equations, 0.0, y)[:2] > 1e-8)


@pytest.mark.parametrize("name", ["every joint", "spatial loops", "slider-crank"])
def test_the_motion_is_that_of_explicit_steps(name: str) -> None:
    make, end = MODELS[name]
    times = np.linspace(0.0, end, 4)
    ours = integrate(TreeCoordinates(make()), times, ImplicitSteps(tolerance=1e-8))
    other = integrate(TreeCoordinates(make()), times, StepControl(relative=1e-10, absolute=1e-11))
    away = [np.abs(a.positions - b.positions).max() for a, b in zip(ours.states, other.states, strict=True)]
    assert max(away) < 5e-5


def test_singular_positions_are_passed() -> None:
    """Two four-bars over 2.5 s: all bars lie in line three times."""
    table = published_table("iftomm_four_bar")
    times = np.asarray(table["t"][:6])
    motion = integrate(TreeCoordinates(n_four_bar(2)), times, ImplicitSteps(tolerance=1e-7))
    found = np.array([tip_of_four_bar(state)[:2] for state in motion.states])
    expected = np.stack([table["B0x"][:6], table["B0y"][:6]], axis=1)
    np.testing.assert_allclose(found, expected, atol=2e-3)


def ball(k: float, c: float) -> MultibodyModel:
    """1 kg, its lowest point 0.1 m above a plane that only pushes."""

    def push(_t: float, r: np.ndarray, _R: np.ndarray, u: np.ndarray) -> np.ndarray:
        return np.array([0.0, 0.0, max(-k * r[2] - c * u[2], 0.0) if r[2] < 0.0 else 0.0, 0.0, 0.0, 0.0])

    stone = body("ball", 1.0, (1e-3, 1e-3, 1e-3), (0.0, 0.0, 0.1))
    return MultibodyModel(bodies=(stone,), forces=(AppliedForce(body="ball", function=push),))


def dropped(k: float, c: float, control: StepControl | ImplicitSteps) -> Motion:
    return integrate(TreeCoordinates(ball(k, c)), TIMES, control)


def test_a_ball_on_a_stiff_plane_takes_a_tenth_of_the_explicit_steps() -> None:
    k, c = 1e7, 1e4
    ours = dropped(k, c, ImplicitSteps(tolerance=1e-6, longest=0.1))
    other = dropped(k, c, StepControl(relative=1e-6, absolute=1e-6))
    heights = np.array([state.positions[0, 2] for state in ours.states])
    assert heights[1] == pytest.approx(0.1 - 0.5 * G * TIMES[1] ** 2, abs=1e-6)
    assert heights[-1] == pytest.approx(-G / k, abs=1e-9)
    np.testing.assert_allclose(heights, [state.positions[0, 2] for state in other.states], atol=2e-5)
    assert 10 * ours.steps < other.steps


def test_another_stiffness_rests_elsewhere() -> None:
    """Negative control."""
    rest = dropped(1.01e7, 1e4, ImplicitSteps(tolerance=1e-6, longest=0.1)).states[-1].positions[0, 2]
    assert abs(rest + G / 1e7) > 5e-9


def test_a_soft_plane_saves_no_steps() -> None:
    """Negative control: what is saved is owed to the stiffness."""
    ours = dropped(1e3, 5.0, ImplicitSteps(tolerance=1e-6, longest=0.1))
    other = dropped(1e3, 5.0, StepControl(relative=1e-6, absolute=1e-6))
    assert ours.steps > other.steps


def braced_loop() -> MultibodyModel:
    """A parallelogram whose diagonal is a stiff spring with a strong damper; it falls onto that."""
    model = n_four_bar(1)
    first, second = model.bodies[0], model.bodies[1]
    brace = SpringDamper(
        first=first.name,
        second=second.name,
        first_point=np.array([0.0, -0.5, 0.0]),
        second_point=np.array([0.0, 0.5, 0.0]),
        stiffness=1e6,
        damping=2e4,
        free_length=1.4,
    )
    return MultibodyModel(bodies=model.bodies, joints=model.joints, forces=(brace,), gravity=model.gravity)


def test_a_stiff_brace_in_a_loop_takes_a_tenth_of_the_explicit_evaluations() -> None:
    times = np.array([0.0, 0.05, 0.25])
    ours = integrate(TreeCoordinates(braced_loop()), times, ImplicitSteps(tolerance=1e-7, longest=0.1))
    other = integrate(TreeCoordinates(braced_loop()), times, StepControl(relative=1e-7, absolute=1e-7))
    for a, b in zip(ours.states, other.states, strict=True):
        np.testing.assert_allclose(a.positions, b.positions, atol=1e-5)
    assert 10 * ours.evaluations < other.evaluations


def test_touch_down_is_located() -> None:
    """Free fall is exact for the method but for the iteration's end, and the step's course is a cubic."""

    def height(_t: float, state: State) -> float:
        return float(state.positions[0, 2])

    down = Event(name="touch-down", function=height, terminal=True)
    motion = integrate(TreeCoordinates(ball(1e7, 1e4)), TIMES, ImplicitSteps(), [down])
    assert motion.events[0].time == pytest.approx(np.sqrt(0.2 / G), abs=1e-6)
    assert motion.times[-1] == pytest.approx(0.1)


def test_other_coordinates_are_refused() -> None:
    with pytest.raises(InputError, match="formulation for implicit steps = AbsoluteCoordinates: must be in joints"):
        integrate(AbsoluteCoordinates(pendulum()), TIMES, ImplicitSteps())


def test_a_force_without_bounds_ends_with_the_motion_so_far() -> None:
    """A pull that grows beyond all numbers at 0.5 s."""

    def pull(t: float, _r: np.ndarray, _R: np.ndarray, _u: np.ndarray) -> np.ndarray:
        return np.array([0.0, np.inf if t > 0.5 else 1.0, 0.0, 0.0, 0.0, 0.0])

    arm = body("arm", 1.0, (0.1, 0.1, 0.1), (1.0, 0.0, 0.0))
    hinge = revolute("hinge", "ground", arm, at=(0, 0, 0), axis=(0, 0, 1))
    model = MultibodyModel(bodies=(arm,), joints=(hinge,), forces=(AppliedForce(body="arm", function=pull),))
    with pytest.raises(
        ConvergenceError, match=r"motion stopped at t = 0.\d+ s of 2 s: no implicit step down to"
    ) as found:
        integrate(TreeCoordinates(model), TIMES, ImplicitSteps())
    assert isinstance(found.value.last_good, Motion)
    assert found.value.last_good.times[-1] == pytest.approx(0.4)
