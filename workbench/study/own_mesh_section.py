"""The section [mesh] of a wheel whose mesh comes from another program.

Verified by tests/unit/test_workbench_own_mesh.py.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, StrictInt

from workbench.study.quantities import Length
from workbench.study.section import Positive, Section
from workbench.study.wheel import MaterialName, PartName

__all__ = ["OwnFacesSection", "OwnMeshSection", "OwnPartSection"]

Axis = Literal["x", "y", "z"]
GroupName = Annotated[str, Field(min_length=1)]


def _pair(value: object) -> object:
    """One length stands for both ends of a range."""
    return value if isinstance(value, list | tuple) else (value, value)


LengthRange = Annotated[tuple[Length, Length], BeforeValidator(_pair)]


class OwnPartSection(Section):
    """A part of a mesh from another program."""

    material: MaterialName
    """Name of one of [materials]."""
    groups: tuple[GroupName, ...] = ()
    """Groups of cells of the file that it consists of; without it that of the part's own name."""
    element_size: Annotated[Length, Positive] | None = None
    """STEP file only: largest edge of this part's elements [m]; without it ``mesh.element_size``."""


class OwnFacesSection(Section):
    """Which outer faces of a STEP file a name stands for: those for which all that is given here holds."""

    part: PartName | None = None
    """Faces of this part."""
    radius: LengthRange | None = None
    """Faces that lie whole at this distance from the axle, or between two [m]."""
    position: LengthRange | None = None
    """Faces that lie whole at this place along the axle from the hub's centre, or between two [m]."""
    numbers: tuple[Annotated[StrictInt, Field(ge=1, le=1_000_000)], ...] = ()
    """Faces of these numbers, which ``workbench check`` lists."""


class OwnMeshSection(Section):
    """The wheel's mesh from another program, in place of [wheel]."""

    file: Annotated[str, Field(min_length=1)]
    """Mesh file (.msh, .med, .inp, .vtu, .vtk, .exo) or solids to mesh (.step), relative to the study file."""
    units: Literal["m", "cm", "mm", "in"] | None = None
    """Of a mesh file's lengths, which has to be given; a STEP file states its own."""
    element_size: Annotated[Length, Positive] | None = None
    """STEP file only, which needs it: largest edge of an element [m]."""
    around: Annotated[StrictInt, Field(ge=0, le=360)] | None = None
    """STEP file only: least elements around a full circle of curved faces and edges [-]; 12 without it, 0 for none."""
    faces: Annotated[dict[GroupName, OwnFacesSection], Field(default_factory=dict)]
    """STEP file only: name of a group of faces -> which they are."""
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

    repeats: Annotated[StrictInt, Field(ge=1, le=1000)] = 1
    """Equal sectors around the axle, by which the mesh is checked: curves repeat after 360 degrees over it [-]."""
    factor: Annotated[StrictInt, Field(ge=1, le=6)] = 1
    """Each hexahedron is divided into so many along each of its axes [-]."""

    @property
    def of_solids(self) -> bool:
        """Whether the file holds solids that are to be meshed."""
        return self.file.lower().endswith((".step", ".stp"))

    @property
    def half_width(self) -> bool:
        """Whether half the wheel is meshed."""
        return self.symmetry is not None
