"""A quality summary of a wheel's mesh, ready to be written as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass

import numpy as np

from contracts.mesh import TaggedMesh
from geometry.closed_form import closed_form_volume, part_masses
from geometry.measures import MeshQuality, mesh_quality, mesh_volume
from geometry.wheel import WheelDesign

__all__ = ["MeshSummary", "PartSummary", "summarize_mesh"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PartSummary:
    """One part: cells, volume on the mesh and by its dimensions [m^3], mass on the mesh and by dimensions [kg]."""

    cells: int
    material: str
    volume: float
    volume_closed_form: float
    mass: float
    mass_closed_form: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshSummary:
    """Quality, parts, facets of each face group, whether it is half the width, and the mesh's hash."""

    design: str
    half_width: bool
    quality: MeshQuality
    parts: Mapping[str, PartSummary]
    facets: Mapping[str, int]
    total_mass: float
    worst_volume_error: float
    hash: str

    def as_dict(self) -> dict[str, object]:
        """The same as nested dictionaries of numbers and text, for ``json.dumps``."""
        return asdict(self)


def summarize_mesh(mesh: TaggedMesh, design: WheelDesign) -> MeshSummary:
    """Return the summary of a mesh of ``design`` (half the width if it has the face group ``"symmetry"``).

    Verified by tests/unit/test_geometry_files.py.
    """
    half_width = "symmetry" in mesh.faces
    volumes = mesh_volume(mesh)
    exact = {name: v for name, v in closed_form_volume(design, half_width).items() if name in volumes}
    mass, exact_mass = part_masses(volumes, design.materials), part_masses(exact, design.materials)
    parts = {
        name: PartSummary(
            cells=int(np.count_nonzero(mesh.cell_tags == tag)),
            material=design.materials[name].name,
            volume=volumes[name],
            volume_closed_form=exact[name],
            mass=mass[name],
            mass_closed_form=exact_mass[name],
        )
        for name, tag in mesh.parts.items()
    }
    return MeshSummary(
        design=design.name,
        half_width=half_width,
        quality=mesh_quality(mesh),
        parts=parts,
        facets={name: int(np.count_nonzero(mesh.facet_tags == tag)) for name, tag in mesh.faces.items()},
        total_mass=sum(mass.values()),
        worst_volume_error=max(abs(volumes[name] / exact[name] - 1.0) for name in volumes),
        hash=mesh.hash(),
    )
