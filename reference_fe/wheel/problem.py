"""The static problem of a wheel on the ground: what is held, what may touch what, where the ground first touches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.frames import ground_direction_h
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from reference_fe.cells.orientation import curved_axis_first
from reference_fe.contact.inner import ContactPair, InnerContact
from reference_fe.contact.inner_pairs import wheel_contact_pairs
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.contact.obstacles import touch_level
from reference_fe.contact.patch import contact_faces, facet_samples
from reference_fe.contact.soil_ground import SoilContact
from reference_fe.material.thermal_state import solve_thermal_state
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.wheel.case import WheelLoadCase

__all__ = ["WheelProblem", "ground_axes", "hub_supports", "wheel_problem"]

CONTACT_FACES = ("tire_outer", "tread_outer", "grouser_outer")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WheelProblem:
    """A wheel ready to be solved, at its own temperature, the ground at first touch.

    Attributes
    ----------
    mesh : the mesh, its cells turned so that their curved axis comes first
    problem : the static problem; its control parameter is the ground's rise [m]
    contact : the ground
    flexible : names of the parts that deform
    facets : facets that may touch the ground, (n_facets, nodes)
    normal, tangent : unit normal of the ground, to the wheel, and its forward direction, (dim,) [-]
    sides : 2 for a half-width mesh, whose loads and areas count twice; else 1
    """

    mesh: TaggedMesh
    problem: StaticProblem
    contact: ObstacleContact
    flexible: tuple[str, ...]
    facets: NDArray[np.int64]
    normal: NDArray[np.float64]
    tangent: NDArray[np.float64]
    sides: float


def wheel_problem(mesh: TaggedMesh, materials: Mapping[str, Material], load_case: WheelLoadCase) -> WheelProblem:
    """Build the problem of one load case; parameters as in `wheel.solve_wheel`."""
    mesh = curved_axis_first(mesh, straight=np.array([0.0, 1.0, 0.0]))
    rigid = tuple(part for part in load_case.rigid_parts if part in mesh.parts)
    flexible = {part: materials[part] for part in mesh.parts if part not in rigid and part in materials}
    half_width = "symmetry" in mesh.faces
    _check_symmetry(load_case, prismatic=half_width or mesh.dim == 2, planar=mesh.dim == 2)
    supports = hub_supports(mesh, rigid, materials, load_case)
    if half_width:
        supports.append(Support(faces=("symmetry",), components=(1,)))
    domain = Domain.from_tagged(mesh)
    discretisation = Discretisation(law=load_case.law, gauss_points=load_case.gauss_points[: mesh.dim])
    held = load_case.transverse_constraint
    expanded, shape = None, mesh
    if any(material.thermal_strain for material in materials.values()):
        expanded = solve_thermal_state(domain, flexible, supports, discretisation, load_case.newton, held)
        shape = replace(mesh, points=mesh.points + expanded.nodal_displacement())
    contact = ground_contact(shape, load_case)
    inner = _inner_contact(mesh, load_case)
    problem = StaticProblem(
        domain,
        flexible,
        supports,
        contact=contact,
        surfaces=[inner] if inner else [],
        discretisation=discretisation,
        transverse_constraint=held,
    )
    if expanded is not None:
        problem.u.x.array[:] = expanded.u.x.array
        problem.residual()
        problem.accept()  # friction counts slip from here
    axes, down = _axes(mesh), ground_direction_h(np.deg2rad(load_case.orientation_deg))
    return WheelProblem(
        mesh=mesh,
        problem=problem,
        contact=contact,
        flexible=tuple(flexible),
        facets=contact_faces(mesh, contact.faces),
        normal=np.array(contact.normal),
        tangent=np.array([-down[2], 0.0, down[0]])[axes],
        sides=2.0 if half_width else 1.0,
    )


def _axes(mesh: TaggedMesh) -> list[int]:
    """Components of the wheel frame that the mesh has."""
    return [0, 2] if mesh.dim == 2 else [0, 1, 2]


def ground_contact(shape: TaggedMesh, load_case: WheelLoadCase) -> ObstacleContact:
    """The obstacle where it just touches the wheel, which has this shape."""
    axes = _axes(shape)
    normal, along = ground_axes(ground_direction_h(np.deg2rad(load_case.orientation_deg)), load_case)
    faces = tuple(face for face in CONTACT_FACES if face in shape.faces)
    if load_case.faces is not None:
        faces = load_case.faces.ground
    points, _ = facet_samples(shape.points, contact_faces(shape, faces))
    where: dict[str, Any] = {
        "faces": faces,
        "normal": tuple(normal[axes].tolist()),
        "along": tuple(along[axes].tolist()),
        "obstacle": load_case.obstacle,
        "distance_at_touch": -touch_level(load_case.obstacle, points @ along[axes], points @ normal[axes]),
        "stiffness": load_case.contact_stiffness,
        "ramp": load_case.contact_ramp,
        "method": load_case.contact_method,
        "friction": load_case.friction,
        "travel": load_case.travel,
    }
    if load_case.soil is None:
        return ObstacleContact(**where)
    modulus, exponent = load_case.soil
    return SoilContact(modulus=modulus, exponent=exponent, **where)


def ground_axes(down: NDArray[np.float64], load_case: WheelLoadCase) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit normal of the ground, to the wheel, and the obstacle's s axis, (3,) each; the wheel stands on ``down``."""
    up, forward, left = -down, np.array([-down[2], 0.0, down[0]]), np.array([0.0, 1.0, 0.0])
    camber, yaw = np.deg2rad(load_case.camber_deg), np.deg2rad(load_case.obstacle.yaw_deg)
    normal, across = np.cos(camber) * up - np.sin(camber) * left, np.cos(camber) * left + np.sin(camber) * up
    return normal, np.cos(yaw) * forward + np.sin(yaw) * across


