"""Claim: the general loops assemble what their equations say: energy, residual and condensed tangent belong together.

Source: the same weak form. The UFL forms give the neo-Hookean law (round-off, 1e-12); for the others central
differences: residual from energy 1e-7, tangent from residual 1e-7 of the largest entry, on distorted cells far from
rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.material_laws import J2Plasticity, Law, MooneyRivlin, NeoHookean, Ogden, StVenantKirchhoff
from contracts.materials import Material
from reference_fe.cells.discretisation import Discretisation
from reference_fe.material.stored_energy import StoredEnergy
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.verification.structured_hexahedra import block_mesh, stacked

METAL = Material(
    name="metal", young_modulus=3.0, poisson_ratio=0.3, density=1.0, yield_strength=0.1, source="round numbers"
)
LAWS: dict[str, Law] = {
    "neo-Hookean": NeoHookean(),
    "Mooney-Rivlin": MooneyRivlin(c10=0.4, c01=0.1, bulk_modulus=30.0),
    "Ogden": Ogden(moduli=(0.63, 0.0012, -0.01), exponents=(1.3, 5.0, -2.0), bulk_modulus=30.0),
    "J2": J2Plasticity(hardening_modulus=0.5, saturation_stress=0.2, saturation_rate=10.0),
}


def _mapping(X: np.ndarray) -> np.ndarray:
    return X + 0.05 * np.sin(3.0 * X[:, [1, 2, 0]])


def problem(laws: tuple[Law, ...], *, order: int = 2, thermal: float = 0.0, **choice: bool) -> StaticProblem:
    """Distorted blocks, one a law, far from rest."""
    mesh = block_mesh((2, 1, 1), _mapping, order)
    parts = ["body"]
    if len(laws) == 2:
        mesh = stacked(mesh, block_mesh((1, 1, 1), lambda X: _mapping(X) + 2.0, order), "other")
        parts.append("other")
    materials = {part: replace(METAL, law=law, thermal_strain=thermal) for part, law in zip(parts, laws, strict=True)}
    made = StaticProblem(
        Domain.from_tagged(mesh),
        materials,
        [Support(faces=("x0",), components=(0, 2))],
        discretisation=Discretisation(degree=order, **choice),
    )
    rng = np.random.default_rng(3)
    x = made.V.tabulate_dof_coordinates()
    smooth = np.column_stack([0.3 * x[:, 0] + 0.1 * np.sin(x[:, 1]), -0.1 * x[:, 1], 0.1 * x[:, 0] * x[:, 2]])
    made.u.x.array[:] = (smooth + 0.01 * rng.standard_normal(smooth.shape)).ravel()
    made.du.x.array[:] = 0.02 * rng.standard_normal(made.dofs)
    return made


def dense(made: StaticProblem) -> np.ndarray:
    indptr, indices, values = made.unsupported_tangent().getValuesCSR()
    out = np.zeros((made.dofs, made.dofs))
    out[np.repeat(np.arange(made.dofs), np.diff(indptr)), indices] = values
    return out


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("thermal", [0.0, 0.1])
def test_neo_hookean_loops_equal_the_forms(order: int, thermal: float) -> None:
    ours, forms = (problem((NeoHookean(),), order=order, thermal=thermal, compiled=c) for c in (True, False))
    for made in (ours, forms):
        made.store_stress(extrapolate=True)
    for a, b in ((ours.residual(), forms.residual()), (dense(ours), dense(forms))):
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-12 * np.abs(b).max())
    assert StoredEnergy(ours).value() == pytest.approx(StoredEnergy(forms).value(), rel=1e-13)


def test_bodies_of_different_laws_do_not_mix() -> None:
    """St. Venant-Kirchhoff and neo-Hookean in one mesh, loops against forms: each keeps its own."""
    laws = (StVenantKirchhoff(), NeoHookean())
    ours, forms = (problem(laws, compiled=compiled) for compiled in (True, False))
    swapped = problem(laws[::-1], compiled=True)
    for made in (ours, forms, swapped):
        made.store_stress(extrapolate=True)
    scale = np.abs(forms.residual()).max()
    np.testing.assert_allclose(ours.residual(), forms.residual(), rtol=0.0, atol=1e-12 * scale)
    np.testing.assert_allclose(dense(ours), dense(forms), rtol=0.0, atol=1e-12 * np.abs(dense(forms)).max())
    assert np.abs(swapped.residual() - forms.residual()).max() > 1e-3 * scale


@pytest.mark.parametrize("name", [*LAWS, "mixed"])
@pytest.mark.parametrize("order", [1, 2])
def test_the_tangent_is_the_derivative_of_the_residual(name: str, order: int) -> None:
    """Plain tangent, pressure condensed, after one accepted step: plastic points flow again."""
    laws = (LAWS["Ogden"], LAWS["J2"]) if name == "mixed" else (LAWS[name],)
    made = problem(laws, order=order, mixed_integration_points=False)
    made.accept()
    base = 1.1 * made.u.x.array
    made.u.x.array[:] = base
    K = dense(made)
    np.testing.assert_allclose(K, K.T, rtol=0.0, atol=1e-12 * np.abs(K).max())
    h, direction = 1e-6, np.random.default_rng(1).standard_normal(made.dofs)
    made.u.x.array[:] = base + h * direction
    forward = made.residual()
    made.u.x.array[:] = base - h * direction
    difference = (forward - made.residual()) / (2.0 * h)
    np.testing.assert_allclose(K @ direction, difference, rtol=0.0, atol=1e-7 * np.abs(difference).max())
    if "J2" in (name, *(["J2"] if name == "mixed" else [])):
        assert made.histories.state()[0][:, :, 6].max() > 0.01


@pytest.mark.parametrize("thermal", [0.0, 0.1])
@pytest.mark.parametrize("name", ["neo-Hookean", "Mooney-Rivlin", "Ogden"])
def test_the_residual_is_the_derivative_of_the_energy(name: str, thermal: float) -> None:
    made = problem((LAWS[name],), thermal=thermal)
    energy, base, h = StoredEnergy(made), made.u.x.array.copy(), 1e-6
    direction = np.random.default_rng(1).standard_normal(made.dofs)
    slope = float(made.residual() @ direction)
    values = []
    for sign in (1.0, -1.0):
        made.u.x.array[:] = base + sign * h * direction
        values.append(energy.value())
    assert (values[0] - values[1]) / (2.0 * h) == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("name", list(LAWS))
def test_what_is_stored_is_linear_in_the_last_step(name: str) -> None:
    """Stress without pressure, and pressure: against central differences of what is stored at du = 0."""
    made = problem((LAWS[name],))
    assert made.general is not None
    step, base, h = made.du.x.array.copy(), made.u.x.array.copy(), 1e-6
    stored = []
    for sign, extrapolate in ((0.0, True), (0.0, False), (1.0, False), (-1.0, False)):
        made.u.x.array[:] = base + sign * h * step
        made.store_stress(extrapolate=extrapolate)
        stored.append((made.general._stress.copy(), made.general._pressure.copy()))
    for extrapolated, here, forward, backward in zip(*stored, strict=True):
        slope = (forward - backward) / (2.0 * h)
        np.testing.assert_allclose(extrapolated - here, slope, rtol=0.0, atol=1e-7 * np.abs(slope).max())
        assert np.abs(slope).max() >= 0.01 * np.abs(here).max()


def test_a_tangent_without_its_pressure_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: the condensed part left out shows."""
    made = problem((LAWS["Ogden"],), mixed_integration_points=False)
    whole = dense(made)
    original = type(made.general).pressure
    monkeypatch.setattr(
        type(made.general), "pressure", lambda self, u: (lambda p: (p[0], 0.0 * p[1], p[2]))(original(self, u))
    )
    assert np.abs(dense(made) - whole).max() > 0.1 * np.abs(whole).max()
