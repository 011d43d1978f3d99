"""ANCF wheel on the ground: derivatives of ties and gaps, touching sets, equilibria of a small wheel."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.sparse import csr_array

from ancf_reduced.wheel.contact_step import settle
from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import Equilibrium, WheelOnGround, press
from ancf_reduced.wheel.ties import Ties
from contracts.errors import ConvergenceError, IncrementRecord, InputError
from geometry.wheel import WheelDesign, exomars_hoops

Array = NDArray[np.float64]


def small() -> WheelDesign:
    """The hoops' wheel without grousers and outer springs: three hoops."""
    wheel = exomars_hoops()
    inner = replace(wheel.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    return replace(wheel, grousers=None, spring_sets=(inner,), tire=replace(wheel.tire, thickness=1e-3))


@pytest.fixture(scope="module")
def problem() -> WheelOnGround:
    return WheelOnGround(build_ancf_wheel(small(), element_size=40e-3, axial_size=60e-3), 0.0)


@pytest.fixture(scope="module")
def open_problem(problem: WheelOnGround) -> WheelOnGround:
    """Its parts pass through each other: their contact is in test_ancf_wheel_contacts.py."""
    return WheelOnGround(problem.wheel, 0.0, inner_contact_stiffness=0.0)


@pytest.fixture(scope="module")
def pressed(problem: WheelOnGround) -> list[Equilibrium]:
    return list(press(problem, [2e-3, 4e-3, 6e-3]))


def test_residual_and_tangent_are_derivatives(open_problem: WheelOnGround) -> None:
    """Of plates, ties and gaps at a state that balances nothing; forces of the present state, not of a step's."""
    random = np.random.default_rng(1)
    size = open_problem.wheel.basis.shape[1]
    free, direction = 1e-4 * random.standard_normal(size), random.standard_normal(size)
    none = np.zeros(len(open_problem.wheel.ground.plate))

    def at(x: Array) -> tuple[float, Array, Array, Array]:
        found = open_problem.linearised(
            x, open_problem.ground.risen(5e-3), (*open_problem.extrapolated(x, 0.0 * x), none)
        )
        return found.energy, found.residual, found.gaps, found.tangent @ direction

    step = 1e-7
    ahead, behind, here = at(free + step * direction), at(free - step * direction), at(free)
    assert here[1] @ direction == pytest.approx((ahead[0] - behind[0]) / (2.0 * step), rel=1e-6)
    slope = (ahead[1] - behind[1]) / (2.0 * step)
    np.testing.assert_allclose(here[3], slope, atol=1e-6 * np.abs(slope).max())
    system = open_problem.linearised(
        free, open_problem.ground.risen(5e-3), (*open_problem.extrapolated(free, 0.0 * free), none)
    )
    np.testing.assert_allclose(system.slopes @ direction, (ahead[2] - behind[2]) / (2.0 * step), rtol=1e-5, atol=1e-6)


def test_what_forces_add_to_the_tangent_is_the_slopes_derivative(open_problem: WheelOnGround) -> None:
    """G^T f with constant f, by differences: the ground's part of the tangent, minus sign included."""
    random = np.random.default_rng(2)
    size = open_problem.wheel.basis.shape[1]
    free, direction = 1e-4 * random.standard_normal(size), random.standard_normal(size)
    forces = random.random(len(open_problem.wheel.ground.plate))
    stresses, tied = open_problem.extrapolated(free, 0.0 * free)

    def pull(x: Array) -> Array:
        found = open_problem.linearised(x, open_problem.ground.risen(0.5), (stresses, tied, 0.0 * forces))
        return -(found.slopes.T @ forces[found.near])

    step = 1e-7
    slope = (pull(free + step * direction) - pull(free - step * direction)) / (2.0 * step)
    loaded, bare = (
        open_problem.linearised(free, open_problem.ground.risen(0.5), (stresses, tied, k * forces)).tangent
        for k in (1.0, 0.0)
    )
    np.testing.assert_allclose((loaded - bare) @ direction, slope, atol=1e-5 * np.abs(slope).max())


def test_a_touching_set_is_the_minimum_of_the_energy() -> None:
    """Twelve unknowns, thirty points: against a general minimiser."""
    random = np.random.default_rng(5)
    root = random.standard_normal((12, 12))
    K, R = root @ root.T + np.eye(12), random.standard_normal(12)
    gap, G, k = 0.1 * random.standard_normal(30), random.standard_normal((30, 12)), 1e3 * random.random(30)
    factored = gap < 0.0
    inverse = np.linalg.inv(K + G.T @ (G * np.where(factored, k, 0.0)[:, None]))
    settled = settle(inverse.__matmul__, K.__matmul__, R, (gap, csr_array(G), k), factored)
    assert settled is not None
    step, forces = settled

    def energy(s: Array) -> tuple[float, Array]:
        held = np.minimum(gap + G @ s, 0.0)
        return 0.5 * s @ K @ s + R @ s + 0.5 * k @ held**2, K @ s + R + G.T @ (k * held)

    found = minimize(energy, np.zeros(12), jac=True, method="BFGS", options={"gtol": 1e-9})
    np.testing.assert_allclose(step, found.x, atol=1e-6)
    np.testing.assert_allclose(forces, -k * np.minimum(gap + G @ step, 0.0))
    assert np.abs(energy(step)[1]).max() < 1e-9 * np.abs(R).max()


def test_a_touching_set_with_forces_that_lean_is_in_balance() -> None:
    """Friction's rows lean by a third of the slopes' size: the equation of the module's head, residual by hand."""
    random = np.random.default_rng(6)
    root = random.standard_normal((12, 12))
    K, R = root @ root.T + np.eye(12), random.standard_normal(12)
    gap, G, k = 0.1 * random.standard_normal(30), random.standard_normal((30, 12)), 1e3 * random.random(30)
    H = G + 0.3 * random.standard_normal(G.shape)
    factored = gap < 0.0
    inverse = np.linalg.inv(K + H.T @ (G * np.where(factored, k, 0.0)[:, None]))
    contact = gap, csr_array(G), k
    settled = settle(inverse.__matmul__, K.__matmul__, R, contact, factored, csr_array(H))
    assert settled is not None
    step, forces = settled
    np.testing.assert_allclose(forces, -k * np.minimum(gap + G @ step, 0.0))
    assert np.abs(K @ step + R - H.T @ forces).max() < 1e-9 * np.abs(R).max()
    assert np.abs(K @ step + R - G.T @ forces).max() > 0.1  # negative control: without what leans


def test_the_load_is_the_slope_of_the_energy(problem: WheelOnGround, pressed: list[Equilibrium]) -> None:
    """dW / dd = F by differences, within 1 %: the ground's own energy is left out."""
    one, two, three = pressed
    assert two.load == pytest.approx((three.energy - one.energy) / (three.deflection - one.deflection), rel=0.01)
    assert all(a.load < b.load for a, b in pairwise(pressed))
    assert all(state.negative == 0 and state.residuals[-1] < 1e-12 for state in pressed)
    assert all(state.pressed.min() >= 0.0 for state in pressed)


def test_the_wheel_is_the_same_a_third_of_a_turn_on(pressed: list[Equilibrium]) -> None:
    wheel = build_ancf_wheel(small(), element_size=40e-3, axial_size=60e-3)
    (turned,) = press(WheelOnGround(wheel, 2.0 * np.pi / 3.0), [pressed[0].deflection])
    assert turned.load == pytest.approx(pressed[0].load, rel=1e-6)


def test_bad_input_is_refused(problem: WheelOnGround) -> None:
    with pytest.raises(InputError, match="must be finite"):
        WheelOnGround(problem.wheel, np.nan)
    with pytest.raises(InputError, match="contact stiffness"):
        WheelOnGround(problem.wheel, 0.0, contact_stiffness=0.0)
    for wrong in ([2e-3, 1e-3], [2e-3, np.inf], [np.nan], [0.0]):
        with pytest.raises(InputError, match="must be finite and increase"):
            next(press(problem, wrong))
    for step in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match="smallest step"):
            next(press(problem, [2e-3], smallest_step=step))


