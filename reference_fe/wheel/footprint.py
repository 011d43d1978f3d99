"""Footprint of a wheel on a plane: where and how hard it presses, from displacements that were solved before.

Pressures at quadrature points of a facet that is touched in part alternate from point to point, and thin metal touches
along lines. Their forces p dA do not: shared among the places of a grid of fixed spacing they make a map whose load and
centre of pressure are exact, and which settles as the mesh is refined.
Verified by tests/verification/test_fe_footprint.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.footprint import Footprint
from contracts.mesh import TaggedMesh
from reference_fe.contact.law import ramped_pressure
from reference_fe.contact.nodal_pressure import nodal_pressure
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.contact.obstacles import Plane
from reference_fe.contact.patch import contact_faces, facet_areas
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.problem import ground_contact

__all__ = ["footprint", "pressure_at_nodes"]

Array = NDArray[np.float64]


def footprint(mesh: TaggedMesh, displacement: Array, load_case: WheelLoadCase, deflection: float) -> Footprint:
    """Footprint of a wheel, or of half of one, on a plane.

    Parameters
    ----------
    mesh : as solved
    displacement : of its nodes (n_points, 3) [m]
    load_case : of the run that found it; penalty contact on a plane, a stiffness given
    deflection : there [m]

    Raises
    ------
    InputError
        For another ground or contact method, whose pressures do not follow from the gap.
    """
    contact = ground_contact(mesh, load_case)
    _, points, areas, pressure = _pressed(mesh, displacement, contact, deflection)
    on = np.nonzero(pressure)
    normal, forward, _ = contact.axes()
    place, pressure = points[on] @ np.stack([forward, np.cross(normal, forward)], axis=1), pressure[on]
    force = pressure * areas[on]
    if "symmetry" in mesh.faces:
        place = np.concatenate([place, place * [1.0, -1.0]])
        force, pressure = np.tile(force, 2), np.tile(pressure, 2)
    return Footprint(place=place, force=force, pressure=pressure)


def pressure_at_nodes(mesh: TaggedMesh, displacement: Array, load_case: WheelLoadCase, deflection: float) -> Array:
    """Contact pressure on the ground at every node of the mesh (n_points,) [Pa], see `contact.nodal_pressure`; with
    the arguments and errors of `footprint`.
    """
    contact = ground_contact(mesh, load_case)
    facets, _, areas, pressure = _pressed(mesh, displacement, contact, deflection)
    return nodal_pressure(len(mesh.points), facets, areas, pressure)[0]


def _pressed(
    mesh: TaggedMesh, displacement: Array, contact: ObstacleContact, deflection: float
) -> tuple[NDArray[np.int64], Array, Array, Array]:
    """Facets (f, n) that may touch; their quadrature points (f, q, 3), areas and pressures (f, q)."""
    _require_penalty(contact)
    facets = contact_faces(mesh, contact.faces)
    shape, areas = facet_areas(mesh, facets, contact.gauss_points)
    points = np.einsum("sn,fnk->fsk", shape, (mesh.points + displacement)[facets])
    gap = contact.gap(points.reshape(-1, 3), deflection).reshape(areas.shape)
    stiffness, pressure = contact.stiffness, np.zeros_like(gap)
    assert stiffness is not None
    on = gap < contact.ramp
    pressure[on] = [ramped_pressure(float(g), stiffness, contact.ramp)[0] for g in gap[on]]
    return facets, points, areas, pressure


def _require_penalty(contact: ObstacleContact) -> None:
    hint = "leave the footprint out"
    if not isinstance(contact.obstacle, Plane):
        raise InputError("footprint", type(contact.obstacle).__name__, "is found on a plane only", hint)
    if contact.closes_gaps or contact.stiffness is None:
        what = contact.method.value if contact.closes_gaps else "a stiffness of each facet"
        raise InputError("footprint", what, "keeps pressures that no gap tells", hint)
