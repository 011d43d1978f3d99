"""Claim: parts of one body that meet hold each other off, with the right force at the right place.

Sources and tolerances:
- Patch test: two bars with meshes that do not match, pressed together, are under uniform stress. The force reaches the
  master at the slave's Gauss points, whose integral over parts of a facet is not exact, so that points to surface holds
  the sum exactly and the rest to its quadrature: displacement of the touching faces even to 2 % of the shortening with
  5 points a facet (measured 1.2 %; 0.1 % with 15).
- A strip clamped at the top of a rigid cylinder and pressed onto it by a force P at its end lies on the cylinder up to
  the place x_c where its moment P (L - x_c) is EI/R (no pressure within, P at x_c), and is a cantilever beyond: end
  deflection x_c^2/(2 R) + x_c (L - x_c)/R + P (L - x_c)^3/(3 EI). Small slopes, L/R = 0.05, and a gap that starts at
  zero like a spring's beside its weld: 1 %.
- A wheel that bottoms out on its hub stiffens at once, many times: at least three times is asked for.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import TI_6AL_4V, Material
from geometry.build import build_mesh
from geometry.parts import HubRing
from geometry.wheel import exomars_hoops
from reference_fe.contact.inner import ContactPair, InnerContact
from reference_fe.contact.parts_overlap import PartsOverlap
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support, Traction
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh, stacked
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel

Array = NDArray[np.float64]
SOFT = Material(name="a", young_modulus=1e7, poisson_ratio=0.0, density=1.0, yield_strength=1.0, source="round numbers")
PRESSURE, STIFFNESS = 1e4, 2e9


def pressed_bars(gauss_points: int) -> tuple[StaticProblem, ConvergedState]:
    """A bar on a bar, 20 micrometres apart at the start, under a uniform pressure on the upper end."""
    low = block_mesh((2, 3, 1), lambda X: X)
    high = block_mesh((3, 2, 1), lambda X: X + np.array([0.0, 0.0, 1.0 + 2e-5]))
    pair = ContactPair(slave="lid_z0", master="z1")
    law = InnerContact(pairs=(pair,), stiffness=STIFFNESS, ramp=1e-6, gauss_points=gauss_points)
    sliding = [
        Support(faces=(f"{side}{face}",), components=(k,))
        for side in ("", "lid_")
        for k, face in enumerate(("x0", "y0"))
    ]
    problem = StaticProblem(
        Domain.from_tagged(stacked(low, high, "lid")),
        {"body": SOFT, "lid": SOFT},
        [Support(faces=("z0",), components=(2,)), *sliding],
        loads=[Traction(faces=("lid_z1",), vector=(0.0, 0.0, -PRESSURE))],
        surfaces=[law],
    )
    start = problem.u.x.array.reshape(-1, 3)
    start[problem.V.tabulate_dof_coordinates()[:, 2] > 1.00001, 2] = -2e-5  # the upper bar needs something to stand on
    (state,) = solve_increments(NewtonSolver(problem, NewtonSettings()), [1.0], [])
    return problem, state


def uneven(problem: StaticProblem, *, upper: bool) -> float:
    """Largest difference of a bar's end shortening between nodes of its touching face, relative to the shortening."""
    z, u = problem.domain.tagged.points[:, 2], problem.nodal_displacement()[:, 2]
    face = u[np.abs(z - (1.0 + 2e-5 if upper else 1.0)) < 1e-9]
    return float(np.ptp(face) / (PRESSURE / SOFT.young_modulus))


def test_patch_of_bars_that_do_not_match() -> None:
    problem, state = pressed_bars(5)
    np.testing.assert_allclose(state.reaction, [0.0, 0.0, PRESSURE], atol=1e-6 * PRESSURE)
    assert uneven(problem, upper=False) < 0.02
    assert uneven(problem, upper=True) < 0.02
    top = problem.nodal_displacement()[problem.domain.tagged.points[:, 2] > 2.0, 2].mean()
    strain = PRESSURE / SOFT.young_modulus
    shortening = 2.0 * strain * (1.0 + 1.5 * strain) + PRESSURE / STIFFNESS  # St. Venant-Kirchhoff, second order
    assert -(top + 2e-5) == pytest.approx(shortening, rel=3e-4)


def test_more_points_hold_the_patch_better() -> None:
    """Negative control: with two points a facet the bars are visibly uneven; the error falls as points are added."""
    errors = [uneven(pressed_bars(points)[0], upper=False) for points in (2, 5, 15)]
    assert errors[0] > 0.05
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2]


LENGTH, THICKNESS, RADIUS = 0.1, 0.5e-3, 2.0
STRIP = replace(SOFT, young_modulus=1e11)
BENDING = STRIP.young_modulus * THICKNESS**3 / 12.0
"""EI per width [N m]."""