def test_a_step_without_points_near_is_that_of_the_body_alone() -> None:
    K, R = np.diag([1.0, 2.0]), np.array([1.0, 1.0])
    none = np.empty(0), csr_array((0, 2)), np.empty(0)
    settled = settle(np.linalg.inv(K).__matmul__, K.__matmul__, R, none, np.empty(0, dtype=bool))
    assert settled is not None
    np.testing.assert_allclose(settled[0], [-1.0, -0.5])


def test_a_step_of_which_all_points_change_is_given_up() -> None:
    """Three thousand points begin to touch at once: none, so that the increment is halved."""
    gap, G = np.full(3000, 0.5), csr_array(np.ones((3000, 1)))
    assert settle(lambda v: v, lambda v: v, np.ones(1), (gap, G, gap), np.zeros(3000, dtype=bool)) is None


def test_an_increment_that_goes_astray_is_given_up_at_once(
    problem: WheelOnGround, pressed: list[Equilibrium], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The hub a metre through the ground: one step each, no traceback; what was found before is kept."""
    found, history = list[Equilibrium](), list[IncrementRecord]()
    with pytest.raises(ConvergenceError, match="no equilibrium found"):  # noqa: PT012
        for state in press(problem, [pressed[0].deflection, 1.0], smallest_step=0.4, history=history):
            found.append(state)
    assert [s.load for s in found] == pytest.approx([pressed[0].load])
    failed = [record for record in history if not record.converged]
    assert failed
    assert all(record.residuals == () for record in failed)  # and so nothing that JSON has no number for


def test_half_of_the_wheel_counts_twice(pressed: list[Equilibrium]) -> None:
    """The whole width carries what its half with a plane of symmetry says, in load and energy."""
    whole = build_ancf_wheel(small(), element_size=40e-3, axial_size=60e-3, half_width=False)
    (found,) = press(WheelOnGround(whole, 0.0), [pressed[0].deflection])
    assert found.load == pytest.approx(pressed[0].load, rel=1e-6)
    assert found.energy == pytest.approx(pressed[0].energy, rel=1e-6)


def test_a_tied_edge_turns_against_its_welds_stiffness(problem: WheelOnGround) -> None:
    """First edges of springs turned by a small angle, all else at rest: half of stiffness, width and its square."""
    plates, ties, angle = problem.wheel.plates, problem.wheel.ties, 1e-3
    q = plates.reference.copy()
    for spring, rim in zip(ties.spring, ties.rim, strict=True):
        for corner in (0, 1):
            _, a, b, _ = plates.reference[plates.plates[rim, corner]]
            place = plates.plates[spring, corner]
            q[place, 1] = plates.reference[place, 1] + angle * np.cross(a, b)
    energy = Ties(plates, ties).terms(q, np.zeros((0, 4, 4)))[0]
    expected = 0.5 * float((ties.turning * plates.sizes[ties.spring, 1]).sum()) * angle**2
    assert energy == pytest.approx(expected, rel=1e-6)
