"""The wheel's sections of a study file, as written by the user: dimensions and the name of each part's material.

Geometry decides whether the parts fit together; here only types, units and signs are checked. Verified by
tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictInt

from workbench.study.quantities import Angle, Density, Length, Number, Pressure
from workbench.study.section import Positive, Section

__all__ = [
    "ConeSection",
    "GrousersSection",
    "HubSection",
    "ImpactSpringsSection",
    "MaterialSection",
    "SidewallSpringsSection",
    "SpringsSection",
    "TireSection",
    "WheelSection",
    "WheelStudy",
]

Count = Annotated[StrictInt, Field(ge=1, le=360)]
Bands = Annotated[tuple[tuple[Length, Length], ...], Field(min_length=1)]
MaterialName = Annotated[str, Field(min_length=1)]


class TireSection(Section):
    """The rim: a cylindrical strip [m]."""

    outer_radius: Annotated[Length, Positive]
    width: Annotated[Length, Positive]
    thickness: Annotated[Length, Positive]
    material: MaterialName


class GrousersSection(Section):
    """Radial fins on the rim [m]; phase of the first one [rad]."""

    count: Count
    height: Annotated[Length, Positive]
    thickness: Annotated[Length, Positive]
    phase: Angle = 0.0
    material: MaterialName


class ImpactSpringsSection(Section):
    """Curved strips between the hubs [m]; phase of the first station [rad]."""

    count: Count
    phase: Angle = 0.0
    bands: Bands
    thickness: Annotated[Length, Positive]
    shape: Literal["arc", "hoop", "spline"]
    weld_length: Annotated[Length, Positive]
    direction: Literal[-1, 1] = 1
    points: tuple[tuple[Number, Angle], ...] = ()
    material: MaterialName


class SpringsSection(ImpactSpringsSection):
    """One set of springs between rim and outer hub; its name becomes the part's name."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class SidewallSpringsSection(Section):
    """Strips at the sides of the wheel, like a radial tire's sidewalls [m]; sweep of their arc and phase [rad]."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
    count: Count
    phase: Angle = 0.0
    width: Annotated[Length, Positive]
    thickness: Annotated[Length, Positive]
    curl_radius: Annotated[Length, Positive]
    arc_radius: Annotated[Length, Positive]
    sweep: Angle
    weld_length: Annotated[Length, Positive]
    clamp_length: Annotated[Length, Positive]
    material: MaterialName


class HubSection(Section):
    """A cylindrical ring of the hub [m]."""

    outer_radius: Annotated[Length, Positive]
    thickness: Annotated[Length, Positive]
    width: Annotated[Length, Positive]
    material: MaterialName


class ConeSection(Section):
    """Shell between the hubs, and its mirror image [m]."""

    thickness: Annotated[Length, Positive]
    outer_position: Annotated[Length, Positive]
    inner_position: Annotated[Length, Positive]
    material: MaterialName


class WheelSection(Section):
    """All parts of the wheel; those with a default of None may be left out."""

    tire: TireSection
    grousers: GrousersSection | None = None
    springs: tuple[SpringsSection, ...] = ()
    sidewall_springs: SidewallSpringsSection | None = None
    outer_hub: HubSection
    cone: ConeSection | None = None
    impact_springs: ImpactSpringsSection | None = None
    inner_hub: HubSection | None = None


class MaterialSection(Section):
    """One material: E [Pa], nu [-], rho [kg/m^3], R_p0.2 [Pa] at 20 C, where the numbers come from, and the name of its
    data against temperature, if any."""

    young_modulus: Annotated[Pressure, Positive]
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)]
    density: Annotated[Density, Positive]
    yield_strength: Annotated[Pressure, Positive]
    source: Annotated[str, Field(min_length=1)]
    temperature_data: Annotated[str, Field(min_length=1)] | None = None


class WheelStudy(Section):
    """The part of a study that decides the wheel: name, parts, materials."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$")]
    wheel: WheelSection
    materials: dict[str, MaterialSection]
