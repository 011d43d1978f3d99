"""Equations of motion of a mesh of plates with held and tied nodes and rigid reference nodes.

    M z'' + Q_s(z) + Q_v(z, z') = Q_g + Q_e + sum over triads of the multipliers' forces           (thesis eq. 2.26)

M is constant. A reference node that moves with a rigid hub obeys a_i . a_j = delta_ij for its gradients a_1, a_2, a_3,
six equations; the hub's own mass and inertia enter M, since the kinetic energy of a rigid body is that of its reference
node with the constant matrix `hub_mass` as long as the equations hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.motion.vector_coordinates import VectorCoordinates
from ancf_reduced.plates.assembly import plate_rows
from ancf_reduced.plates.mass import gravity_force, mass_blocks
from ancf_reduced.plates.model import PlateModel
from contracts.errors import InputError

__all__ = ["ExternalForce", "HubMass", "PlateSystem", "build_plate_system", "hub_mass"]

FloatArray = NDArray[np.float64]


class ExternalForce(Protocol):
    """Forces on a mesh of plates that depend on its motion: contact, drive."""

    @property
    def depends_on_rates(self) -> bool:
        """Whether the force depends on the rates, or on the coordinates alone."""

    def force(self, p: FloatArray, v: FloatArray, time: float) -> FloatArray:
        """Generalised force (n_nodes, 4, 3) on the mesh at coordinates p and rates v (n_nodes, 4, 3), time [s]."""

    def tangents(self, p: FloatArray, v: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
        """Minus its derivatives by p and by v, plate by plate, (n_plates, 48, 48) each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HubMass:
    """Rigid body that moves with a reference node, its centre of mass at the node.

    Attributes
    ----------
    mass : [kg]
    inertia : (3, 3) float [kg m^2], about the node, in the axes of the reference configuration
    """

    mass: float
    inertia: FloatArray

    def __post_init__(self) -> None:
        if not self.mass > 0.0:
            raise InputError("hub mass", f"{self.mass:g} kg", "must be > 0", "leave the hub out for a massless one")
        moments = np.linalg.eigvalsh(self.inertia)
        if moments[0] < 0.0 or moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-9):
            rule = "must have principal moments >= 0, none above the sum of the others"
            raise InputError("hub inertia", f"{moments} kg m^2", rule, "check the axes and the unit")


def hub_mass(hub: HubMass) -> FloatArray:
    """Mass matrix (4, 4) of a rigid body in the vectors r, r_x, r_y, r_z of its reference node [kg, kg m^2].

    The gradients' part is the second moment of mass J = tr(I) / 2 - I, so that sum J_ij a_i' . a_j' / 2 is the energy
    of the spin.

    Verified by tests/unit/test_ancf_rigid_hub.py.
    """
    matrix = np.zeros((4, 4))
    matrix[0, 0] = hub.mass
    matrix[1:, 1:] = 0.5 * np.trace(hub.inertia) * np.eye(3) - hub.inertia
    return matrix


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateSystem:
    """Mesh, coordinates and constant loads.

    Attributes
    ----------
    model : plates
    coordinates : independent vectors
    mass : (n_vectors, n_vectors) sparse [kg, kg m, kg m^2], the same for each direction
    dead_load : (n_vectors, 3) float [N, N m], constant generalised force: weight of plates and hubs
    external : contact, drive and the like
    """

    model: PlateModel
    coordinates: VectorCoordinates
    mass: csc_array
    dead_load: FloatArray
    external: tuple[ExternalForce, ...] = ()

    def force(self, z: FloatArray, v: FloatArray, time: float = 0.0) -> FloatArray:
        """All applied minus all internal generalised forces, (n_vectors, 3): M z'' where nothing is constrained."""
        p = self.coordinates.expand(z)
        force = self.position_force(p, time)
        return force + self.rate_force(p, v, time) if self.depends_on_rates else force

    def position_force(self, p: FloatArray, time: float) -> FloatArray:
        """The part of `force` that does not know rates, (n_vectors, 3), from structure coordinates (n_nodes, 4, 3)."""
        total = -self.model.elastic_force(p)
        for external in self.external:
            if not external.depends_on_rates:
                total += external.force(p, np.zeros_like(p), time)
        return self.coordinates.reduce(total) + self.dead_load

    def rate_force(self, p: FloatArray, v: FloatArray, time: float) -> FloatArray:
        """The rest of `force`, (n_vectors, 3)."""
        p_dot = self.coordinates.expand_rates(v)
        total = -self.model.damping_force(p, p_dot) if self.is_damped else np.zeros_like(p)
        for external in self.external:
            if external.depends_on_rates:
                total += external.force(p, p_dot, time)
        return self.coordinates.reduce(total)

    @property
    def is_damped(self) -> bool:
        """Whether the plates have a viscosity."""
        return any(self.model.viscosity)

    @property
    def depends_on_rates(self) -> bool:
        """Whether any force depends on the rates."""
        return self.is_damped or any(external.depends_on_rates for external in self.external)

    def elastic_energy(self, z: FloatArray) -> float:
        """Strain energy [J]."""
        return self.model.elastic_energy(self.coordinates.expand(z))

    def kinetic_energy(self, v: FloatArray) -> float:
        """Of plates and hubs [J]."""
        return 0.5 * float(np.sum(v * (self.mass @ v)))

    def dead_energy(self, z: FloatArray) -> float:
        """Potential of the dead load, zero at the origin [J]."""
        return -float(np.sum(self.dead_load * z))

    def reference(self) -> FloatArray:
        """Independent vectors (n_vectors, 3) [m, -] of the stress-free configuration."""
        return self.coordinates.restrict(self.model.mesh.reference_coordinates())


def build_plate_system(
    model: PlateModel,
    coordinates: VectorCoordinates,
    *,
    gravity: FloatArray | None = None,
    hubs: tuple[HubMass | None, ...] = (),
    external: tuple[ExternalForce, ...] = (),
) -> PlateSystem:
    """Mass matrix and weight in the independent vectors.

    Parameters
    ----------
    model, coordinates : plates, and what holds them
    gravity : (3,) float [m/s^2], e.g. (0, 0, -3.711)
    hubs : for each triad of the coordinates its rigid hub, None for a massless one; empty for none at all
    external : contact, drive and the like

    Raises
    ------
    InputError
        If hubs are given, but not one for each triad.
    """
    triads = coordinates.triads
    if hubs and len(hubs) != len(triads):
        raise InputError(
            "hubs", len(hubs), f"needs one for each of {len(triads)} reference nodes", "give None for none"
        )
    acceleration = np.zeros(3) if gravity is None else np.asarray(gravity, dtype=np.float64)
    rows, blocks = plate_rows(model.mesh, components=1), mass_blocks(model)
    i, j = np.repeat(rows, 16, axis=1).ravel(), np.tile(rows, (1, 16)).ravel()
    size = 4 * len(model.mesh.points)
    M = csc_array((blocks.ravel(), (i, j)), shape=(size, size))
    mass = (coordinates.map.T @ M @ coordinates.map).tolil()
    load = coordinates.reduce(gravity_force(model, acceleration))
    for triad, hub in zip(triads, hubs, strict=False):
        if hub is not None:
            kept = np.flatnonzero(triad >= 0)
            mass[np.ix_(triad[kept], triad[kept])] += hub_mass(hub)[np.ix_(kept, kept)]
            if triad[0] >= 0:
                load[triad[0]] += hub.mass * acceleration
    return PlateSystem(model=model, coordinates=coordinates, mass=csc_array(mass), dead_load=load, external=external)
