"""Claim: each law gives the stress of its stored energy in uniaxial, equibiaxial and simple shear deformation, to large
stretches, on distorted cells (patch test), turned or not.

Source: nominal stress P_a = dW/dlambda_a of the energies in contracts/material_laws.py, written here in stretches and
differentiated by a complex step (exact to round-off); the lateral stretch from dW/dlambda = 0. Ogden's constants for
Treloar's rubber (Proc. R. Soc. Lond. A 326, 1972, from memory), to stretches 7 and 4.5. Tolerance 1e-6: the residual
is solved to 1e-9, and with a bulk modulus 500 times that of shear the pressure magnifies what is left of it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from contracts.material_laws import Law, MooneyRivlin, NeoHookean, Ogden
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.patch import STEEL, distorted_cube

SOFT = replace(STEEL, young_modulus=2.4e6, poisson_ratio=0.3)
BULK = 200e6
LAWS: dict[str, tuple[Law, float, float]] = {
    "neo-Hookean": (NeoHookean(), 4.0, 2.5),
    "Mooney-Rivlin": (MooneyRivlin(c10=0.16e6, c01=0.04e6, bulk_modulus=BULK), 4.0, 2.5),
    "Ogden": (Ogden(moduli=(0.618e6, 1.18e3, -9.81e3), exponents=(1.3, 5.0, -2.0), bulk_modulus=BULK), 7.0, 4.5),
}
"""Law, largest stretch along one axis, and along two."""
Stretches = tuple[complex, complex, complex]


def energy(law: Law, stretches: Stretches) -> complex:
    """W per undeformed volume [J/m^3]."""
    s = np.array(stretches)
    J = np.prod(s)
    bar = s * J ** (-1.0 / 3.0)
    if isinstance(law, NeoHookean):
        lam, mu = SOFT.lame_lambda, SOFT.lame_mu
        return 0.5 * mu * (np.sum(s**2) - 3.0) - mu * np.log(J) + 0.5 * lam * np.log(J) ** 2
    if isinstance(law, MooneyRivlin):
        first, second = np.sum(bar**2), (np.sum(bar**2) ** 2 - np.sum(bar**4)) / 2.0
        isochoric = law.c10 * (first - 3.0) + law.c01 * (second - 3.0)
    else:
        assert isinstance(law, Ogden)
        isochoric = sum(m / a * (np.sum(bar**a) - 3.0) for m, a in zip(law.moduli, law.exponents, strict=True))
    return isochoric + 0.5 * law.bulk_modulus * np.log(J) ** 2


def nominal(law: Law, stretches: tuple[float, float, float], axis: int) -> float:
    """dW/dlambda along an axis [Pa]."""
    moved = list(map(complex, stretches))
    moved[axis] += 1e-30j
    return float(np.imag(energy(law, (moved[0], moved[1], moved[2]))) / 1e-30)


def solved(law: Law, end: np.ndarray, steps: int, *, free: tuple[int, ...]) -> tuple[StaticProblem, np.ndarray]:
    """Faces moved to stretches ``end`` along all axes but the free ones; problem, and force on each moved face [N]."""
    held = [Support(faces=(f"{x}0",), components=(k,)) for k, x in enumerate("xyz")]
    moved = [k for k in range(3) if k not in free]
    held += [Support(faces=(f"{'xyz'[k]}1",), components=(k,), value=(end[k] - 1.0,)) for k in moved]
    problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": replace(SOFT, law=law)}, held)
    solver = NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-9))
    *_, last = solve_increments(solver, [(k + 1) / steps for k in range(steps)], [])
    force = [last.outcome.residual[problem.bcs[3 + i].dof_indices()[0]].sum() for i in range(len(moved))]
    return problem, np.array(force)


@pytest.mark.parametrize(("law", "stretch", "_biaxial"), LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("end", ["pulled", "pressed"])
def test_uniaxial(law: Law, stretch: float, _biaxial: float, end: str) -> None:
    length = stretch if end == "pulled" else 0.4
    side = float(brentq(lambda s: nominal(law, (length, s, s), 1), 0.2, 2.0, xtol=1e-15))
    problem, force = solved(law, np.array([length, 0.0, 0.0]), 12, free=(1, 2))
    stress = nominal(law, (length, side, side), 0)
    assert force[0] == pytest.approx(stress, rel=1e-6)
    u = problem.nodal_displacement()
    np.testing.assert_allclose(u, problem.domain.tagged.points * [length - 1.0, side - 1.0, side - 1.0], atol=1e-7)
    true = StressRecovery(problem).cell_stations()
    np.testing.assert_allclose(true, abs(stress) / side**2, rtol=1e-6)


@pytest.mark.parametrize(("law", "_uniaxial", "stretch"), LAWS.values(), ids=LAWS)
def test_equibiaxial(law: Law, _uniaxial: float, stretch: float) -> None:
    across = float(brentq(lambda s: nominal(law, (stretch, stretch, s), 2), 0.01, 2.0, xtol=1e-15))
    _, force = solved(law, np.array([stretch, stretch, 0.0]), 12, free=(2,))
    np.testing.assert_allclose(force, nominal(law, (stretch, stretch, across), 0), rtol=1e-6)


def sheared(law: Law, amount: float, turn: np.ndarray) -> StaticProblem:
    """The cube at F = turn (I + amount e_x e_y), everywhere prescribed."""
    problem = StaticProblem(
        Domain.from_tagged(distorted_cube()), {"body": replace(SOFT, law=law)}, [Support(faces=("x0",))]
    )
    F = turn @ (np.eye(3) + amount * np.outer([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]))
    problem.u.interpolate(lambda x: (F - np.eye(3)) @ x)
    return problem


def principal_shear(law: Law, amount: float) -> np.ndarray:
    """First Piola-Kirchhoff stress of simple shear by its principal axes: P = sum_a dW/dlambda_a n_a N_a."""
    F = np.eye(3) + amount * np.outer([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    left, stretches, right = np.linalg.svd(F)
    along = [nominal(law, (stretches[0], stretches[1], stretches[2]), a) for a in range(3)]
    return np.asarray(left @ np.diag(along) @ right)


@pytest.mark.parametrize("law", [law for law, *_ in LAWS.values()], ids=LAWS)
def test_simple_shear_turned_by_anything(law: Law) -> None:
    """int P dV over the unit cube is the sum of nodal forces times places; no force is left inside."""
    axis = np.array([1.0, 2.0, -1.0]) / np.sqrt(6.0)
    K = np.cross(np.eye(3), axis)
    turn = np.eye(3) + np.sin(2.0) * K + (1.0 - np.cos(2.0)) * K @ K
    P = principal_shear(law, 2.0)
    for R in (np.eye(3), turn):
        problem = sheared(law, 2.0, R)
        x, force = problem.V.tabulate_dof_coordinates(), problem.residual().reshape(-1, 3)
        np.testing.assert_allclose(force.T @ x, R @ P, rtol=0.0, atol=1e-11 * BULK)  # int P dV, unit volume
        inside = np.all((x > 1e-9) & (x < 1.0 - 1e-9), axis=1)
        assert np.abs(force[inside]).max() < 1e-12 * BULK


def test_another_constant_is_seen() -> None:
    """Negative control: a modulus off by 1e-5."""
    law, stretch, _ = LAWS["Ogden"]
    assert isinstance(law, Ogden)
    off = replace(law, moduli=(law.moduli[0] * (1.0 + 1e-5), *law.moduli[1:]))
    _, force = solved(off, np.array([stretch, 0.0, 0.0]), 12, free=(1, 2))
    side = float(brentq(lambda s: nominal(law, (stretch, s, s), 1), 0.2, 2.0, xtol=1e-15))
    assert force[0] != pytest.approx(nominal(law, (stretch, side, side), 0), rel=1e-6)
