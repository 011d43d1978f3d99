"""Generalised-alpha with adaptive step: order, constraints, matrices, and the same motion as the explicit method."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.motion import linearisation
from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.implicit import ImplicitSettings, integrate_implicit
from ancf_reduced.motion.linearisation import Linearisation
from ancf_reduced.motion.plate_system import PlateSystem
from ancf_reduced.motion.rigid_triads import triad_defect
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.motion.triad_equations import TriadEquations
from contracts.errors import ConvergenceError, InputError
from tests.unit.test_ancf_rigid_hub import paddle, rigid_start

END = 0.02


@pytest.fixture(scope="module")
def system() -> PlateSystem:
    """The soft plate on a spinning hub, with damping."""
    plain = paddle()
    return replace(plain, model=replace(plain.model, viscosity=(50.0, 80.0)))


@pytest.fixture(scope="module")
def start(system: PlateSystem) -> MotionState:
    return rigid_start(system)


def test_both_integrators_give_the_same_motion(system: PlateSystem, start: MotionState) -> None:
    times, step = np.array([0.5 * END, END]), 0.02 * stable_step(system, start.z)
    explicit = list(integrate_explicit(system, start, times, step))
    steps: list[float] = []
    settings = ImplicitSettings(tolerance=1e-9, first_step=1e-5)
    implicit = list(integrate_implicit(system, start, times, settings, lambda state: steps.append(state.time)))
    for one, other in zip(explicit, implicit, strict=True):
        assert one.time == pytest.approx(other.time, rel=1e-12)
        assert triad_defect(other.z[-3:]) < 1e-12
        moved = np.abs(one.z - start.z).max()
        assert np.abs(one.z - other.z).max() < 1e-4 * moved
    assert np.ptp(np.diff(steps)) > 0.0  # the step adapts


def test_error_falls_with_the_tolerance(system: PlateSystem, start: MotionState) -> None:
    (exact,) = integrate_explicit(system, start, np.array([END]), 0.02 * stable_step(system, start.z))
    errors = []
    for tolerance in (1e-6, 1e-8):
        (end,) = integrate_implicit(system, start, np.array([END]), ImplicitSettings(tolerance=tolerance))
        errors.append(np.abs(end.z - exact.z).max())
    assert errors[1] < errors[0] / 8.0


def test_a_wrong_mass_is_caught(system: PlateSystem, start: MotionState) -> None:
    """Negative control of the comparison: 1 % more mass in one of the two."""
    heavier = replace(system, mass=1.01 * system.mass, dead_load=system.dead_load)
    (one,) = integrate_explicit(system, start, np.array([END]), 0.05 * stable_step(system, start.z))
    (other,) = integrate_implicit(heavier, start, np.array([END]), ImplicitSettings(tolerance=1e-9))
    assert np.abs(one.z - other.z).max() > 1e-4 * np.abs(one.z - start.z).max()


@pytest.mark.parametrize("small", [True, False], ids=["full", "sparse"])
def test_matrices_are_the_derivatives(
    system: PlateSystem, start: MotionState, small: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(linearisation, "_SMALL", 250 if small else 0)
    matrices, rng = Linearisation(system), np.random.default_rng(3)
    K, C = matrices.stiffness_and_damping(start.z, start.v, 0.0)
    for by_z, matrix in ((1.0, K), (0.0, C)):
        step = 1e-6 * rng.normal(size=start.z.shape)
        forward = system.force(start.z + by_z * step, start.v + (1.0 - by_z) * step)
        backward = system.force(start.z - by_z * step, start.v - (1.0 - by_z) * step)
        expected = -(matrix @ step.ravel()).reshape(step.shape)
        np.testing.assert_allclose(0.5 * (forward - backward), expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())
    right = rng.normal(size=K.shape[0] + 6)
    G = TriadEquations(system.coordinates).jacobian(start.z)
    x = matrices.solve(matrices.mass, G, right)
    np.testing.assert_allclose(matrices.mass @ x[:-6] + G.T @ x[-6:], right[:-6], atol=1e-8)
    np.testing.assert_allclose(G @ x[:-6], right[-6:], atol=1e-8)


def test_triad_equations_and_their_derivatives(system: PlateSystem) -> None:
    equations, rng = TriadEquations(system.coordinates), np.random.default_rng(4)
    z, step = rng.normal(size=(2, system.coordinates.n_vectors, 3))
    lam, h = rng.normal(size=6), 1e-6
    difference = (equations.defect(z + h * step) - equations.defect(z - h * step)) / (2.0 * h)
    np.testing.assert_allclose(difference, equations.jacobian(z) @ step.ravel(), atol=1e-8)
    change = (equations.jacobian(z + h * step) - equations.jacobian(z - h * step)).T @ lam / (2.0 * h)
    np.testing.assert_allclose(change.reshape(-1, 3), equations.stiffness(lam) @ step, atol=1e-8)
    np.testing.assert_allclose(equations.jacobian_rate(step) * h, 0.5 * (
        equations.jacobian(z + h * step) - equations.jacobian(z - h * step)
    ), atol=1e-12)  # fmt: skip


def test_what_cannot_be_solved_says_so(system: PlateSystem, start: MotionState) -> None:
    settings = ImplicitSettings(newton_iterations=1, smallest_step=1e-5)
    with pytest.raises(ConvergenceError, match="Newton's iteration does not converge"):
        list(integrate_implicit(system, start, np.array([END]), settings))
    with pytest.raises(InputError, match="spectral radius"):
        ImplicitSettings(spectral_radius=1.2)
    with pytest.raises(InputError, match="tolerance"):
        ImplicitSettings(tolerance=0.0)


@pytest.mark.parametrize("times", [[0.2, 0.1], [0.0], [], [np.nan], [0.1, np.inf]])
@pytest.mark.parametrize("integrate", [integrate_implicit, lambda *a: integrate_explicit(*a, 1e-5)])
def test_times_must_increase_from_the_start(
    system: PlateSystem, start: MotionState, times: list[float], integrate: Callable[..., Iterator[MotionState]]
) -> None:
    with pytest.raises(InputError, match="times"):
        next(integrate(system, start, np.array(times)))
