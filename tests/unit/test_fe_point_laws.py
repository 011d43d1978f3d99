"""Laws at one point: tangent against central differences, coinciding stretches, rotations, limits at small strain."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.material_laws import J2Plasticity, Law, MooneyRivlin, NeoHookean, Ogden
from contracts.materials import Material
from reference_fe.material.law_constants import law_constants, small_strain_lame
from reference_fe.material.point_response import HISTORY, VIRGIN, respond
from reference_fe.material.principal_axes import principal_axes

METAL = Material(
    name="metal", young_modulus=200.0, poisson_ratio=0.3, density=1.0, yield_strength=0.5, source="round numbers"
)
TRELOAR = Ogden(moduli=(0.63, 0.0012, -0.01), exponents=(1.3, 5.0, -2.0), bulk_modulus=50.0)
"""Ogden (1972), moduli in N/mm^2, from memory; soft bulk modulus, so that differences see both parts."""
LAWS: dict[str, Law] = {
    "neo-Hookean": NeoHookean(),
    "Mooney-Rivlin": MooneyRivlin(c10=0.4, c01=0.1, bulk_modulus=50.0),
    "Ogden": TRELOAR,
    "J2": J2Plasticity(hardening_modulus=5.0, saturation_stress=0.9, saturation_rate=20.0),
}
STRETCHES = {
    "distinct": (1.4, 0.8, 1.05),
    "two alike": (1.3, 0.9, 0.9),
    "nearly": (1.3, 0.9, 0.9 + 1e-9),
    "rest": (1.0, 1.0, 1.0),
}


def rotation(seed: int) -> np.ndarray:
    Q = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))[0]
    return Q * np.sign(np.linalg.det(Q))


def response(law: Law, F: np.ndarray, p: float = 0.0, past: np.ndarray = VIRGIN) -> tuple[np.ndarray, ...]:
    """S as 3 x 3, CC (6, 6), V (6,), history, energy."""
    constants = law_constants(METAL, law)
    row = np.zeros(6)
    row[: len(constants.values)] = constants.values
    S, CC, V, now = np.empty(6), np.empty((6, 6)), np.empty(6), np.empty(HISTORY)
    energy = respond(constants.kind, row, F - np.eye(3), p, past, S, CC, V, now, True)
    return S[[[0, 3, 5], [3, 1, 4], [5, 4, 2]]], CC, V, now, np.array(energy)


def voigt(A: np.ndarray) -> np.ndarray:
    return A[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]


def gradient(stretches: tuple[float, ...]) -> np.ndarray:
    R = rotation(5)
    return rotation(6) @ R @ np.diag(stretches) @ R.T


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("stretches", STRETCHES.values(), ids=STRETCHES)
def test_the_tangent_is_the_derivative_of_the_stress(law: Law, stretches: tuple[float, ...]) -> None:
    """Central differences of S for each of the six strains; pressure held. Plastic states flow at these strains."""
    F, p, h = gradient(stretches), 0.3, 1e-6
    CC = response(law, F, p)[1]
    for v in range(6):
        dE = np.zeros((3, 3))
        i, j = v % 3, v % 3 if v < 3 else (v + 1) % 3
        dE[i, j] += 0.5
        dE[j, i] += 0.5
        dF = np.linalg.inv(F).T @ dE  # sym(F^T dF) = dE; C changes by F^T dF + dF^T F = 2 dE, to the second order
        both = [voigt(response(law, F + s * h * dF, p)[0]) for s in (1.0, -1.0)]
        np.testing.assert_allclose(CC[:, v], (both[0] - both[1]) / (2.0 * h), rtol=0.0, atol=3e-8 * np.abs(CC).max())


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_the_tangent_after_yielding_is_that_of_the_return(law: Law) -> None:
    """A second step from a point with history."""
    past = response(law, gradient((1.1, 0.95, 0.97)))[3]
    assert (past[6] > 0.0) == isinstance(law, J2Plasticity)
    F, h = gradient((1.1, 0.95, 0.97)) @ gradient((1.02, 1.01, 0.98)), 1e-6
    CC = response(law, F, 0.1, past)[1]
    np.testing.assert_allclose(CC, CC.T, rtol=0.0, atol=1e-13 * np.abs(CC).max())
    dF = np.random.default_rng(2).standard_normal((3, 3))
    dE = 0.5 * (F.T @ dF + dF.T @ F)
    both = [voigt(response(law, F + s * h * dF, 0.1, past)[0]) for s in (1.0, -1.0)]
    found = CC @ (voigt(dE) * [1, 1, 1, 2, 2, 2])
    np.testing.assert_allclose(found, (both[0] - both[1]) / (2.0 * h), rtol=0.0, atol=1e-7 * np.abs(found).max())


@pytest.mark.parametrize("name", ["neo-Hookean", "Mooney-Rivlin", "Ogden"])
def test_stress_is_the_derivative_of_the_energy(name: str) -> None:
    F, h = gradient((1.4, 0.8, 1.05)), 1e-6
    dF = np.random.default_rng(3).standard_normal((3, 3))
    rise = (response(LAWS[name], F + h * dF)[4] - response(LAWS[name], F - h * dF)[4]) / (2.0 * h)
    assert np.sum((F @ response(LAWS[name], F)[0]) * dF) == pytest.approx(float(rise), rel=1e-8)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_rotation_turns_nothing(law: Law) -> None:
    """S of R F is S of F; the history as well."""
    past = response(law, gradient((1.1, 0.95, 0.97)))[3]
    F, R = gradient((1.3, 0.9, 1.0)), rotation(9)
    for ours, turned in zip(response(law, F, 0.1, past), response(law, R @ F, 0.1, past), strict=True):
        np.testing.assert_allclose(turned, ours, rtol=0.0, atol=1e-13 * np.abs(ours).max())


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_small_strain_is_linear_elasticity(law: Law) -> None:
    """At rest CC is lambda I I + 2 mu II, lambda + 2/3 mu for the bulk modulus that the cell's dilatation adds."""
    lam, mu = small_strain_lame(METAL, law)
    bulk = law_constants(METAL, law).bulk
    expected = np.diag([2.0 * mu] * 3 + [mu] * 3)
    expected[:3, :3] += lam - bulk
    np.testing.assert_allclose(response(law, np.eye(3))[1], expected, rtol=0.0, atol=1e-12 * (abs(lam) + mu + bulk))


