"""Claim: the planar model is the solid one where the design is prismatic, within 1 % along the curve to 30 mm.

Source: our own solid model on a wheel whose springs span the full width, three elements across 60 mm; closed form of
uniaxial tension; the Ritz strip in tests/unit/test_fe_plane_state.py. Tolerance: 1 % (measured: 0.6 %; the issue asks
5 %). Negative controls: plane stress for every part falls 8 % and more below the solid curve, a wheel with one set's
width left at half is caught too.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.planar import build_planar_mesh
from geometry.wheel import WheelDesign, exomars_hoops
from reference_fe.cells.discretisation import Discretisation
from reference_fe.contact.inner_pairs import wheel_contact_pairs
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.plane_state import PLANE_STRAIN, PLANE_STRESS
from reference_fe.material.stress import StressRecovery
from reference_fe.material.thermal_state import dilate
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support, Traction
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel
from reference_fe.wheel.section import solve_section, strip_constraints
from tests.structured_quadrilaterals import planar_block

DEFLECTIONS = (0.005, 0.010, 0.020, 0.030)
CASE = WheelLoadCase(orientation_deg=0.0, deflections=DEFLECTIONS)


def prismatic() -> WheelDesign:
    """Three hoops over the full width, no grousers: every section along the axle is the same."""
    outer = exomars_hoops().spring_sets[0]
    full = replace(outer, bands=((-60e-3, 60e-3),))
    return WheelDesign(spring_sets=(full,), grousers=None, cone=None, impact_springs=None, inner_hub=None)


@functools.cache
def section_curve(design: WheelDesign, orientation_deg: float = 0.0, constraint: float | None = None) -> WheelResult:
    mesh = build_planar_mesh(design, element_size=10e-3)
    held = {} if constraint is None else dict.fromkeys(mesh.parts, constraint)
    case = replace(CASE, orientation_deg=orientation_deg, transverse_constraint=held)
    return solve_section(mesh, design, case)


@functools.cache
def solid_load() -> NDArray[np.float64]:
    design = prismatic()
    mesh = build_mesh(design, element_size=10e-3, axial_size=20e-3, parts="flexible")
    return solve_wheel(mesh, design.materials, CASE).curve.load


def test_prismatic_wheel_against_the_solid_model() -> None:
    np.testing.assert_allclose(section_curve(prismatic()).curve.load[1:], solid_load()[1:], rtol=0.01)


def test_plane_stress_everywhere_is_caught() -> None:
    """Negative control: bands of 120 mm bend to cylinders; as beams they are nu^2 too soft."""
    ratio = section_curve(prismatic(), constraint=PLANE_STRESS).curve.load[1:] / solid_load()[1:]
    assert np.all(ratio < 0.93)


def test_a_lost_width_is_caught() -> None:
    """Negative control: springs of half the width in the same mesh."""
    design, mesh = prismatic(), build_planar_mesh(prismatic(), element_size=10e-3)
    narrow = replace(mesh, widths=dict(mesh.widths) | {"springs_outer": 0.06})
    ratio = solve_section(narrow, design, CASE).curve.load[1:] / solid_load()[1:]
    assert np.all(ratio < 0.9)


def test_records_of_a_section_run() -> None:
    """Columns of the solid model; standing on one grouser the patch is its tip, 1 mm x 120 mm."""
    result = section_curve(exomars_hoops())
    curve = result.curve
    assert curve.model == "section"
    assert curve.columns["contact_area_m2"][-1] == pytest.approx(120e-6, rel=0.02)
    assert np.abs(curve.columns["force_imbalance"]).max() < 1e-6
    assert {f"max_von_mises_{part}_Pa" for part in ("tire", "grousers", "springs_outer")} <= set(curve.columns)
    assert result.dofs < 6000


def test_springs_are_held_off_the_rim_and_cross_each_other() -> None:
    """At 30 mm they would overlap by 3.7 mm. Sets of different bands may lie over each other and must not touch."""
    design = exomars_hoops()
    mesh = build_planar_mesh(design, element_size=10e-3)
    pairs = {(pair.slave, pair.master) for pair in wheel_contact_pairs(mesh)}
    assert ("springs_outer_front", "tire_inner") in pairs
    assert not any("springs_outer" in a and "springs_inner" in b for a, b in pairs | {(b, a) for a, b in pairs})
    case = replace(CASE, orientation_deg=30.0)
    held, free = (solve_section(mesh, design, replace(case, inner_contact=on)).curve for on in (True, False))
    assert held.columns["spring_rim_gap_m"][-1] > -20e-6
    assert free.columns["spring_rim_gap_m"][-1] < -2e-3
    assert held.load[-1] > 1.2 * free.load[-1]


def test_iterations_to_30_mm() -> None:
    """20 points between two grousers, where contact changes most, in at most 130 iterations (measured: 113).

    Without inner contact 85 were measured.
    """
    case = WheelLoadCase(orientation_deg=15.0, deflections=tuple(np.linspace(0.0, 0.03, 21)[1:].tolist()))
    design = exomars_hoops()
    result = solve_section(build_planar_mesh(design, element_size=8e-3), design, case)
    assert sum(len(record.residuals) - 1 for record in result.increments) <= 130
    assert all(record.converged for record in result.increments)


@pytest.mark.parametrize(("constraint", "factor"), [(PLANE_STRESS, 1.0), (PLANE_STRAIN, 1.0 / (1.0 - 0.342**2))])
def test_uniaxial_tension_of_a_planar_block(constraint: float, factor: float) -> None:
    """P = E' l (l^2 - 1) / 2 on a width of 0.3 m, E' = E or E / (1 - nu^2): St. Venant-Kirchhoff, exact.

    The von Mises stress follows from the third stress, zero or nu times the first one.
    """
    stretch, material = 1.05, TI_6AL_4V
    force = factor * material.young_modulus * stretch * (stretch**2 - 1.0) / 2.0
    mesh = planar_block((2, 3), lambda X: X * np.array([2.0, 1.0]), width=0.3)
    problem = StaticProblem(
        Domain.from_tagged(mesh),
        {"body": material},
        [Support(faces=("x0",), components=(0,)), Support(meetings=(("x0", "z0"),), components=(1,))],
        loads=[Traction(faces=("x1",), vector=(force, 0.0))],
        transverse_constraint={"body": constraint},
    )
    problem.set_control(1.0)
    outcome = NewtonSolver(problem, NewtonSettings()).solve()
    assert outcome.converged
    moved = problem.nodal_displacement()[mesh.points[:, 0] == 2.0, 0]
    np.testing.assert_allclose(moved, 2.0 * (stretch - 1.0), rtol=1e-8)
    assert problem.reaction(outcome.residual) == pytest.approx([-0.3 * force, 0.0], abs=3e-9 * force)
    assert StressRecovery(problem).largest_by_part()["body"] == pytest.approx(_von_mises(stretch, constraint), rel=1e-8)


def _von_mises(stretch: float, constraint: float) -> float:
    """Cauchy von Mises stress of a bar at an axial stretch: S_1 = E' E_1, S_3 = nu S_1 in plane strain."""
    nu, E = TI_6AL_4V.poisson_ratio, TI_6AL_4V.young_modulus
    first = 0.5 * (stretch**2 - 1.0)
    if constraint == PLANE_STRESS:
        across = 1.0 - 2.0 * nu * first
        return E * first * stretch**2 / (stretch * across)
    S_1 = E * first / (1.0 - nu**2)
    thickness = np.sqrt(1.0 - 2.0 * nu / (1.0 - nu) * first)
    J = stretch * thickness
    sigma = np.array([S_1 * stretch**2, 0.0, nu * S_1]) / J
    return float(np.sqrt(0.5 * np.sum((sigma - np.roll(sigma, 1)) ** 2)))


