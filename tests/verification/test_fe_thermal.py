"""Claim: free expansion causes no stress, held expansion the right one, and residual and tangent come from one energy.

Sources: energy theta^3 psi(F/theta) per volume at 20 C (Lu & Pister, Int. J. Solids Struct. 11, 1975); Timoshenko,
Analysis of bi-metal thermostats, J. Opt. Soc. Am. 11 (1925) 233; geometrical similarity. Tolerances: finite differences
1e-6; two implementations 1e-12; bimetal 1 % (Timoshenko is a small-strain beam, ours has 0.1 % strain and three
dimensions); similarity 2e-4 (the contact penalty does not scale with the wheel).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import TI_6AL_4V, Material
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import fem, ufl
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.stress import StressRecovery
from reference_fe.material.thermal_state import dilate, solve_thermal_state
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings
from reference_fe.verification.structured_hexahedra import block_mesh
from reference_fe.wheel.pressed import WheelLoadCase, solve_wheel

SOFT = Material(
    name="soft",
    young_modulus=3.0,
    poisson_ratio=0.3,
    density=1.0,
    yield_strength=1.0,
    source="test",
    thermal_strain=0.1,
)
STRIP = Material(
    name="strip", young_modulus=1e11, poisson_ratio=0.0, density=1.0, yield_strength=1e9, source="round numbers"
)
LAWS = (MaterialLaw.ST_VENANT_KIRCHHOFF, MaterialLaw.NEO_HOOKEAN)
THREE_TWO_ONE = (
    Support(faces=("x0",), components=(0,)),
    Support(meetings=(("x0", "y0"),), components=(1,)),
    Support(meetings=(("x0", "y0", "z0"),), components=(2,)),
    Support(meetings=(("x0", "y1", "z0"),), components=(2,)),
)
"""Holds a body whose face x0 lies in x = 0 without keeping it from expanding about the origin."""


def two_parts(mesh: TaggedMesh, axis: int, level: float) -> TaggedMesh:
    """The block with the cells beyond a level [m] along an axis as the part ``far``."""
    far = mesh.points[mesh.cells].mean(axis=1)[:, axis] > level
    return replace(mesh, cell_tags=np.where(far, 2, 1).astype(np.int32), parts={"body": 1, "far": 2})


def distorted(law: MaterialLaw, *, compiled: bool) -> StaticProblem:
    """A distorted block of two parts that expand differently, with a random displacement."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        return X + 0.05 * np.sin(3.0 * X[:, [1, 2, 0]])

    made = StaticProblem(
        Domain.from_tagged(two_parts(block_mesh((2, 1, 1), mapping), 0, 0.5)),
        {"body": SOFT, "far": replace(SOFT, young_modulus=5.0, thermal_strain=-0.05)},
        [Support(faces=("x0",))],
        discretisation=Discretisation(law=law, compiled=compiled),
    )
    made.u.x.array[:] = 0.03 * np.random.default_rng(5).standard_normal(made.dofs)
    return made


def energy(problem: StaticProblem) -> float:
    """Integral of theta^3 psi(F/theta) [J], written down anew."""
    mesh, theta, (lam, mu) = problem.domain.mesh, problem.stretch, problem.lame
    F = (ufl.Identity(3) + ufl.grad(problem.u)) / theta
    C = F.T * F
    E = 0.5 * (C - ufl.Identity(3))
    if problem.discretisation.law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        psi = 0.5 * lam * ufl.tr(E) ** 2 + mu * ufl.inner(E, E)
    else:
        J = ufl.det(F)
        psi = 0.5 * mu * (ufl.tr(C) - 3.0) - mu * ufl.ln(J) + 0.5 * lam * ufl.ln(J) ** 2
    parts = problem.domain.part_tags(problem.materials)
    dx = api.cell_measure(mesh, problem.domain.cell_tags, parts, problem.discretisation.gauss_points)
    return float(fem.assemble_scalar(api.compile_form(theta**3 * psi * dx)))


@pytest.mark.parametrize("law", LAWS)
def test_residual_is_the_gradient_of_the_energy(law: MaterialLaw) -> None:
    problem = distorted(law, compiled=True)
    direction = np.random.default_rng(7).standard_normal(problem.dofs)
    here, step = problem.u.x.array.copy(), 1e-5
    found = float(problem.residual() @ direction)
    values = []
    for sign in (1.0, -1.0):
        problem.u.x.array[:] = here + sign * step * direction
        values.append(energy(problem))
    assert found == pytest.approx((values[0] - values[1]) / (2.0 * step), rel=1e-6)


@pytest.mark.parametrize("law", LAWS)
def test_tangent_is_the_gradient_of_the_residual(law: MaterialLaw) -> None:
    problem = distorted(law, compiled=True)
    direction = np.random.default_rng(11).standard_normal(problem.dofs)
    problem.store_stress(extrapolate=False)
    matrix = problem.unsupported_tangent()
    x, y = matrix.createVecRight(), matrix.createVecLeft()
    x.array[:] = direction
    matrix.mult(x, y)
    here, step, values = problem.u.x.array.copy(), 1e-5, []
    for sign in (1.0, -1.0):
        problem.u.x.array[:] = here + sign * step * direction
        values.append(problem.residual())
    difference = (values[0] - values[1]) / (2.0 * step)
    assert np.abs(y.array - difference).max() < 1e-6 * np.abs(difference).max()