def test_plastic_flow_keeps_the_volume_and_ends_on_the_yield_surface() -> None:
    """det C_p = 1, and |dev tau| = sqrt(2/3) R(alpha); the same state again is elastic."""
    law, F = LAWS["J2"], gradient((1.2, 0.9, 0.95))
    S, _, _, past, _ = response(law, F)
    G = past[[[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    assert np.linalg.det(G) == pytest.approx(1.0, abs=1e-13)
    tau = F @ S @ F.T
    hardened = 0.5 + 5.0 * past[6] + (0.9 - 0.5) * (1.0 - np.exp(-20.0 * past[6]))
    assert np.sqrt(1.5 * np.sum((tau - np.trace(tau) / 3.0 * np.eye(3)) ** 2)) == pytest.approx(hardened, rel=1e-12)
    again = response(law, F, 0.0, past)
    np.testing.assert_allclose(again[0], S, rtol=0.0, atol=1e-13 * np.abs(S).max() * 100)
    assert again[3][6] == pytest.approx(past[6], rel=1e-12)


def test_inside_out_is_no_state() -> None:
    assert np.isnan(response(TRELOAR, np.diag([1.0, 1.0, -0.5]))[0]).all()


def test_principal_axes_of_tensors_with_equal_values() -> None:
    """A = sum of values times axes, orthonormal, for values that coincide, nearly do, or span twelve decades."""
    R = rotation(4)
    for values in ((1.0, 1.0, 1.0), (2.0, 2.0, -1.0), (1.0, 1.0 + 1e-13, 3.0), (1e-12, 1.0, 0.0), (0.0, 0.0, 0.0)):
        A = R @ np.diag(values) @ R.T
        A = 0.5 * (A + A.T)
        found, axes = np.empty(3), np.empty((3, 3))
        principal_axes(A.copy(), found, axes)
        np.testing.assert_allclose(np.sort(found), np.sort(values), rtol=0.0, atol=4e-16 * np.abs(values).max())
        np.testing.assert_allclose(axes @ np.diag(found) @ axes.T, A, rtol=0.0, atol=2e-15 * np.abs(values).max())
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), rtol=0.0, atol=4e-15)
