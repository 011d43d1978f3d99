"""Task that reads a wheel's mesh from another program, and checks it.

Verified by tests/end_to_end/test_own_mesh.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.measures import mesh_quality, mesh_volume
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.wheel_checks import outer_radius
from geometry.own_mesh.wheel_mesh import wheel_of_file
from workbench.execution.fingerprint import file_sha256
from workbench.execution.result_files import write_result
from workbench.questions.wheel.mesh_file import MESH, write_mesh
from workbench.study.own_mesh import placement_and_roles

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["measure_own", "own_wheel", "read"]


def read(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Read one mesh and check it: ``mesh.npz``, ``result.json``."""
    path = Path(inputs["mesh"]["file"])
    if file_sha256(path) != inputs["sha256"]:
        raise InputError("mesh file", path, "has changed since the run began", "run the command again")
    mesh = own_wheel(inputs["mesh"])
    progress(0.7)
    write_mesh(mesh, out / MESH)
    write_result(out, measure_own(mesh, inputs["mesh"]["ground"], inputs["densities"]))
    progress(1.0)
    return 0


def own_wheel(section: Mapping[str, Any]) -> TaggedMesh:
    """The wheel of a section [mesh] as JSON; raises InputError with the key for a file or names that make no wheel."""
    path, (placement, roles) = Path(section["file"]), placement_and_roles(dict(section))
    file = read_mesh_file(path)
    try:
        return wheel_of_file(file, roles, placement, section["factor"])
    except InputError as error:
        what, value = (error.what, error.value or path.name) if error.what == "mesh file" else (error.what, error.value)
        place = f"mesh.{error.key}: " if error.key not in ("", "file") else ""
        raise InputError(place + what, value, error.rule, error.hint) from error


def measure_own(mesh: TaggedMesh, ground: list[str], densities: Mapping[str, float]) -> dict[str, Any]:
    """Size, quality, and volume and mass of each part as meshed [m, m^3, kg]."""
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
        "width": float(np.ptp(mesh.points[:, 1])),
        "quality": asdict(mesh_quality(mesh)),
        "parts": parts,
        "facets": {name: int(np.count_nonzero(mesh.facet_tags == tag)) for name, tag in mesh.faces.items()},
        "total_volume": sum(volumes.values()),
        "total_mass": sum(part["mass"] for part in parts.values()),
        "hash": mesh.hash(),
    }
