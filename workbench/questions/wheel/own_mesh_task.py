"""Task that reads a wheel's mesh from another program, or meshes its solids, and checks it.

Verified by tests/end_to_end/test_own_mesh.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.measures import mesh_quality, mesh_volume
from geometry.own_mesh.cell_checks import solid_cells
from geometry.own_mesh.file_mesh import FileMesh
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.repeats import least_reach, require_repeats
from geometry.own_mesh.roles import Roles
from geometry.own_mesh.step_body import StepBody, named_faces
from geometry.own_mesh.step_files import STEP_ENDINGS, read_step
from geometry.own_mesh.tetrahedron_quality import scaled_jacobians_of_tetrahedra
from geometry.own_mesh.wheel_checks import outer_radius
from geometry.own_mesh.wheel_mesh import wheel_of_file
from workbench.execution.fingerprint import file_sha256
from workbench.execution.result_files import write_result
from workbench.questions.wheel.mesh_file import MESH, OWN_FILE, write_mesh
from workbench.study.own_mesh import placement_and_roles, sizes_and_rules

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["faces_told", "measure_own", "own_content", "read", "require_rover_wheel", "wheel_in"]

_ROUND = 1e-3
"""Largest difference of a rover's wheel from a circle of its radius, over the radius [-]."""


def read(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Read one mesh, or mesh solids, and check it: ``mesh.npz``, ``result.json``."""
    path = needs[OWN_FILE]
    if file_sha256(path) != inputs["sha256"]:
        raise InputError("mesh file", path, "has changed since the run began", "run the command again")
    content = own_content(path, inputs["mesh"])
    mesh = wheel_in(content, inputs["mesh"], path)
    progress(0.7)
    measured = measure_own(mesh, content, inputs["mesh"]["ground"], inputs["densities"])
    if "rover_radius" in inputs:
        require_rover_wheel(measured["outer_radius"], measured["least_reach"], inputs["rover_radius"])
    write_mesh(mesh, out / MESH)
    write_result(out, measured)
    progress(1.0)
    return 0


def own_content(path: Path, section: Mapping[str, Any]) -> FileMesh | StepBody:
    """What the file of a section [mesh], given as JSON, holds; raises InputError for a file that cannot be read."""
    if path.suffix.lower() not in STEP_ENDINGS:
        return read_mesh_file(path)
    with _at_its_key(path):
        return read_step(path, sizes_and_rules(dict(section))[0])


def wheel_in(content: FileMesh | StepBody, section: Mapping[str, Any], path: Path) -> TaggedMesh:
    """The wheel of a section [mesh]; raises InputError with the key for names that make no wheel."""
    placement, roles = placement_and_roles(dict(section))
    with _at_its_key(path):
        if isinstance(content, StepBody):
            rules = sizes_and_rules(dict(section))[1]
            _require_joined(content, roles, content.numbers_of(rules, placement))
            content = content.named(rules, placement)
        mesh = wheel_of_file(content, roles, placement, section["factor"])
        require_repeats(mesh, section.get("repeats", 1))
        return mesh


def faces_told(body: StepBody, section: Mapping[str, Any], path: Path) -> list[str]:
    """A line for each name of [mesh.faces]: the faces it stands for; raises InputError for one that has none."""
    placement, _ = placement_and_roles(dict(section))
    sizes, rules = sizes_and_rules(dict(section))
    with _at_its_key(path):
        return named_faces(body, body.numbers_of(rules, placement), sizes.part_of)


def _require_joined(body: StepBody, roles: Roles, numbers: Mapping[str, tuple[int, ...]]) -> None:
    """Raise InputError for solids of a STEP file that touch nothing that hangs on what is held."""
    held = {number for name in roles.held_faces for number in numbers.get(name, ())}
    held |= {int(name) for name in roles.held_faces if name.isdecimal() and name not in numbers}
    of_parts = {solid for part in roles.held_parts for solid in roles.parts[part]}
    body.require_joined(of_parts | {face.solid for face in body.faces if face.number in held})


@contextmanager
def _at_its_key(path: Path) -> Iterator[None]:
    """Add the study's key to what is wrong."""
    try:
        yield
    except InputError as error:
        what, value = (error.what, error.value or path.name) if error.what == "mesh file" else (error.what, error.value)
        place = f"mesh.{error.key}: " if error.key not in ("", "file") else ""
        raise InputError(place + what, value, error.rule, error.hint) from error


def require_rover_wheel(found: float, least: float, radius: float) -> None:
    """Raise InputError unless a mesh is a smooth wheel of the rover's radius [m].

    The rover's tire is a rim that touches at this distance from the axle on every orientation. ``found`` and ``least``
    are ``outer_radius`` and ``least_reach`` of `measure_own` [m].
    """
    if abs(found - radius) > _ROUND * radius:
        rule = f"is not that of the rover's wheels, {1e3 * radius:g} mm"
        hint = "give --rover FILE, a rover with such wheels; remove [rover], which is the shipped rover"
        raise InputError("radius of the wheel's own mesh", f"{1e3 * found:.5g} mm", rule, hint)
    if least < found * (1.0 - _ROUND):
        rule = f"must reach equally far all around for a rover to drive on them, and reach up to {1e3 * found:.5g} mm"
        hint = "mesh the rim without grousers, its edges on the circle, or remove [rover]"
        raise InputError("ground faces of the wheel's own mesh", f"{1e3 * least:.5g} mm", rule, hint)


def measure_own(
    mesh: TaggedMesh, content: FileMesh | StepBody, ground: list[str], densities: Mapping[str, float]
) -> dict[str, Any]:
    """Size, quality, and volume and mass of each part as meshed [m, m^3, kg]; the shape of tetrahedra is their own."""
    volumes = mesh_volume(mesh)
    parts = {
        name: {
            "cells": int(np.count_nonzero(mesh.cell_tags == tag)),
            "volume": volumes[name],
            "mass": densities[name] * volumes[name],
        }
        for name, tag in mesh.parts.items()
    }
    return {
        "half_width": "symmetry" in mesh.faces,
        "outer_radius": outer_radius(mesh, ground),
        "least_reach": least_reach(mesh, ground),
        "width": float(np.ptp(mesh.points[:, 1])),
        "quality": asdict(mesh_quality(mesh)) | _shape(content),
        "parts": parts,
        "facets": {name: int(np.count_nonzero(mesh.facet_tags == tag)) for name, tag in mesh.faces.items()},
        "total_volume": sum(volumes.values()),
        "total_mass": sum(part["mass"] for part in parts.values()),
        "hash": mesh.hash(),
    }


def _shape(content: FileMesh | StepBody) -> dict[str, float]:
    """Smallest scaled Jacobian of a file's tetrahedra; nothing of hexahedra, which are solved as they are."""
    file = content.file if isinstance(content, StepBody) else content
    cells, _ = solid_cells(file)
    if cells.shape[1] not in (4, 10):
        return {}
    return {"min_scaled_jacobian": float(scaled_jacobians_of_tetrahedra(file.points, cells).min())}
