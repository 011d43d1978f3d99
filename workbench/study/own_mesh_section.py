"""The section [mesh] of a wheel whose mesh comes from another program.

Verified by tests/unit/test_workbench_own_mesh.py.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictInt

from workbench.study.quantities import Length
from workbench.study.section import Section
from workbench.study.wheel import MaterialName, PartName

__all__ = ["OwnMeshSection", "OwnPartSection"]

Axis = Literal["x", "y", "z"]
GroupName = Annotated[str, Field(min_length=1)]


class OwnPartSection(Section):
    """A part of a mesh from another program."""

    material: MaterialName
    """Name of one of [materials]."""
    groups: tuple[GroupName, ...] = ()
    """Groups of cells of the file that it consists of; without it that of the part's own name."""


class OwnMeshSection(Section):
    """The wheel's mesh from another program, in place of [wheel]."""

    file: Annotated[str, Field(min_length=1)]
    """Mesh file (.msh, .med, .inp, .vtu, .vtk, .exo), relative to the study file."""
    units: Literal["m", "cm", "mm", "in"]
    """Of the file's lengths."""
    parts: Annotated[dict[PartName, OwnPartSection], Field(min_length=1)]
    """Part -> its material, and the file's groups of cells."""
    hub: Annotated[tuple[GroupName, ...], Field(min_length=1)]
    """Parts, and groups of faces, that are held."""
    ground: Annotated[tuple[GroupName, ...], Field(min_length=1)]
    """Groups of faces that may touch the ground."""
    contact: tuple[Annotated[tuple[GroupName, GroupName], Field()], ...] = ()
    """Pairs of groups of faces that may touch each other; the first is held off the second."""
    symmetry: GroupName | None = None
    """Group of faces in the wheel's mid-plane, for half a wheel; loads are those of the whole."""
    axle: Axis = "y"
    """Axis of the file along the axle."""
    up: Axis = "z"
    """Axis of the file at whose lower end lies what faces the ground at 0 degrees."""
    centre: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    """Of the hub, in the file's axes [m]."""

    factor: Annotated[StrictInt, Field(ge=1, le=6)] = 1
    """Each hexahedron is divided into so many along each of its axes [-]."""

    @property
    def half_width(self) -> bool:
        """Whether half the wheel is meshed."""
        return self.symmetry is not None
