"""Six wheels in one mesh are six wheels.

Claim: plates, contact points and coordinates of six wheels joined into one system (one constant mass matrix, thesis
section 2.5) give each wheel the force, the tangents and the motion it has alone.
Source: the wheels do not touch each other, so that the equations of the whole are those of the parts.
Tolerance: forces and tangents of plates and contact bit by bit, since each plate's loop is the same. Forces, mass and
tangents in the independent vectors to 1e-12 of the largest entry: products with matrices of another size sum in another
order. Motion to 1e-12 m over 12 ms, 800 steps: 2e-14 m is found.
Negative controls: one hub twice as heavy changes its own wheel and no other; wheels joined in another order than their
coordinates fail.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.grid import build_contact_grid
from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import PlateContact
from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.linearisation import Linearisation
from ancf_reduced.motion.plate_system import HubMass, PlateSystem, build_plate_system
from ancf_reduced.motion.vector_coordinates import side_by_side, with_reference_node
from ancf_reduced.plates.mesh import join_meshes
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.tire.mesh import RIM, Tire, build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import MeshError
from contracts.terrain import Plane, TerrainUnion
from contracts.terrain_ridges import HalfRound

COARSE = replace(thesis_preset(), quadrature=(3, 3, 2))
TIRES = [build_tire(replace(COARSE, phase=0.1 * k, rim_thickness=0.025 - 0.001 * k)) for k in range(6)]
MASSES = (15.0, 18.0, 21.0, 24.0, 27.0, 30.0)
GROUND = TerrainUnion(parts=(Plane(), HalfRound(radius=0.02, position=0.4))).pieces()
LAW = ContactLaw(stiffness=1000.0, damping=2.0, friction=0.6, slip_velocity=0.5)
GRAVITY = np.array([0.0, 0.0, -3.711])
END, STEP, TOLERANCE = 0.012, 1.5e-5, 1e-12


def system_of(tires: Sequence[Tire], masses: Sequence[float]) -> PlateSystem:
    """Some wheels as one system; their plates share material and integration points."""
    mesh = join_meshes([tire.mesh for tire in tires])
    model = build_plate_model(
        mesh, young_modulus=280e3, poisson_ratio=0.0, density=1500.0, quadrature=(3, 3, 2), viscosity=(0.0, 0.5)
    )
    contact = PlateContact(grid=build_contact_grid(mesh, mesh.plates_of(RIM), (10, 10)), terrain=GROUND, law=LAW)
    return build_plate_system(
        model,
        side_by_side([with_reference_node(tire.tie) for tire in tires]),
        gravity=GRAVITY,
        hubs=tuple(HubMass(mass=mass, inertia=0.1 * np.eye(3)) for mass in masses),
        external=(contact,),
    )


WHOLE = system_of(TIRES, MASSES)
ALONE = [system_of([tire], [mass]) for tire, mass in zip(TIRES, MASSES, strict=True)]


def start_of(system: PlateSystem, k: int) -> MotionState:
    """Wheel k at its own place, some on the ground and one above the ridge, rolling."""
    z = system.reference()
    v = np.cross([0.0, 1.0 + k, 0.0], z)
    rows = system.coordinates.position_rows
    z[rows] += [0.1 * k, 0.5 * k, 0.134 + 0.003 * k]
    v[rows] += [0.2 * k, 0.0, -0.1]
    return MotionState(time=0.0, z=z, v=v)


STARTS = [start_of(system, k) for k, system in enumerate(ALONE)]
START = MotionState(time=0.0, z=np.concatenate([s.z for s in STARTS]), v=np.concatenate([s.v for s in STARTS]))


def parts(values: np.ndarray) -> list[np.ndarray]:
    return np.split(values, 6)


def assert_close(one: np.ndarray, other: np.ndarray) -> None:
    assert np.abs(one - other).max() <= TOLERANCE * np.abs(other).max()


def test_forces_and_tangents_are_those_of_each_wheel() -> None:
    """Generalised forces on the mesh bit by bit, and the tangents plate by plate; in the vectors to rounding."""
    p, p_dot = WHOLE.coordinates.expand(START.z), WHOLE.coordinates.expand_rates(START.v)
    (contact,) = WHOLE.external
    forces = WHOLE.model.elastic_force(p), WHOLE.model.damping_force(p, p_dot), contact.force(p, p_dot, 0.0)
    tangents = WHOLE.model.elastic_tangents(p), *contact.tangents(p, p_dot, 0.0)
    touched = 0
    for k, alone in enumerate(ALONE):
        q, q_dot = parts(p)[k], parts(p_dot)[k]
        (own,) = alone.external
        theirs = alone.model.elastic_force(q), alone.model.damping_force(q, q_dot), own.force(q, q_dot, 0.0)
        for whole, single in zip(forces, theirs, strict=True):
            np.testing.assert_array_equal(parts(whole)[k], single)
        each = alone.model.elastic_tangents(q), *own.tangents(q, q_dot, 0.0)
        for whole, single in zip(tangents, each, strict=True):
            np.testing.assert_array_equal(parts(whole)[k], single)
        touched += bool(np.abs(theirs[2]).max() > 1.0)
        assert_close(parts(WHOLE.force(START.z, START.v))[k], alone.force(STARTS[k].z, STARTS[k].v))
    assert touched >= 3


def test_mass_and_tangent_are_block_diagonal() -> None:
    n = ALONE[0].coordinates.n_vectors
    stiffness, damping = Linearisation(WHOLE).stiffness_and_damping(START.z, START.v, 0.0)
    found = [(WHOLE.mass.toarray(), 1), (np.asarray(stiffness), 3), (np.asarray(damping), 3)]
    for k, alone in enumerate(ALONE):
        own = Linearisation(alone).stiffness_and_damping(STARTS[k].z, STARTS[k].v, 0.0)
        blocks = alone.mass.toarray(), *(np.asarray(matrix) for matrix in own)
        for (whole, size), block in zip(found, blocks, strict=True):
            rows = slice(size * k * n, size * (k + 1) * n)
            assert_close(whole[rows, rows], block)
            whole[rows, rows] = 0.0
    assert all(not whole.any() for whole, _ in found)


def moved(system: PlateSystem, start: MotionState) -> np.ndarray:
    """Vectors (3, n_vectors, 3) at three times."""
    return np.array([state.z for state in integrate_explicit(system, start, END * np.array([0.3, 0.6, 1.0]), STEP)])


@pytest.fixture(scope="module")
def together() -> list[np.ndarray]:
    return np.split(moved(WHOLE, START), 6, axis=1)


def test_each_wheel_moves_as_alone(together: list[np.ndarray]) -> None:
    for k, alone in enumerate(ALONE):
        single = moved(alone, STARTS[k])
        assert np.abs(together[k] - single).max() < TOLERANCE
        hub = alone.coordinates.triads[0, 0]
        assert np.abs(single[-1, hub] - STARTS[k].z[hub]).max() > 1e-3


def test_negative_control_a_heavier_hub_changes_its_own_wheel(together: list[np.ndarray]) -> None:
    heavier = np.split(moved(system_of(TIRES, (*MASSES[:2], 42.0, *MASSES[3:])), START), 6, axis=1)
    differences = [float(np.abs(a - b).max()) for a, b in zip(heavier, together, strict=True)]
    assert differences[2] > 1e-6
    assert max(d for k, d in enumerate(differences) if k != 2) < TOLERANCE


def test_negative_control_wheels_in_another_order() -> None:
    """The first wheel's plates with the last wheel's coordinates are not in equilibrium where they should be."""
    swapped = system_of([TIRES[5], *TIRES[1:5], TIRES[0]], MASSES)
    assert np.abs(parts(swapped.force(START.z, START.v))[0] - parts(WHOLE.force(START.z, START.v))[0]).max() > 1.0


def test_nothing_to_join_is_refused() -> None:
    with pytest.raises(MeshError, match="one mesh or more"):
        join_meshes([])


def test_wheels_at_one_place_share_no_node() -> None:
    """Unlike patches given to `build_plate_mesh`."""
    mesh = TIRES[0].mesh
    assert len(np.unique(join_meshes([mesh, mesh]).elements)) == 2 * len(mesh.points)
