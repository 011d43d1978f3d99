"""Claim: at finite strain the displacement converges with the theoretical orders, k + 1 in L2 and k in the H1
seminorm, for degree k = 1 and 2, for both laws, on distorted (degree 2: curved) cells, with the default quadrature too.

Method and source of the orders: reference_fe/verification/manufactured_solution.py (Roache 2002; Ciarlet 1978, theorems
3.2.2, 3.2.5 and 4.1; the two-point direction of the default rule still keeps them). Tolerance on the order: 0.15,
fitted on three meshes.
"""

from __future__ import annotations

import pytest

from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.static_problem import Discretisation, ElementFamily
from reference_fe.verification.manufactured_solution import convergence, with_shear_modulus


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "degree", "gauss_points"),
    [
        (MaterialLaw.ST_VENANT_KIRCHHOFF, 1, (2, 2, 2)),
        (MaterialLaw.NEO_HOOKEAN, 1, (2, 2, 2)),
        (MaterialLaw.ST_VENANT_KIRCHHOFF, 2, Discretisation().gauss_points),
        pytest.param(MaterialLaw.NEO_HOOKEAN, 2, Discretisation().gauss_points, marks=pytest.mark.long),
        pytest.param(MaterialLaw.ST_VENANT_KIRCHHOFF, 2, (3, 3, 3), marks=pytest.mark.long),
        pytest.param(MaterialLaw.NEO_HOOKEAN, 2, (3, 3, 3), marks=pytest.mark.long),
    ],
)
def test_orders_of_convergence(law: MaterialLaw, degree: int, gauss_points: tuple[int, int, int]) -> None:
    found = convergence(Discretisation(law=law, degree=degree, gauss_points=gauss_points))
    assert found.orders == pytest.approx((degree + 1.0, degree), abs=0.15)


@pytest.mark.slow
@pytest.mark.long
def test_serendipity_elements_reach_the_same_orders() -> None:
    """20-node shape functions with 2 x 2 x 2 points; the geometry is curved but smoothly so."""
    law = MaterialLaw.NEO_HOOKEAN
    choice = Discretisation(law=law, family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 2))
    assert convergence(choice, counts=(6, 8, 11)).orders == pytest.approx((3.0, 2.0), abs=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("degree", [1, pytest.param(2, marks=pytest.mark.long)])
def test_a_wrong_shear_modulus_loses_the_order(degree: int) -> None:
    """Negative control: 25 % off in mu leaves an error that does not shrink with the mesh."""
    gauss_points = (2, 2, 2) if degree == 1 else (3, 3, 3)
    choice = Discretisation(law=MaterialLaw.ST_VENANT_KIRCHHOFF, degree=degree, gauss_points=gauss_points)
    in_l2, in_h1 = convergence(choice, with_shear_modulus(1.25)).orders
    assert in_l2 < 0.5
    assert in_h1 < degree - 0.3
