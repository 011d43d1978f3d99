"""Claim: laws by part reach everything around the solver: temperature, planar meshes, contact stiffness, a whole wheel.

Sources: a body free to expand is free of stress at theta times its size, whatever its law; a clamped rod of rubber or
metal heated by theta carries the stress of its law at the elastic stretch 1/theta (closed forms of
tests/verification/test_fe_laws_uniform.py). A wheel of metal that never yields is the neo-Hookean wheel within what
their energies and pressure functions differ by (1.0 % on this coarse mesh, 1.5 % are allowed); one that yields is
softer, and the ground's work is what is stored and what flow dissipates.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.material_laws import J2Plasticity, Law, MooneyRivlin, NeoHookean
from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.material.elastic_fields import elastic_fields
from reference_fe.material.stored_energy import StoredEnergy
from reference_fe.material.stress import StressRecovery
from reference_fe.material.thermal_state import dilate
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.patch import STEEL, distorted_cube
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.problem import wheel_problem
from tests.structured_quadrilaterals import planar_block

RUBBER = MooneyRivlin(c10=0.4e6, c01=0.1e6, bulk_modulus=50e6)


@pytest.mark.parametrize("law", [NeoHookean(), RUBBER, J2Plasticity()])
def test_free_expansion_is_free_of_stress(law: Law) -> None:
    theta = 1.03
    material = replace(STEEL, law=law, thermal_strain=theta - 1.0)
    held = [Support(faces=(f"{x}0",), components=(k,)) for k, x in enumerate("xyz")]
    problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": material}, held)
    stress, energy = StressRecovery(problem), StoredEnergy(problem)
    scale = np.abs(problem.residual()).max()
    dilate(problem.u, theta)
    assert np.abs(problem.residual()).max() < 1e-12 * scale
    assert stress.cell_stations().max() < 1e-10 * STEEL.young_modulus
    assert abs(energy.value()) < 1e-12 * STEEL.young_modulus
    dilate(problem.u, theta * 1.001)
    assert np.abs(problem.residual()).max() > 1e-4 * scale


def test_a_heated_rod_that_cannot_grow_yields() -> None:
    """Uniaxial: ln(1/theta) = -R(a)/E - a at the elastic stretch; the stress sees the area (theta s)^2."""
    theta, hardening = 1.02, 2e9
    material = replace(STEEL, law=J2Plasticity(hardening_modulus=hardening), thermal_strain=theta - 1.0)
    held = [Support(faces=(f"{x}0",), components=(k,)) for k, x in enumerate("xyz")]
    held.append(Support(faces=("x1",), components=(0,)))
    problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": material}, held)
    stress = StressRecovery(problem)
    (state,) = solve_increments(NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-11)), [1.0], [])
    E, nu, R = STEEL.young_modulus, STEEL.poisson_ratio, STEEL.yield_strength
    a = (np.log(theta) - R / E) / (1.0 + hardening / E)
    side = theta * np.exp(nu * (R + hardening * a) / E + 0.5 * a)
    assert stress.largest_plastic_strain()["body"] == pytest.approx(a, rel=1e-8)
    kirchhoff = R + hardening * a
    volume = np.exp(-(1.0 - 2.0 * nu) * kirchhoff / E)
    force = state.outcome.residual[problem.bcs[3].dof_indices()[0]].sum()
    assert force == pytest.approx(-kirchhoff / volume * side**2, rel=1e-8)


def test_stress_asked_for_after_the_thermal_step_knows_of_it() -> None:
    """As a wheel's is, whose thermal state is accepted before anything records it; later it is refused."""
    material = replace(STEEL, law=J2Plasticity(hardening_modulus=2e9), thermal_strain=0.02)
    held = [Support(faces=(f"{x}0",), components=(k,)) for k, x in enumerate("xyz")]
    held.append(Support(faces=("x1",), components=(0,)))
    problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": material}, held)
    before = StressRecovery(problem)
    list(solve_increments(NewtonSolver(problem, NewtonSettings()), [1.0], []))
    after = StressRecovery(problem)
    assert before.largest_plastic_strain()["body"] > 0.01
    assert after.largest_plastic_strain() == before.largest_plastic_strain()
    assert np.array_equal(after.cell_stations(), before.cell_stations())
    problem.accept()
    with pytest.raises(InputError, match="before the first increment"):
        StressRecovery(problem)


def test_planar_meshes_refuse_other_laws() -> None:
    domain = Domain.from_tagged(planar_block((1, 1), lambda X: X))
    with pytest.raises(InputError, match="law of body = mooney_rivlin: has no planar form here"):
        elastic_fields(domain, {"body": STEEL}, {}, {"body": RUBBER})


def test_contact_takes_the_rubber_s_stiffness() -> None:
    """E = 9 K mu / (3 K + mu), not the material's E."""
    domain = Domain.from_tagged(distorted_cube())
    lam, mu = (field.x.array[0] for field in elastic_fields(domain, {"body": STEEL}, {}, {"body": RUBBER}).lame)
    K, shear = RUBBER.bulk_modulus, RUBBER.shear_modulus
    assert mu * (3.0 * lam + 2.0 * mu) / (lam + mu) == pytest.approx(9.0 * K * shear / (3.0 * K + shear), rel=1e-12)


def pressed(law: Law, yield_strength: float, steps: int = 4) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Load [N], stored and dissipated energy [J] of a coarse half wheel at each of some equal steps to 20 mm."""
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=True)
    material = replace(TI_6AL_4V, law=law, yield_strength=yield_strength)
    deflections = tuple(0.02 * k / steps for k in range(1, steps + 1))
    case = WheelLoadCase(orientation_deg=15.0, deflections=deflections)
    wheel = wheel_problem(mesh, dict.fromkeys(mesh.parts, material), case)
    energy, rows = StoredEnergy(wheel.problem), []
    for state in solve_increments(NewtonSolver(wheel.problem, case.newton), deflections, []):
        load = float(wheel.sides * state.contact_force @ wheel.normal)
        dissipated = wheel.sides * energy.plastic_dissipation()
        rows.append((state.control, load, wheel.sides * energy.value(), dissipated))
    table = np.array([(0.0, 0.0, 0.0, 0.0), *rows])
    return table[:, :2], table[:, 2], table[:, 3]


@pytest.fixture(scope="module")
def yielding() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return pressed(J2Plasticity(hardening_modulus=1e9), 3e8, 16)


@pytest.mark.long
def test_a_wheel_that_never_yields_is_elastic(yielding: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    elastic = pressed(J2Plasticity(hardening_modulus=1e9), 1e12)
    neo = pressed(NeoHookean(), 1e12)
    assert elastic[2][-1] == 0.0
    assert elastic[0][-1, 1] == pytest.approx(neo[0][-1, 1], rel=1.5e-2)
    assert yielding[0][-1, 1] < 0.97 * elastic[0][-1, 1]


@pytest.mark.long
def test_the_ground_s_work_is_stored_or_dissipated(yielding: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    curve, stored, dissipated = yielding
    work = np.trapezoid(curve[:, 1], curve[:, 0])
    rule = abs(np.trapezoid(curve[::2, 1], curve[::2, 0]) - work) / 3.0
    assert abs(stored[-1] + dissipated[-1] - work) < 2.0 * rule + 2e-3 * work
    assert rule < 3e-3 * work
    assert dissipated[-1] > 0.02 * work
