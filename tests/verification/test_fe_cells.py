"""Claim: the compiled cell loops give the residual, tangent and stored stress of the UFL forms.

Source: the same weak form, two implementations (docs/theory.md 2). Tolerance: round-off, 1e-12 of the largest entry.
"""

from __future__ import annotations

import numpy as np
import pytest

from contracts.materials import Material
from reference_fe.cells import kernels as cell_kernels
from reference_fe.cells.discretisation import Discretisation, ElementFamily
from reference_fe.dolfinx_api import PETSc
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.verification.structured_hexahedra import block_mesh

SOFT = Material(name="a", young_modulus=3.0, poisson_ratio=0.3, density=1.0, yield_strength=1.0, source="test")


def problem(order: int, family: ElementFamily, *, compiled: bool) -> StaticProblem:
    """A distorted 2 x 2 x 1 block with a random displacement and a random last step."""

    def mapping(X: np.ndarray) -> np.ndarray:
        return X + 0.05 * np.sin(3.0 * X[:, [1, 2, 0]])

    choice = Discretisation(family=family, degree=order, compiled=compiled)
    made = StaticProblem(
        Domain.from_tagged(block_mesh((2, 2, 1), mapping, order)),
        {"body": SOFT},
        [Support(faces=("x0",), components=(0, 2)), Support(faces=("z1",), components=(1,))],
        discretisation=choice,
    )
    rng = np.random.default_rng(3)
    made.u.x.array[:], made.du.x.array[:] = 0.1 * rng.standard_normal((2, made.dofs))
    return made


def tangent(made: StaticProblem) -> np.ndarray:
    indptr, indices, values = made.tangent().convert("aij", out=PETSc.Mat()).getValuesCSR()
    dense = np.zeros((made.dofs, made.dofs))
    dense[np.repeat(np.arange(made.dofs), np.diff(indptr)), indices] = values
    return dense


def differences(order: int, family: ElementFamily = ElementFamily.LAGRANGE) -> tuple[float, float]:
    """Largest relative difference of residual and tangent between the two ways."""
    ours, reference = problem(order, family, compiled=True), problem(order, family, compiled=False)
    residuals = ours.residual(), reference.residual()
    for made in (ours, reference):
        made.store_stress(extrapolate=True)
    tangents = tangent(ours), tangent(reference)
    return tuple(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in (residuals, tangents))  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("order", "family"), [(1, ElementFamily.LAGRANGE), (2, ElementFamily.LAGRANGE), (2, ElementFamily.SERENDIPITY)]
)
def test_compiled_loops_equal_the_forms(order: int, family: ElementFamily) -> None:
    residual, matrix = differences(order, family)
    assert residual < 1e-12
    assert matrix < 1e-12


def test_a_wrong_stress_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: stored stress off by one part in a million shows in the tangent, and only there."""
    store = cell_kernels.point_stress

    def damaged(*arrays: np.ndarray) -> None:
        store(*arrays)
        arrays[-1][...] *= 1.0 + 1e-6

    monkeypatch.setattr(cell_kernels, "point_stress", damaged)
    residual, matrix = differences(2)
    assert residual < 1e-12
    assert matrix > 1e-9
