"""Friction under an ANCF wheel at rest: its law by hand, its cone, work, symmetry, and how it stays where it sticks."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.rubbing import Rubbed, Since, congruent, rubbed
from ancf_reduced.wheel.stability import press_along, press_buckled
from ancf_reduced.wheel.static import Equilibrium, WheelOnGround, press
from contracts.errors import InputError
from contracts.terrain_ridges import HalfRound
from geometry.wheel import WheelDesign, exomars_hoops

Array = NDArray[np.float64]
DEFLECTIONS = [2e-3, 4e-3, 6e-3, 8e-3]
TURNED = 0.2
"""Orientation at which no spring is over the ground: the rim leans [rad]."""


def small() -> WheelDesign:
    """Three hoops without grousers."""
    wheel = exomars_hoops()
    inner = replace(wheel.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    return replace(wheel, grousers=None, spring_sets=(inner,), tire=replace(wheel.tire, thickness=1e-3))


def wheel_on(friction: float) -> WheelOnGround:
    return WheelOnGround(build_ancf_wheel(small(), element_size=40e-3, axial_size=60e-3), TURNED, friction=friction)


@pytest.fixture(scope="module")
def rough() -> WheelOnGround:
    return wheel_on(0.3)


@pytest.fixture(scope="module")
def states(rough: WheelOnGround) -> list[Equilibrium]:
    return list(press(rough, DEFLECTIONS))


@pytest.fixture(scope="module")
def on_rock() -> WheelOnGround:
    wheel = build_ancf_wheel(small(), element_size=40e-3, axial_size=60e-3)
    rock = HalfRound(radius=20e-3, base=-20e-3, position=15e-3, yaw=0.0)
    return WheelOnGround(wheel, TURNED, terrain=rock, friction=0.3)


@pytest.fixture(scope="module")
def on_rock_states(on_rock: WheelOnGround) -> list[Equilibrium]:
    return list(press(on_rock, [1e-3, 2e-3, 4e-3]))


def at(
    problem: WheelOnGround, state: Equilibrium, *, pull: Array, mu: float, shift: Array, first: bool = False
) -> Rubbed:
    """Friction where every node has moved by ``shift`` since a state that had ``pull``; in the first Newton step."""
    q, pose = problem.wheel.coordinates(state.free), problem.ground.risen(state.deflection)
    since = replace(Since.equilibrium(q, pose, pull, mu), first=first)
    moved = q.copy()
    moved[:, 0] += shift
    blocks = np.zeros((len(problem.wheel.plates.plates), 16, 3, 16, 3))
    near = problem.ground.near(moved, pose, state.pressed, blocks)
    return rubbed(problem.ground, moved, pose, near, state.pressed, since)


def test_the_law_by_hand(rough: WheelOnGround, states: list[Equilibrium]) -> None:
    """A small way is held by k times the way, a long one by mu N against it, one along the normal by nothing."""
    state, none = states[-1], np.zeros_like(states[-1].pull)
    forward, _, up = rough.ground.risen(0.0)[0]
    stuck = at(rough, state, pull=none, mu=0.3, shift=1e-10 * forward)
    k = 1e11 * rough.wheel.ground.area[stuck.numbers]
    np.testing.assert_allclose(stuck.stuck, -1e-10 * k[:, None] * forward, rtol=1e-4, atol=1e-10)
    np.testing.assert_array_equal(stuck.slides, 0.0)
    slid = at(rough, state, pull=none, mu=0.3, shift=1e-3 * forward)
    np.testing.assert_allclose(slid.lean, np.broadcast_to(-0.3 * forward, slid.lean.shape), rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(slid.stuck, 0.0)
    lifted = at(rough, state, pull=none, mu=0.3, shift=1e-3 * up)
    np.testing.assert_allclose(lifted.stuck, 0.0, atol=1e-9)
    kept = at(rough, state, pull=0.9 * state.pull, mu=0.3, shift=np.zeros(3))
    np.testing.assert_allclose(kept.stuck, 0.9 * state.pull[kept.numbers], rtol=1e-9, atol=1e-9)


def test_in_the_first_step_what_stuck_sticks_however_far(rough: WheelOnGround, states: list[Equilibrium]) -> None:
    """As the ground takes it along; what slid slides on, and in the next step the law holds."""
    state, forward = states[-1], rough.ground.risen(0.0)[0][0]
    far = 1e-3 * forward
    limit = 0.3 * state.pressed[:, None]
    stuck = at(rough, state, pull=-0.5 * limit * forward, mu=0.3, shift=far, first=True)
    k = 1e11 * rough.wheel.ground.area[stuck.numbers]
    pulled = -(1e-3 * k[:, None] + 0.5 * limit[stuck.numbers]) * forward
    np.testing.assert_allclose(stuck.stuck, pulled, rtol=1e-4, atol=1e-10)
    np.testing.assert_array_equal(stuck.slides, 0.0)
    for slid in (at(rough, state, pull=-limit * forward, mu=0.3, shift=far, first=first) for first in (True, False)):
        np.testing.assert_allclose(slid.lean, np.broadcast_to(-0.3 * forward, slid.lean.shape), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("way", [1e-9, 1e-3])
@pytest.mark.parametrize("ground", ["plane", "rock"])
def test_its_stiffness_is_the_derivative(request: pytest.FixtureRequest, ground: str, way: float) -> None:
    """Where a point sticks; where it slides steadily, as it does in a second step; on a rock the normal turns."""
    names = {"plane": ("rough", "states"), "rock": ("on_rock", "on_rock_states")}[ground]
    rough, states = (request.getfixturevalue(name) for name in names)
    state, none = states[-1], np.zeros_like(states[-1].pull)
    q, pose = rough.wheel.coordinates(state.free), rough.ground.risen(state.deflection)
    forward, left, _ = pose[0]
    direction = np.zeros_like(q)
    direction[:, 0] = 0.6 * forward + 0.8 * left

    def found(step: float) -> Rubbed:
        since = replace(Since.equilibrium(q, pose, none, 0.3), first=False)
        for _ in range(2):
            moved = q + step * direction
            moved[:, 0] += way * forward
            blocks = np.zeros((len(rough.wheel.plates.plates), 16, 3, 16, 3))
            near = rough.ground.near(moved, pose, state.pressed, blocks)
            one = rubbed(rough.ground, moved, pose, near, state.pressed, since)
            since = since.after(one)
        return one

    one = found(0.0)
    small_step = 1e-2 * way if way < 1e-6 else 1e-3 * way  # a point that sticks is linear, and its way near round-off
    held = np.zeros(one.rows.max() + 1)
    held[one.rows] = state.pressed[one.numbers]
    rate = (found(small_step).pull(held) - found(-small_step).pull(held)) / (2.0 * small_step)
    moving = (one.slopes @ direction.ravel()).reshape(-1, 3)
    expected = -np.einsum("pij,pj->pi", one.stiffness, moving)
    np.testing.assert_allclose(rate, expected, rtol=1e-4, atol=1e-5 * np.abs(expected).max())


def test_a_point_that_turned_is_held_stiffer_than_its_law(rough: WheelOnGround, states: list[Equilibrium]) -> None:
    """Once it has slid to and fro its stiffness along its way is mu N over the way, not nothing."""
    state, none = states[-1], np.zeros_like(states[-1].pull)
    forward = rough.ground.risen(0.0)[0][0]
    there, back = (at(rough, state, pull=none, mu=0.3, shift=s * 1e-3 * forward) for s in (1.0, -1.0))
    since = Since.equilibrium(np.zeros(0), rough.ground.risen(0.0), none, 0.3).after(there).after(back)
    assert since.turned[back.numbers].all()
    along = np.einsum("pij,i,j->p", back.stiffness, forward, forward)
    np.testing.assert_allclose(along, 0.3 * state.pressed[back.numbers] / 1e-3, rtol=1e-6)


def test_no_point_pulls_more_than_its_pressure_allows(states: list[Equilibrium]) -> None:
    for state in states:
        pull = np.linalg.norm(state.pull, axis=1)
        assert (pull <= 0.3 * state.pressed * (1.0 + 1e-6) + 1e-9).all()
        assert not pull[state.pressed == 0.0].any()
    assert np.linalg.norm(states[-1].pull, axis=1).max() > 1.0


def test_it_raises_the_load_and_less_would_raise_it_less(states: list[Equilibrium]) -> None:
    """Negative control: without friction nothing pulls, and a thousandth of it moves the load a thousandth as far."""
    smooth, faint = (list(press(wheel_on(mu), DEFLECTIONS)) for mu in (0.0, 3e-4))
    assert not smooth[-1].pull.any()
    assert states[-1].load > 1.001 * smooth[-1].load
    assert 0.0 < faint[-1].load - smooth[-1].load < 0.01 * (states[-1].load - smooth[-1].load)


def test_the_work_of_the_ground_is_stored_or_rubbed_away(rough: WheelOnGround) -> None:
    """Of the load over the deflection, by trapezoids: strain energy, the penalty's and what sliding took."""
    loaded = [rough.unloaded(), *press(rough, np.linspace(5e-4, 8e-3, 16).tolist())]
    work = sum(0.5 * (a.load + b.load) * (b.deflection - a.deflection) for a, b in itertools.pairwise(loaded))
    rubbed_away = 0.0
    for a, b in itertools.pairwise(loaded):
        touching = np.flatnonzero(b.pressed > 0.0)
        places = [rough.ground.places(rough.wheel.coordinates(one.free), touching) for one in (a, b)]
        risen = rough.ground.risen(b.deflection)[0].T @ np.array([0.0, 0.0, b.deflection - a.deflection])
        rubbed_away -= rough.wheel.sides * float((b.pull[touching] * (places[1] - places[0] - risen)).sum())
    assert rubbed_away > 0.0
    assert work == pytest.approx(loaded[-1].energy + rubbed_away, rel=0.01)


