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
    """Of the rim, without grousers [m]."""
    width: Annotated[Length, Positive]
    """Along the axle [m]."""
    thickness: Annotated[Length, Positive]
    """Of the strip [m]."""
    material: MaterialName
    """Name of one of [materials]."""


class GrousersSection(Section):
    """Radial fins on the rim [m]; phase of the first one [rad]."""

    count: Count
    """Fins, evenly spaced."""
    height: Annotated[Length, Positive]
    """Beyond the rim [m]."""
    thickness: Annotated[Length, Positive]
    """Around the wheel [m]."""
    phase: Angle = 0.0
    """Of the first one, from the lowest point towards the front [rad]."""
    material: MaterialName
    """Name of one of [materials]."""


class ImpactSpringsSection(Section):
    """Curved strips between the hubs [m]; phase of the first station [rad]."""

    count: Count
    """Stations around the wheel, evenly spaced."""
    phase: Angle = 0.0
    """Of the first station, from the lowest point towards the front [rad]."""
    bands: Bands
    """Where the strips of a station lie along the axle, from and to [m]."""
    thickness: Annotated[Length, Positive]
    """Of the strip [m]."""
    shape: Literal["arc", "hoop", "spline"]
    """One arc, two mirrored semicircles, or a spline through ``points``."""
    weld_length: Annotated[Length, Positive]
    """Arc of the weld on the outer ring [m]."""
    direction: Literal[-1, 1] = 1
    """Side to which an arc or a spline leaves the weld: 1 towards larger angles, -1 towards smaller ones."""
    points: tuple[tuple[Number, Angle], ...] = ()
    """Of a spline: share of the way from rim to hub [-], angle from the weld's end in ``direction`` [rad]."""
    material: MaterialName
    """Name of one of [materials]."""


class SpringsSection(ImpactSpringsSection):
    """One set of springs between rim and outer hub; its name becomes the part's name."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
    """Of the set: the name of its part of the mesh."""


class SidewallSpringsSection(Section):
    """Strips at the sides of the wheel, like a radial tire's sidewalls [m]; sweep of their arc and phase [rad]."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
    """Of the set: the name of its part of the mesh."""
    count: Count
    """Pairs around the wheel, evenly spaced."""
    phase: Angle = 0.0
    """Of the first pair, from the lowest point towards the front [rad]."""
    width: Annotated[Length, Positive]
    """Of a strip, around the wheel [m]."""
    thickness: Annotated[Length, Positive]
    """Of the sheet [m]."""
    curl_radius: Annotated[Length, Positive]
    """Of the curl at the rim [m]."""
    arc_radius: Annotated[Length, Positive]
    """Of the arc at the side [m]."""
    sweep: Angle
    """Angle that the arc turns through [rad]."""
    weld_length: Annotated[Length, Positive]
    """On the rim, along the axle [m]."""
    clamp_length: Annotated[Length, Positive]
    """Held rigid at the hub [m]."""
    material: MaterialName
    """Name of one of [materials]."""


class HubSection(Section):
    """A cylindrical ring of the hub [m]."""

    outer_radius: Annotated[Length, Positive]
    """Of the ring [m]."""
    thickness: Annotated[Length, Positive]
    """Of the ring [m]."""
    width: Annotated[Length, Positive]
    """Along the axle [m]."""
    material: MaterialName
    """Name of one of [materials]."""


class ConeSection(Section):
    """Shell between the hubs, and its mirror image [m]."""

    thickness: Annotated[Length, Positive]
    """Of the shell [m]."""
    outer_position: Annotated[Length, Positive]
    """Where it meets the outer hub, from the mid-plane along the axle [m]."""
    inner_position: Annotated[Length, Positive]
    """Where it meets the inner hub, from the mid-plane along the axle [m]."""
    material: MaterialName
    """Name of one of [materials]."""


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


class MaterialSection(Section):
    """One material: E [Pa], nu [-], rho [kg/m^3], R_p0.2 [Pa] at 20 C, where the numbers come from, and the name of its
    data against temperature, if any."""

    young_modulus: Annotated[Pressure, Positive]
    """At 20 C [Pa]."""
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)]
    """At 20 C [-]."""
    density: Annotated[Density, Positive]
    """At 20 C [kg/m^3]."""
    yield_strength: Annotated[Pressure, Positive]
    """0.2 % proof stress at 20 C [Pa]."""
    source: Annotated[str, Field(min_length=1)]
    """Where the numbers come from."""
    temperature_data: Annotated[str, Field(min_length=1)] | None = None
    """Name of built-in data relative to 20 C; without it the material is known at 20 C only."""


class WheelStudy(Section):
    """The part of a study that decides the wheel: name, parts, materials."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$")]
    """Short name: of files, and in summaries."""
    wheel: WheelSection
    """Parts of the wheel."""
    materials: dict[str, MaterialSection]
    """Materials by name."""
