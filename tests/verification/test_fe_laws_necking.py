"""Claim: a bar of a hardening metal carries its greatest load where Considere says, then necks.

Source: constants of the necking bar (Simo & Hughes, Computational Inelasticity, 1998, ch. 9; from memory), on a square
bar. Considere: the load A_0 R(a) exp(-a - ...) is greatest where R'(a) = R(a), at an elongation of the uniform bar;
elastic strains, three thousandths, are in the closed form. The bar is 0.5 % thinner in its middle, so that its greatest
load is at most that much smaller. Afterwards the middle thins while the ends unload. Tolerance 0.5 %, the notch.
Negative control: without the imperfection's neck, uniform thinning, the middle would be twice as wide.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from contracts.material_laws import J2Plasticity
from contracts.materials import Material
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

MU, K = 80.1938e9, 164.206e9
E, NU = 9.0 * K * MU / (3.0 * K + MU), (3.0 * K - 2.0 * MU) / (6.0 * K + 2.0 * MU)
LAW = J2Plasticity(hardening_modulus=0.12924e9, saturation_stress=0.715e9, saturation_rate=16.93)
METAL = Material(
    name="bar", young_modulus=E, poisson_ratio=NU, density=1.0, yield_strength=0.45e9, source="Simo & Hughes", law=LAW
)
SIDE, LENGTH, PULL = 6.413e-3, 26.667e-3, 7e-3
"""Half the side, half the length, move of the end [m]."""


def hardened(a: float) -> float:
    """R(a) [Pa]."""
    return 0.45e9 + 0.12924e9 * a + 0.265e9 * (1.0 - np.exp(-16.93 * a))


def greatest_load() -> tuple[float, float]:
    """Of a uniform quarter bar [N], and the elongation of half its length there [m]."""

    def load(a: float) -> float:
        lateral = np.exp(-NU * hardened(a) / E - 0.5 * a)
        return float(SIDE**2 * lateral**2 * hardened(a) / np.exp((1.0 - 2.0 * NU) * hardened(a) / E))

    a = float(minimize_scalar(lambda a: -load(a), bounds=(0.01, 0.5), method="bounded", options={"xatol": 1e-12}).x)
    return load(a), LENGTH * (float(np.exp(hardened(a) / E + a)) - 1.0)


def test_considere_then_a_neck() -> None:
    def mapping(X: np.ndarray) -> np.ndarray:
        z = LENGTH * X[:, 2] ** 1.6
        thin = 1.0 - 0.005 * np.exp(-((z / SIDE) ** 2))
        return np.column_stack([SIDE * thin * X[:, 0], SIDE * thin * X[:, 1], z])

    mesh = block_mesh((2, 2, 8), mapping)
    held = [Support(faces=(f"{x}0",), components=(k,)) for k, x in enumerate("xyz")]
    held.append(Support(faces=("z1",), components=(2,), value=(PULL,)))
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": replace(METAL)}, held)
    stress, pulled = StressRecovery(problem), problem.bcs[-1].dof_indices()[0]
    path = []
    for state in solve_increments(NewtonSolver(problem, NewtonSettings()), [k / 40.0 for k in range(1, 41)], []):
        path.append((state.control * PULL, float(state.outcome.residual[pulled].sum())))
    moved, load = np.array(path).T
    peak, elongation = greatest_load()
    assert 0.995 * peak < load.max() < 1.0005 * peak
    assert abs(moved[np.argmax(load)] - elongation) < 0.15 * elongation  # the top is flat
    u, points = problem.nodal_displacement(), mesh.points
    middle = points[:, 2] < 1e-9
    ends = points[:, 2] > LENGTH - 1e-9
    neck, far = ((points + u)[where, 0].max() / SIDE for where in (middle, ends))
    uniform = (LENGTH / (LENGTH + PULL)) ** 0.5
    assert neck < 0.7 * uniform < 0.7 * far
    assert load[-1] < 0.7 * peak
    assert stress.largest_plastic_strain()["body"] > 1.0