def end_deflection(contact_lengths: tuple[float, ...], *, touching: bool = True) -> tuple[Array, list[ConvergedState]]:
    """Deflection of the end under the loads that should lay the strip down over the given lengths [m]."""
    width = 0.01
    barrel = block_mesh((8, 1, 1), lambda X: _on_barrel(X, width))
    strip = block_mesh((40, 1, 1), lambda X: X * [LENGTH, width, THICKNESS])
    mesh = stacked(barrel, strip, "strip")
    law = InnerContact(pairs=(ContactPair(slave="strip_z0", master="z1"),), stiffness=1e10)
    loads = [BENDING / RADIUS / (LENGTH - x) for x in contact_lengths]
    problem = StaticProblem(
        Domain.from_tagged(mesh),
        {"strip": STRIP},
        [Support(parts=("body",)), Support(faces=("strip_x0",))],
        loads=[Traction(faces=("strip_x1",), vector=(0.0, 0.0, -1.0 / THICKNESS))],
        surfaces=[law] if touching else [],
    )
    end = (np.abs(mesh.points - [LENGTH, 0.0, 0.5 * THICKNESS]) < 1e-9).all(axis=1)
    states, found = [], []
    for state in solve_increments(NewtonSolver(problem, NewtonSettings(maximum_iterations=40)), loads, []):
        if state.wanted:
            states.append(state)
            found.append(float(-problem.nodal_displacement()[end, 2][0]))
    return np.array(found), states


def _on_barrel(X: Array, width: float) -> Array:
    """Rigid block under the strip, a little longer and wider, its top a cylinder that touches the strip at x = 0."""
    angle = (-0.1 + 1.3 * X[:, 0]) * LENGTH / RADIUS
    r = RADIUS - 0.01 * (1.0 - X[:, 2])
    return np.column_stack([r * np.sin(angle), width * (1.4 * X[:, 1] - 0.2), r * np.cos(angle) - RADIUS])


def closed_form(contact_lengths: tuple[float, ...], radius: float = RADIUS) -> Array:
    """End deflection under the load that lays the strip down over x_c on a cylinder of radius ``RADIUS`` [m]."""
    load = BENDING / RADIUS / (LENGTH - np.array(contact_lengths))
    rest = BENDING / radius / load
    x_c = LENGTH - rest
    return x_c**2 / (2.0 * radius) + x_c * rest / radius + load * rest**3 / (3.0 * BENDING)


LAID = (0.03, 0.05, 0.07)


def test_a_strip_lies_down_on_a_cylinder() -> None:
    found, states = end_deflection(LAID)
    np.testing.assert_allclose(found, closed_form(LAID), rtol=0.01)
    for state, x in zip(states, LAID, strict=True):  # clamp and cylinder together carry the load
        load = BENDING / RADIUS / (LENGTH - x) * 0.01
        np.testing.assert_allclose(state.reaction, [0.0, 0.0, load], atol=1e-5 * load)


def test_a_strip_without_contact_and_a_wrong_radius_are_caught() -> None:
    """Negative controls: the free cantilever sinks far deeper; ten per cent of radius shows."""
    free, _ = end_deflection(LAID[-1:], touching=False)
    assert free[0] > 2.0 * closed_form(LAID)[-1]
    assert np.abs(closed_form(LAID, 1.1 * RADIUS) / closed_form(LAID) - 1.0).min() > 0.02


HUB_GAP = 17e-3


def low_wheel(*, inner_contact: bool) -> WheelResult:
    """A wheel with a large rigid hub, on the soft place between its springs, pressed until the hub catches the rim."""
    design = exomars_hoops()
    design = replace(
        design,
        grousers=None,
        spring_sets=(replace(design.spring_sets[0], bands=((-60e-3, 60e-3),), thickness=0.4e-3),),
        outer_hub=HubRing(outer_radius=design.tire.inner_radius - HUB_GAP, thickness=2e-3, width=120e-3),
        cone=None,
        impact_springs=None,
        inner_hub=None,
    )
    mesh = build_mesh(design, element_size=14e-3, axial_size=60e-3)
    deflections = (6e-3, 12e-3, 16e-3, HUB_GAP + 20e-6, HUB_GAP + 60e-6)
    case = WheelLoadCase(orientation_deg=60.0, deflections=deflections, inner_contact=inner_contact)
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)


def test_a_wheel_stiffens_where_it_bottoms_out_on_its_hub() -> None:
    held, through = (low_wheel(inner_contact=on).curve for on in (True, False))
    slopes, free = (np.diff(curve.load) / np.diff(curve.deflection) for curve in (held, through))
    assert slopes[-1] > 3.0 * slopes[:3].max()
    assert free[-1] < 1.5 * free[:3].max()  # negative control
    assert 0.0 < held.columns["inner_penetration_m"][-1] < 60e-6
    np.testing.assert_allclose(held.load[:3], through.load[:3], rtol=0.02)


def test_springs_and_rim_hold_each_other_off() -> None:
    """At 15 degrees the springs meet the rim at about 10 mm; without contact they pass into it (negative control)."""
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    curves, overlap = {}, {}
    for on in (True, False):
        case = WheelLoadCase(orientation_deg=15.0, deflections=(10e-3, 22e-3), inner_contact=on, keep_points=True)
        result = solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
        curves[on], overlap[on] = result.curve, PartsOverlap(mesh).deepest(result.points[-1].displacement)
    gap = {on: curve.columns["spring_rim_gap_m"][-1] for on, curve in curves.items()}
    assert -20e-6 < gap[True] < 0.0
    assert gap[False] < -0.2e-3
    assert overlap[True].depth < 50e-6 < 0.2e-3 < overlap[False].depth  # by the gate's search in the shape alone
    assert "tire" in overlap[False].parts
    assert curves[True].columns["inner_penetration_m"][-1] < 20e-6
    assert curves[True].load[-1] > 1.01 * curves[False].load[-1]
    assert curves[True].columns["force_imbalance"][-1] < 1e-6
