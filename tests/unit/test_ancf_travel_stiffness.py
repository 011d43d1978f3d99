"""Stiffness of a pressed ANCF tire against the hub's travel: whole solves with the ground moved, rigid limit, symmetry.

The whole solves follow `contracts.hub_travel` (the ground moves against the hub's travel) and are read as
`contracts.travel_curve` reads the continuum's: sign and definition are the same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.motion.equilibrium import NewtonControls, newton_solve
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import TireEquilibria, solve_tire
from ancf_reduced.tire.travel_stiffness import WAYS, Stand, StuckGround, loaded_tangent, stand_under, stuck_ground
from contracts.errors import InputError
from contracts.frames import ground_direction_h
from contracts.hub_travel import HubTravel, Way
from contracts.travel_curve import WRENCH, TravelCurve

PRESET = replace(thesis_preset(), phase=0.1, quadrature=(3, 3, 2))
PHI, LOAD = 0.3, 120.0
NORMAL, FORWARD = -ground_direction_h(PHI), ground_direction_h(PHI + 0.5 * np.pi)
LEFT = np.cross(NORMAL, FORWARD)


@pytest.fixture(scope="module")
def states() -> TireEquilibria:
    return solve_tire(build_tire(PRESET), PHI, [0.006, 0.012, 0.018, 0.024])


@pytest.fixture(scope="module")
def stand(states: TireEquilibria) -> Stand:
    return stand_under(build_tire(PRESET), states, LOAD)


def moved_wrench(stuck: StuckGround, ground: np.ndarray, turned: float) -> dict[str, float]:
    """Force and moment of the ground at the hub after a nonlinear solve with the ground moved (3,) [m] and turned."""
    stand, tire, problem = stuck.stand, stuck.stand.tire, stuck.stand.problem
    along = np.eye(3) - np.outer(NORMAL, NORMAL)
    at = tire.grid.positions(stand.coordinates)[stuck.carriers, stuck.points]
    places = Rotation.from_rotvec(turned * NORMAL).apply(at) + ground

    def forces(p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        r = tire.grid.positions(p)[stuck.carriers, stuck.points]
        return r, stuck.stiffness * (places - r) @ along

    def residual(x: np.ndarray) -> tuple[np.ndarray, float]:
        p = problem.expand(x)
        out = tire.model.elastic_force(p) - problem.contact_force(p, stand.deflection)
        shape = tire.grid.tables.interpolation[stuck.carriers, stuck.points].reshape(-1, 4, 4)
        drawn = np.einsum("qab,qi->qabi", shape, forces(p)[1])
        np.subtract.at(out, tire.grid.tables.nodes[stuck.carriers], drawn)
        return out[tire.tie.free].ravel(), LOAD

    def tangent(x: np.ndarray) -> np.ndarray:
        return replace(stuck, stand=replace(stand, coordinates=problem.expand(x))).tangent

    start = stand.coordinates[tire.tie.free].ravel()
    found = newton_solve(residual, tangent, start, NewtonControls(tolerance=1e-12))
    assert found.converged
    r, f = forces(problem.expand(found.x))
    moment = np.cross(r, f).sum(axis=0)
    total = f.sum(axis=0)
    six = (total @ FORWARD, total @ LEFT, LOAD, moment @ FORWARD, moment @ LEFT, moment @ NORMAL)
    return dict(zip(WRENCH, map(float, six), strict=True))


@pytest.mark.parametrize("way", WAYS)
def test_it_is_that_of_whole_solves(stand: Stand, way: Way) -> None:
    """Central in sign, so that the error is of second order: 1e-5 for steps of a micrometre and a microradian."""
    stuck, step = stuck_ground(stand), 1e-6
    travel = HubTravel.along(way=way, start=stand.deflection, steps=(step,))
    motion = travel.ground(travel.controls[0])
    both = []
    for sign in (1.0, -1.0):
        ground = sign * (motion.forward * FORWARD + motion.left * LEFT)
        rows = [moved_wrench(stuck, 0.0 * ground, 0.0), moved_wrench(stuck, ground, sign * motion.turned)]
        curve = TravelCurve(
            model="ancf", way=way, orientation_deg=0.0, deflection=stand.deflection, travel=np.array([0.0, step]),
            columns={name: np.array([row[name] for row in rows]) for name in WRENCH}, source="",
        )  # fmt: skip
        both.append(sign * curve.stiffness)
    S = stuck.stiffness_matrix()
    column = WAYS.index(way)
    assert S[column, column] == pytest.approx(np.mean(both), rel=1e-5)
    assert S[column, column] > 0.0


def test_it_is_symmetric_and_least_energy(stand: Stand) -> None:
    stuck = stuck_ground(stand)
    S, v = stuck.stiffness_matrix(), stuck.moved()
    assert np.abs(S - S.T).max() < 1e-9 * np.abs(S).max()
    assert np.linalg.eigvalsh(S).min() > 0.0
    np.testing.assert_allclose(stuck.energies(v), np.diag(S), rtol=1e-9)
    assert np.all(stuck.energies(1.001 * v) > np.diag(S))


def test_a_rigid_tire_leaves_the_springs_of_the_ground(stand: Stand) -> None:
    """Closed form: k_t n against a travel, k_t sum r^2 against a turn; reached as 1 / E (twice as stiff, half off)."""
    short = []
    for factor in (1e6, 2e6):
        stiff = build_tire(replace(PRESET, young_modulus=factor * PRESET.young_modulus))
        reference = replace(stand, tire=stiff, coordinates=stiff.mesh.reference_coordinates())
        stuck = replace(stuck_ground(stand), stand=reference)
        r = stiff.grid.positions(reference.coordinates)[stuck.carriers, stuck.points]
        sums = len(r) * np.array([1.0, 1.0, np.mean((r @ FORWARD) ** 2 + (r @ LEFT) ** 2)])
        short.append(1.0 - np.diag(stuck.stiffness_matrix()) / (PRESET.contact_stiffness * sums))
    assert np.all((np.array(short) > 0.0) & (np.array(short) < 1e-3))
    np.testing.assert_allclose(short[0] / short[1], 2.0, rtol=1e-2)


def test_a_tire_soft_against_its_ground_is_stiffer_the_firmer_that_sticks(stand: Stand) -> None:
    """Negative control of k_t: it counts; and a ground without points does nothing."""
    found = [np.diag(stuck_ground(stand, ratio).stiffness_matrix()) for ratio in (0.1, 1.0, 10.0)]
    assert np.all(np.diff(found, axis=0) > 0.05 * found[1])
    none = replace(stuck_ground(stand), carriers=np.empty(0, dtype=int), points=np.empty(0, dtype=int))
    assert np.array_equal(none.stiffness_matrix(), np.zeros((3, 3)))


def test_the_equilibrium_is_the_one_under_the_load(stand: Stand, states: TireEquilibria) -> None:
    again = solve_tire(stand.tire, PHI, [stand.deflection])
    assert again.load[0] == pytest.approx(LOAD, rel=1e-8)
    np.testing.assert_allclose(stand.coordinates, again.coordinates[0], atol=1e-9)
    beyond = stand_under(stand.tire, states, 1.1 * float(states.load[-1]))
    assert beyond.deflection > states.deflection[-1]


def test_the_bordered_tangent_is_the_derivative(stand: Stand) -> None:
    """Finite differences of load and residual by the deflection."""
    problem, free, h = stand.problem, stand.tire.tie.free, 1e-7
    _, slope, by_d = loaded_tangent(problem, stand.coordinates, stand.deflection)
    contact = [problem.contact_force(stand.coordinates, stand.deflection + s) for s in (-h, h)]
    change = (contact[1] - contact[0]) / (2.0 * h)
    np.testing.assert_allclose(-change[free].ravel(), slope, atol=1e-5 * np.abs(slope).max())
    assert -(change[:, 0] @ problem.direction).sum() == pytest.approx(by_d, rel=1e-6)


@pytest.mark.parametrize("load", [0.0, -5.0, 1e4, np.nan])
def test_a_load_that_no_equilibrium_bears_is_refused(states: TireEquilibria, load: float) -> None:
    with pytest.raises(InputError, match="load of the travels"):
        stand_under(build_tire(PRESET), states, load)


@pytest.mark.parametrize("ratio", [0.0, -1.0, np.inf])
def test_a_ratio_that_holds_nothing_is_refused(stand: Stand, ratio: float) -> None:
    with pytest.raises(InputError, match="tangential over normal"):
        stuck_ground(stand, ratio)
