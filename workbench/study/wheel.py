"""The wheel's sections of a study file, as written by the user: dimensions and the name of each part's material.

Geometry decides whether the parts fit together; here only types, units and signs are checked. Verified by
tests/unit/test_workbench_study.py.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictInt

from workbench.study.quantities import Angle, Length, Number
from workbench.study.sections import Positive, Section

__all__ = [
    "ConeSection",
    "GrousersSection",
    "HubSection",
    "ImpactSpringsSection",
    "SidewallSpringsSection",
    "SpringsSection",
    "TireSection",
    "WheelSection",
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
