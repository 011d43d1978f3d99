"""The wheel's sections of a study file, as written by the user: dimensions and the name of each part's material.

What a part has, and in which unit, `geometry` declares; it decides whether the parts fit together, too. Verified by
tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from contracts.errors import InputError
from contracts.materials import Material
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire
from geometry.sidewall import SidewallSprings
from workbench.study.declared import reads
from workbench.study.section import Section

__all__ = [
    "ConeSection",
    "GrousersSection",
    "HubSection",
    "ImpactSpringsSection",
    "MaterialName",
    "MaterialSection",
    "PartName",
    "SidewallSpringsSection",
    "SpringsSection",
    "TireSection",
    "WheelSection",
    "WheelStudy",
]

MaterialName = Annotated[str, Field(min_length=1)]
PartName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class PartSection(Section):
    """A part of the wheel with what it is made of."""

    material: MaterialName
    """Name of one of [materials]."""


@reads(Tire)
class TireSection(PartSection):
    """The rim: a cylindrical strip [m]."""


@reads(Grousers)
class GrousersSection(PartSection):
    """Radial fins on the rim [m]; phase of the first one [rad]."""


@reads(SpringSet, "name")
class ImpactSpringsSection(PartSection):
    """Curved strips between the hubs [m]; phase of the first station [rad]."""


@reads(SpringSet)
class SpringsSection(PartSection):
    """One set of springs between rim and outer hub; its name becomes the part's name."""

    name: PartName
    """Of the set: the name of its part of the mesh."""


@reads(SidewallSprings)
class SidewallSpringsSection(PartSection):
    """Strips at the sides of the wheel, like a radial tire's sidewalls [m]; sweep of their arc and phase [rad]."""

    name: PartName
    """Of the set: the name of its part of the mesh."""


@reads(HubRing)
class HubSection(PartSection):
    """A cylindrical ring of the hub [m]."""


@reads(Cone)
class ConeSection(PartSection):
    """Shell between the hubs, and its mirror image [m]."""


class WheelSection(Section):
    """All parts of the wheel; those with a default of None may be left out."""

    tire: TireSection
    """The rim."""
    grousers: GrousersSection | None = None
    """Fins on the rim; none without it."""
    springs: tuple[SpringsSection, ...] = ()
    """Sets of strips between rim and outer hub."""
    sidewall_springs: SidewallSpringsSection | None = None
    """Strips at the sides of the wheel; none without it."""
    outer_hub: HubSection
    """Ring that carries the springs."""
    cone: ConeSection | None = None
    """Shell between the hubs; none without it."""
    impact_springs: ImpactSpringsSection | None = None
    """Strips between the hubs; none without it."""
    inner_hub: HubSection | None = None
    """Ring on the axle; none without it."""


@reads(Material, "name", "temperature", "thermal_strain", "law")
class MaterialSection(Section):
    """One material at 20 C, and the name of its data against temperature, if any."""


class WheelStudy(Section):
    """The part of a study that decides the wheel: name, parts, materials."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$")]
    """Short name: of files, and in summaries."""
    wheel: WheelSection | None = None
    """Parts of the wheel; None where its mesh comes from another program."""
    materials: dict[str, MaterialSection]
    """Materials by name."""

    @property
    def parametric(self) -> WheelSection:
        """The wheel's parts; raises InputError where the study has its own mesh in their place."""
        if self.wheel is None:
            rule = "is not in the study, whose mesh comes from another program"
            raise InputError("[wheel]", "", rule, "describe the wheel in [wheel] in place of mesh.file")
        return self.wheel