def test_rigid_rotation_stores_no_stress() -> None:
    mesh = planar_block((2, 2), lambda X: X)
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": TI_6AL_4V}, [Support(faces=("x0",))])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    problem.u.interpolate(lambda x: (turn - np.eye(2)) @ x[:2])
    assert np.abs(problem.residual()).max() < 1e-6 * TI_6AL_4V.young_modulus * 1e-6


@pytest.mark.parametrize("constraint", [PLANE_STRESS, 0.4, PLANE_STRAIN])
def test_free_expansion_stores_no_stress(constraint: float) -> None:
    """The width expands as well; a body that may, carries no stress, however it is held across the plane."""
    warm = replace(TI_6AL_4V, thermal_strain=2e-3)
    problem = StaticProblem(
        Domain.from_tagged(planar_block((2, 1), lambda X: X)),
        {"body": warm},
        [Support(meetings=(("x0", "z0"),)), Support(meetings=(("x1", "z0"),), components=(1,))],
        transverse_constraint={"body": constraint},
    )
    held = np.abs(problem.residual()).max()
    dilate(problem.u, warm.thermal_stretch)
    assert np.abs(problem.residual()).max() < 1e-9 * held
    assert StressRecovery(problem).largest_by_part()["body"] < 1e-7 * warm.young_modulus * warm.thermal_strain