def test_compiled_loops_equal_the_forms() -> None:
    ours, reference = (distorted(LAWS[0], compiled=compiled) for compiled in (True, False))
    residuals = ours.residual(), reference.residual()
    assert np.abs(residuals[0] - residuals[1]).max() < 1e-12 * np.abs(residuals[1]).max()


@pytest.mark.parametrize("law", LAWS)
def test_parts_that_expand_alike_are_free_of_stress(law: MaterialLaw) -> None:
    """And a negative control: a part that expands one per cent less carries stress."""

    def largest_stress(far: Material) -> float:
        domain = Domain.from_tagged(two_parts(block_mesh((2, 1, 1), lambda X: X), 0, 0.5))
        choice, materials = Discretisation(law=law), {"body": SOFT, "far": far}
        state = solve_thermal_state(domain, materials, THREE_TWO_ONE, choice, NewtonSettings())
        return max(StressRecovery(state).largest_by_part().values())

    stiff = replace(SOFT, young_modulus=30.0)
    assert largest_stress(stiff) < 1e-12
    assert largest_stress(replace(stiff, thermal_strain=0.099)) > 1e-4


def test_a_held_block_has_the_closed_form_stress() -> None:
    """F = I: S = -(3 lambda + 2 mu)(theta^2 - 1)/(2 theta) I, and so much force on each unit face."""
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X))
    problem = StaticProblem(domain, {"body": SOFT}, [Support(faces=("x0", "x1", "y0", "y1", "z0", "z1"))])
    nodal = problem.residual().reshape(-1, 3)
    at_x1 = np.isclose(problem.V.tabulate_dof_coordinates()[:, 0], 1.0)
    theta = 1.1
    bulk = 3.0 * SOFT.lame_lambda + 2.0 * SOFT.lame_mu
    assert nodal[at_x1, 0].sum() == pytest.approx(-bulk * (theta**2 - 1.0) / (2.0 * theta), rel=1e-12)


def test_a_held_part_expands_with_its_stretch() -> None:
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X + 1.0))
    problem = StaticProblem(domain, {"body": SOFT}, [Support(parts=("body",), stretch=SOFT.thermal_stretch)])
    for bc in problem.bcs:
        bc.set(problem.u.x.array)
    held = problem.u.x.array.copy()
    dilate(problem.u, SOFT.thermal_stretch)
    np.testing.assert_allclose(held, problem.u.x.array, rtol=1e-12)
    assert np.abs(problem.residual()).max() < 1e-12


@pytest.mark.parametrize(("layers", "stiffer"), [((1, 1), 1.0), ((1, 2), 3.0)])
def test_a_bimetal_strip_curves_as_timoshenko_has_it(layers: tuple[int, int], stiffer: float) -> None:
    """Thicknesses t1, t2, m = t1/t2, n = E1/E2: curvature 6 d (1+m)^2 / (h (3 (1+m)^2 + (1+mn)(m^2 + 1/(mn))))."""
    length, h, strain = 0.04, 1e-3, 1e-3
    t1 = h * layers[0] / sum(layers)
    m, n = layers[0] / layers[1], stiffer
    expected = 6.0 * strain * (1.0 + m) ** 2 / (h * (3.0 * (1.0 + m) ** 2 + (1.0 + m * n) * (m**2 + 1.0 / (m * n))))
    shape = np.array([length, h, h])
    mesh = two_parts(block_mesh((12, 1, sum(layers)), lambda X: X * shape), 2, t1)
    materials = {
        "body": replace(STRIP, young_modulus=n * STRIP.young_modulus),
        "far": replace(STRIP, thermal_strain=-strain),
    }
    state = solve_thermal_state(
        Domain.from_tagged(mesh), materials, THREE_TWO_ONE, Discretisation(), NewtonSettings(relative_tolerance=1e-9)
    )
    u = state.nodal_displacement()
    bottom = np.isclose(mesh.points[:, 2], 0.0) & np.isclose(mesh.points[:, 1], 0.0)
    x, z = (mesh.points + u)[bottom][:, [0, 2]].T
    tip = int(np.argmax(x))
    curvature = 2.0 * z[tip] / (x[tip] ** 2 + z[tip] ** 2)  # circle through the origin, tangent to x
    assert curvature == pytest.approx(expected, rel=0.01)


def wheel_load(materials: dict[str, Material], deflection: float) -> float:
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=15.0, deflections=(deflection,))
    return float(solve_wheel(mesh, materials, case).curve.load[-1])


def test_a_cold_wheel_is_a_smaller_wheel_of_stiffer_material() -> None:
    """F_T(d) = theta^2 E_T/E_20 F_20(d/theta) if all is of one metal. Negative control: not without expansion."""
    parts = ("tire", "grousers", "springs_outer", "springs_inner", "outer_hub")
    cold, deflection = TI_6AL_4V.at(130.15), 0.003
    theta = cold.thermal_stretch
    at_20_c = wheel_load(dict.fromkeys(parts, TI_6AL_4V), deflection / theta)
    similar = theta**2 * cold.young_modulus / TI_6AL_4V.young_modulus * at_20_c
    assert wheel_load(dict.fromkeys(parts, cold), deflection) == pytest.approx(similar, rel=2e-4)
    unexpanded = dict.fromkeys(parts, replace(cold, thermal_strain=0.0))
    assert abs(wheel_load(unexpanded, deflection) / similar - 1.0) > 1e-3