def test_half_a_wheel_carries_what_the_whole_does(states: list[Equilibrium]) -> None:
    whole = build_ancf_wheel(small(), element_size=40e-3, axial_size=60e-3, half_width=False)
    found = list(press(WheelOnGround(whole, TURNED, friction=0.3), DEFLECTIONS))
    assert found[-1].load == pytest.approx(states[-1].load, rel=1e-6)
    # works of 1e-12 that are left, of 5 N m, move a point of 1e7 N/m by 1e-9 m: 1e-2 N that may lie on one side
    lateral = found[-1].pull[:, 1]
    assert abs(lateral.sum()) < 5e-3 * abs(lateral).sum()


def test_on_a_rock_its_upward_part_counts(on_rock: WheelOnGround, on_rock_states: list[Equilibrium]) -> None:
    """Equilibrium of the whole: what presses and what pulls, along the normal, is the load."""
    problem, state = on_rock, on_rock_states[-1]
    blocks = np.zeros((len(problem.wheel.plates.plates), 16, 3, 16, 3))
    pose = problem.ground.risen(state.deflection)
    near = problem.ground.near(problem.wheel.coordinates(state.free), pose, state.pressed, blocks)
    pressing = float(state.pressed[near.points] @ problem.lift(near, pose))
    pulling = float((state.pull @ pose[0][2]).sum())
    assert abs(pulling) > 0.1
    assert problem.wheel.sides * (pressing + pulling) == pytest.approx(state.load, rel=1e-9)


def test_blocks_between_slopes(rough: WheelOnGround, states: list[Equilibrium]) -> None:
    found = at(rough, states[-1], pull=states[-1].pull, mu=0.3, shift=np.array([1e-9, 0.0, 0.0]))
    S = found.slopes.toarray()
    expected = sum(S[3 * p : 3 * p + 3].T @ one @ S[3 * p : 3 * p + 3] for p, one in enumerate(found.stiffness))
    np.testing.assert_allclose(congruent(found.slopes, found.stiffness).toarray(), expected, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("friction", [-0.1, np.nan, np.inf])
def test_impossible_friction_is_refused(rough: WheelOnGround, friction: float) -> None:
    with pytest.raises(InputError, match="friction coefficient"):
        WheelOnGround(rough.wheel, 0.0, friction=friction)


def test_a_path_has_no_friction(rough: WheelOnGround, states: list[Equilibrium]) -> None:
    with pytest.raises(InputError, match="along a path"):
        next(press_along(rough, states[0], 0.01))
    falls = replace(states[1], negative=1)
    with pytest.raises(InputError, match="along a path"):
        next(press_buckled(rough, states[0], falls, 0.01))