def _check_symmetry(load_case: WheelLoadCase, *, prismatic: bool, planar: bool) -> None:
    """Refuse a half-width or planar wheel on an obstacle that is not symmetric about its mid-plane."""
    turned, rule = (
        load_case.camber_deg or load_case.obstacle.yaw_deg,
        "breaks the symmetry of a half-width or planar mesh",
    )
    if prismatic and turned:
        raise InputError("camber or yaw", f"{turned:g} deg", rule, "mesh the full width")
    for way in load_case.travel.ways if load_case.travel is not None else ():
        if planar and way.turns:
            raise InputError("travel", way.value, "turns what is solved in one plane", "mesh the wheel")
        if prismatic and not way.mirrored:
            raise InputError("travel", way.value, rule, "mesh the full width")


def _inner_contact(mesh: TaggedMesh, load_case: WheelLoadCase) -> InnerContact | None:
    """What holds the wheel's parts off each other, or None."""
    if load_case.faces is None:
        pairs = wheel_contact_pairs(mesh)
    else:
        pairs = tuple(ContactPair(slave=slave, master=master) for slave, master in load_case.faces.pairs)
    pairs = pairs if load_case.inner_contact else ()
    return InnerContact(pairs=pairs, stiffness=load_case.inner_contact_stiffness) if pairs else None


def hub_supports(
    mesh: TaggedMesh, rigid: tuple[str, ...], materials: Mapping[str, Material], load_case: WheelLoadCase
) -> list[Support]:
    """What holds the wheel, expanded as its material is: its rigid parts, and the bore of an elastic inner hub."""
    stretch = {part: materials[part].thermal_stretch if part in materials else 1.0 for part in mesh.parts}
    supports = [Support(parts=(part,), stretch=stretch[part]) for part in rigid]
    if load_case.faces is not None:
        if load_case.faces.held:
            supports.append(Support(faces=load_case.faces.held))
    elif "inner_hub" in mesh.parts and "inner_hub" not in rigid:
        supports.append(Support(faces=("inner_hub_bore",), stretch=stretch["inner_hub"]))
    if not supports:
        rule = "must hold the wheel: the mesh has neither of them nor an inner hub"
        raise InputError("rigid parts", ", ".join(rigid) or "none", rule, "name a part of the mesh, e.g. outer_hub")
    return supports
