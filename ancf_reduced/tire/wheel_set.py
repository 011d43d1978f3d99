"""Equal ANCF tires as one system of plates, as a vehicle takes them (thesis section 2.5.3: one subsystem, one mesh).

Implements `contracts.nodal_tires.NodalTires`. Verified by tests/unit/test_ancf_wheel_set.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.grid import build_contact_grid
from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import PlateContact
from ancf_reduced.motion.block_reduction import BlockReduction, block_reduction
from ancf_reduced.motion.plate_system import PlateSystem, build_plate_system
from ancf_reduced.motion.vector_coordinates import VectorCoordinates, side_by_side, with_reference_node
from ancf_reduced.plates.mass import gravity_force
from ancf_reduced.plates.mesh import join_meshes
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.tire.mesh import RIM, Tire
from ancf_reduced.tire.wheel_rig import damped_model
from contracts.errors import InputError
from contracts.nodal_tires import TireContacts, TireEnergies
from contracts.terrain import Terrain

__all__ = ["THESIS_LAW", "WheelSet", "wheel_set"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

THESIS_LAW = ContactLaw(stiffness=1000.0, damping=100.0, friction=0.6)
"""k, c and mu of thesis section 3.3."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelSet:
    """Equal tires.

    Attributes
    ----------
    tire : one of them, with its damping
    one : independent vectors of one tire, the reference node's last
    system : plates of all; without weight
    contact : their contact with the ground
    reduction : from plates' matrices to blocks of one tire's vectors
    mass, weight : see `contracts.nodal_tires.NodalTires`
    """

    tire: Tire
    one: VectorCoordinates
    system: PlateSystem
    contact: PlateContact
    reduction: BlockReduction
    mass: FloatArray
    weight: FloatArray

    @property
    def n_wheels(self) -> int:
        """Tires."""
        return len(self.system.coordinates.triads)

    @property
    def position_rows(self) -> IntArray:
        """Rows of one tire's vectors that are positions, (n_positions,) int."""
        return self.one.position_rows

    @property
    def pattern(self) -> IntArray:
        """Row and column vector of each block of `tangents`, (n_blocks, 2)."""
        return self.reduction.pattern

    def reference(self) -> FloatArray:
        """Vectors (n, 3) of a stress-free tire in the wheel frame."""
        return self.one.restrict(self.tire.mesh.reference_coordinates())

    def force(self, z: FloatArray, v: FloatArray) -> FloatArray:
        """Generalised forces (n_wheels, n, 3)."""
        return self.system.force(z.reshape(-1, 3), v.reshape(-1, 3)).reshape(z.shape)

    def tangents(self, z: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Blocks (n_wheels, n_blocks, 3, 3) of minus the derivatives of `force`."""
        p, p_dot = self.node_coordinates(z), self.node_rates(v)
        model = self.system.model
        stiffness = model.elastic_tangents(p)
        by_contact, damping = self.contact.tangents(p, p_dot)
        stiffness += by_contact
        if self.system.is_damped:
            by_position, by_rate = model.damping_tangents(p, p_dot)
            stiffness += by_position
            damping += by_rate
        return self.reduction(stiffness), self.reduction(damping)

    def step_matrix(self, z: FloatArray, v: FloatArray, weights: tuple[float, float]) -> FloatArray:
        """Blocks (n_wheels, n_blocks, 3, 3) of a sum of both tangents, without the plates' damping by z.

        That part costs as much as the others together and is of the order of viscosity times rate.
        """
        p, (w_q, w_v) = self.node_coordinates(z), weights
        matrices = self.system.model.step_matrices(p, weights)
        by_position, by_rate = self.contact.tangents(p, self.node_rates(v))
        by_position *= w_q
        by_rate *= w_v
        matrices += by_position
        matrices += by_rate
        return self.reduction(matrices)

    def node_coordinates(self, z: FloatArray) -> FloatArray:
        """Structure coordinates (n_wheels n_nodes, 4, 3) [m, -] from z (n_wheels, n, 3), wheel after wheel."""
        return self.system.coordinates.expand(z.reshape(-1, 3))

    def node_rates(self, v: FloatArray) -> FloatArray:
        """Their rates [m/s, 1/s], from v (n_wheels, n, 3)."""
        return self.system.coordinates.expand_rates(v.reshape(-1, 3))

    def contacts(self, z: FloatArray, v: FloatArray) -> TireContacts:
        """What the ground does to each wheel; z, v (n_wheels, n, 3) [m, -], [m/s, 1/s], world frame."""
        patch = self.contact.patch(self.node_coordinates(z), self.node_rates(v))
        wheel, hubs = patch.plates * self.n_wheels // self.contact.grid.n_plates, z[:, -4]
        n, N = self.n_wheels, patch.normal_force
        about = np.cross(patch.position - hubs[wheel], patch.force)
        sizes = np.linalg.norm(patch.slip, axis=-1)

        def summed(values: FloatArray) -> FloatArray:
            out = np.zeros((n, *values.shape[1:]))
            np.add.at(out, wheel, values)
            return out

        def largest(values: FloatArray) -> FloatArray:
            out = np.zeros(n)
            np.maximum.at(out, wheel, values)
            return out

        load = summed(N)
        share = 1.0 / np.where(load > 0.0, load, 1.0)
        centre = summed(N[:, None] * (patch.position - hubs[wheel])) * share[:, None]
        return TireContacts(
            force=summed(patch.force),
            moment=summed(about),
            load=load,
            patch_point=hubs + centre,
            penetration=summed(N * patch.penetration) * share,
            largest_pressure=largest(patch.pressure),
            slip=np.column_stack([summed(N * sizes) * share, largest(sizes)]),
        )

    def energies(self, z: FloatArray, v: FloatArray) -> TireEnergies:
        """Stored [J] and dissipated [W] by all tires; z, v as `contacts`."""
        p, p_dot, system = self.node_coordinates(z), self.node_rates(v), self.system
        power = self.contact.power(p, p_dot)
        spent = float(np.sum(system.model.damping_force(p, p_dot) * p_dot)) if system.is_damped else 0.0
        return TireEnergies(
            kinetic=system.kinetic_energy(v.reshape(-1, 3)),
            strain=system.model.elastic_energy(p),
            contact=power.energy,
            damping=spent,
            contact_damping=power.damping,
            friction=power.friction,
        )


def wheel_set(
    tire: Tire, terrain: Terrain, n_wheels: int = 6, *, law: ContactLaw = THESIS_LAW, damping_ratio: float = 0.05
) -> WheelSet:
    """Equal tires on one terrain.

    Parameters
    ----------
    tire : from `tire.mesh.build_tire`
    terrain : ground at rest
    n_wheels : one or more
    law : contact of each point
    damping_ratio : of the first mode of a tire with its hub held, see `wheel_rig.damped_model` [-]

    Raises
    ------
    InputError
        For no wheels, or numbers out of range.
    """
    if n_wheels < 1:
        raise InputError("wheels", n_wheels, "must be 1 or more", "give 6 for the rover")
    tire = replace(tire, model=damped_model(tire, damping_ratio))
    preset, one = tire.preset, with_reference_node(tire.tie)
    mesh = join_meshes([tire.mesh] * n_wheels)
    model = build_plate_model(
        mesh,
        young_modulus=preset.young_modulus,
        poisson_ratio=preset.poisson_ratio,
        density=preset.density,
        quadrature=preset.quadrature,
        viscosity=tire.model.viscosity,
    )
    grid = build_contact_grid(mesh, mesh.plates_of(RIM), preset.contact_points, preset.contact_layout)
    contact = PlateContact(grid=grid, terrain=terrain.pieces(), law=law)
    system = build_plate_system(model, side_by_side([one] * n_wheels), external=(contact,))
    mass = build_plate_system(tire.model, one).mass.toarray()
    return WheelSet(
        tire=tire,
        one=one,
        system=system,
        contact=contact,
        reduction=block_reduction(tire.mesh, one),
        mass=mass,
        weight=np.ascontiguousarray(one.reduce(gravity_force(tire.model, np.array([1.0, 0.0, 0.0])))[:, 0]),
    )
