"""The benchmark's load cases, each from a builder's name and its two numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.peer_codes.case import FRONT, REAR, Description, LoadCase
from contracts.materials import TI_6AL_4V
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.cells.orientation import curved_axis_first
from reference_fe.contact.patch import contact_faces, facet_samples
from reference_fe.verification.structured_hexahedra import block_mesh
from reference_fe.wheel.problem import CONTACT_FACES

__all__ = ["from_description", "ground", "half_cylinder", "wheel"]

GROUND_STIFFNESS = 1e11
"""Penalty of the plane [N/m^3], that of the built-in study's contacts."""


def half_cylinder(around: int, across: int) -> LoadCase:
    """Clamped half cylinder, R 140 mm, t 2 mm, W 100 mm, its outer crown line pressed down by 20 mm.

    Source: contracts/published/halfcyl_crown_reaction.csv.
    """

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, r = np.pi * X[:, 0], 0.140 + 0.002 * (X[:, 2] - 0.5)
        return np.column_stack([r * np.cos(angle), r * np.sin(angle), 0.1 * X[:, 1]])

    mesh = block_mesh((around, across, 1), mapping)
    steel = replace(TI_6AL_4V, name="steel", young_modulus=2.1e11, poisson_ratio=0.3)
    return LoadCase(
        mesh=_split(mesh, "z1", lambda x: x[:, 1] > 0.0),
        material=steel,
        held_faces=("x0", "x1"),
        held_parts=(),
        symmetry=None,
        component=1,
        travel=-0.020,
        steps=4,
        force_factor=-1.0,
    )


def wheel(element_size: float, axial_size: float, orientation_deg: float = 30.0) -> LoadCase:
    """Half the ExoMars wheel, hub held, on the front lower edge of the grouser at ``orientation_deg``, raised by 20 mm.

    The edge stands for the ground: every mesh has it at the same place, and no code needs contact to press on it.
    """
    mesh = _wheel_mesh(element_size, axial_size, orientation_deg)
    foot = 0.5 * exomars_hoops().grousers.thickness
    mesh = _split(mesh, "grouser_outer", lambda x: (x[:, 2] < 0.0) & (np.abs(x[:, 0]) < 1.001 * foot))
    return _pressed(mesh, travel=0.020, steps=4)


def ground(element_size: float, axial_size: float, orientation_deg: float = 15.0) -> LoadCase:
    """Half the ExoMars wheel, hub held, between two grousers on a plane that is raised by 5 mm from first touch.

    By no more, because CalculiX needs ever smaller increments beyond.
    """
    mesh = _wheel_mesh(element_size, axial_size, orientation_deg)
    faces = tuple(face for face in CONTACT_FACES if face in mesh.faces)
    points, _ = facet_samples(mesh.points, contact_faces(mesh, faces))
    return replace(
        _pressed(mesh, travel=0.005, steps=1),
        ground_faces=faces,
        ground_level=float(points[:, 2].min()),
        ground_stiffness=GROUND_STIFFNESS,
    )


def _pressed(mesh: TaggedMesh, *, travel: float, steps: int) -> LoadCase:
    """Half the wheel, its hub held, pressed upwards [m]."""
    return LoadCase(
        mesh=mesh,
        material=TI_6AL_4V,
        held_faces=(),
        held_parts=("outer_hub",),
        symmetry="symmetry",
        component=2,
        travel=travel,
        steps=steps,
        force_factor=2.0,
    )


def _wheel_mesh(element_size: float, axial_size: float, orientation_deg: float) -> TaggedMesh:
    mesh = build_mesh(exomars_hoops(), element_size=element_size, axial_size=axial_size, parts="flexible")
    mesh = curved_axis_first(mesh, straight=np.array([0.0, 1.0, 0.0]))
    return _turn(mesh, np.deg2rad(orientation_deg))


def _turn(mesh: TaggedMesh, angle: float) -> TaggedMesh:
    """Turn about the y axis so that what stood at ``angle`` from -z towards x comes to stand at -z."""
    c, s = np.cos(angle), np.sin(angle)
    return replace(mesh, points=mesh.points @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]).T)


def _split(mesh: TaggedMesh, face: str, part: Callable[[NDArray[np.float64]], NDArray[np.bool_]]) -> TaggedMesh:
    """Rename the facets of ``face`` whose middle fulfils ``part``: ``line_front`` at x > 0, else ``line_rear``."""
    middle = mesh.points[mesh.facets].mean(axis=1)
    mine = (mesh.facet_tags == mesh.faces[face]) & part(middle)
    first = max(mesh.faces.values()) + 1
    tags = np.where(mine, np.where(middle[:, 0] > 0.0, first, first + 1), mesh.facet_tags).astype(np.int32)
    return replace(mesh, facet_tags=tags, faces=dict(mesh.faces) | {FRONT: first, REAR: first + 1})


def from_description(description: Description) -> LoadCase:
    """The case from its builder's name and arguments."""
    name, *arguments = description
    build: Callable[..., LoadCase] = {"half_cylinder": half_cylinder, "wheel": wheel, "ground": ground}[name]
    return build(*arguments)
