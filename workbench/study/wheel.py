"""The wheel's sections of a study file, as written by the user: dimensions and the name of each part's material.

What a part has, and in which unit, `geometry` declares; it decides whether the parts fit together, too. Verified by
tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator

from contracts.errors import InputError
from contracts.materials import Material
from geometry.lattice import Lattice
from geometry.parts import Cone, Grousers, HubRing, SpringSet, Tire, Tread
from geometry.sidewall import SidewallSprings
from workbench.study.declared import reads
from workbench.study.material_law import LawSection, MooneyRivlinSection, OgdenSection
from workbench.study.section import Section, in_key

__all__ = [
    "ConeSection",
    "GrousersSection",
    "HubSection",
    "ImpactSpringsSection",
    "LatticeSection",
    "MaterialName",
    "MaterialSection",
    "PartName",
    "SidewallSpringsSection",
    "SpringsSection",
    "TireSection",
    "TreadSection",
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


@reads(Tread)
class TreadSection(PartSection):
    """A layer bonded on the rim's outside, e.g. of rubber [m]."""


@reads(Grousers)
class GrousersSection(PartSection):
    """Radial fins on the rim or its tread [m]; phase of the first one [rad]."""


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


@reads(Lattice)
class LatticeSection(PartSection):
    """Honeycomb or re-entrant cells of straight walls between rim and outer hub [m]; their angle and phase [rad]."""


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
    tread: TreadSection | None = None
    """Layer on the rim; none without it."""
    grousers: GrousersSection | None = None
    """Fins on the rim; none without it."""
    springs: tuple[SpringsSection, ...] = ()
    """Sets of strips between rim and outer hub."""
    sidewall_springs: SidewallSpringsSection | None = None
    """Strips at the sides of the wheel; none without it."""
    lattice: LatticeSection | None = None
    """Cells in place of springs; none without it."""
    outer_hub: HubSection
    """Ring that carries the springs."""
    cone: ConeSection | None = None
    """Shell between the hubs; none without it."""
    impact_springs: ImpactSpringsSection | None = None
    """Strips between the hubs; none without it."""
    inner_hub: HubSection | None = None
    """Ring on the axle; none without it."""


_OF_RUBBER = ("young_modulus", "poisson_ratio", "yield_strength")
"""What rubber does not have beside the constants of its law, and every other material must have."""


@reads(Material, "name", "temperature", "thermal_strain", "law", optional=_OF_RUBBER)
class MaterialSection(Section):
    """One material at 20 C, and the name of its data against temperature, if any.

    Rubber (a law of Mooney and Rivlin or of Ogden) has neither Young's modulus nor Poisson's ratio of its own, which
    follow from the law, nor a yield strength.
    """

    law: LawSection | None = None
    """How its stress follows from deformation, a table; that of fe.material_law without it."""

    @model_validator(mode="after")
    def _constants_once(self) -> MaterialSection:
        given = {name: getattr(self, name) for name in _OF_RUBBER}
        if not isinstance(self.law, MooneyRivlinSection | OgdenSection):
            if lacking := [name for name, value in given.items() if value is None]:
                raise in_key(lacking[0], "", "is missing", "add it to the study file")
            return self
        for name, value in given.items():
            if value is not None:
                follows = "does not yield" if name == "yield_strength" else "has it from the constants of its law"
                rule = f"must be left out of a material with law.kind = {self.law.kind}, which {follows}"
                raise in_key(name, value, rule, f"remove {name}, or take another law")
        return self

    @model_serializer(mode="wrap")
    def _without_a_law(self, values: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """As ever where the material has no law of its own: tasks are known by these values."""
        found: dict[str, Any] = values(self)
        return found if self.law is not None else {name: one for name, one in found.items() if name != "law"}


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