def test_strips_of_the_wheel_are_between_beam_and_plate() -> None:
    found = strip_constraints(exomars_hoops())
    assert 0.5 < found["springs_outer"] < found["springs_inner"] < found["tire"] < 1.0


def test_what_has_no_planar_form_is_refused() -> None:
    domain = Domain.from_tagged(planar_block((1, 1), lambda X: X))
    neo = Discretisation(law=MaterialLaw.NEO_HOOKEAN, gauss_points=(2, 3))
    with pytest.raises(InputError, match="planar form"):
        StaticProblem(domain, {"body": TI_6AL_4V}, [Support(faces=("x0",))], discretisation=neo)
    solid = build_mesh(prismatic(), element_size=30e-3, axial_size=60e-3, parts="flexible")
    with pytest.raises(InputError, match="section mesh"):
        solve_section(solid, prismatic(), CASE)


def leaf_wheel() -> WheelDesign:
    """Six outer leaves that run over the welds of three inner ones on their way round the rim; one was found stuck."""
    tire, outer = exomars_hoops().tire, exomars_hoops().spring_sets[0]
    thin = replace(outer, count=6, bands=((-60e-3, -46e-3), (46e-3, 60e-3)), thickness=0.52e-3, weld_length=12.6e-3)
    points = tuple((f, np.deg2rad(a)) for f, a in ((0.33, 47.8), (0.67, 17.1)))
    inside = tuple((f, np.deg2rad(a)) for f, a in ((0.33, 28.7), (0.67, 24.3)))
    inner = replace(thin, name="springs_inner", count=3, phase=np.deg2rad(37.4), bands=((-12e-3, 12e-3),))
    return WheelDesign(
        tire=replace(tire, thickness=0.611e-3),
        spring_sets=(
            replace(thin, shape="spline", points=points, direction=1),
            replace(inner, shape="spline", points=inside, direction=-1),
        ),
        outer_hub=replace(exomars_hoops().outer_hub, outer_radius=45.5e-3),
        cone=None,
        impact_springs=None,
        inner_hub=None,
    )


def test_a_spring_touches_the_rim_where_another_band_is_welded() -> None:
    """Beside that weld the leaf once slipped through a hole in the planar rim, in and out: a cycle without an end."""
    design = leaf_wheel()
    case = replace(CASE, orientation_deg=30.0, deflections=tuple(np.arange(0.0, 0.036, 2.5e-3)[1:].tolist()))
    settings = NewtonSettings(relative_tolerance=1e-6)
    result = solve_section(build_planar_mesh(design, element_size=16e-3), design, replace(case, newton=settings))
    assert all(record.converged for record in result.increments)
    assert result.curve.columns["inner_penetration_m"].max() > 0.0
    assert result.curve.columns["spring_rim_gap_m"].min() > -20e-6


def test_two_elements_through_the_thickness_keep_the_contact() -> None:
    """Loads of one and two elements differ by 0.2 %; with the springs' faces turned round they differed by 9 %."""
    case = replace(CASE, orientation_deg=15.0)
    design = exomars_hoops()
    one, two = (
        solve_section(build_planar_mesh(design, element_size=16e-3, thickness_elements=n), design, case).curve
        for n in (1, 2)
    )
    np.testing.assert_allclose(two.load[1:], one.load[1:], rtol=0.004)
    assert two.columns["inner_penetration_m"].max() > 1e-6
