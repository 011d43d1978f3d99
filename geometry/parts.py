"""The parts of a wheel as numbers: tire, tread, grousers, spring sets, hub rings and cone.

Lengths in metres, angles in radians, frame of ``contracts.frames``: y along the axle, zero at the wheel's mid-plane;
phi from the lowest point (-z) towards the front (+x). Verified by tests/unit/test_geometry_validation.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from contracts.declared import Angle, Count, In, Number, PositiveLength, require_declared
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V, Material
from geometry.rules import require_bands, require_name

__all__ = ["Bands", "Cone", "Grousers", "HubRing", "SpringSet", "SpringShape", "Tire", "Tread"]

Bands = tuple[tuple[Annotated[float, In("m")], Annotated[float, In("m")]], ...]
"""Axial bands ``((y0, y1), ...)`` [m], y0 < y1."""

SpringShape = Literal["arc", "hoop", "spline"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Tire:
    """The rim: a cylindrical strip, without its grousers.

    Attributes
    ----------
    outer_radius : radius of the outer surface [m]
    width : axial width, from -width/2 to width/2 [m]
    thickness : radial thickness [m]
    material : elastic material
    """

    outer_radius: PositiveLength
    width: PositiveLength
    thickness: PositiveLength
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_declared(self, "tire")
        if self.thickness >= self.outer_radius:
            rule = f"must be smaller than the outer radius {self.outer_radius * 1e3:g} mm"
            raise InputError(
                "tire thickness", f"{self.thickness * 1e3:g} mm", rule, "give a strip such as 0.6 mm", key="thickness"
            )

    @property
    def inner_radius(self) -> float:
        """Radius of the inner surface [m]."""
        return self.outer_radius - self.thickness


@dataclass(frozen=True, slots=True, kw_only=True)
class Tread:
    """A layer bonded all around the tire's outer surface, e.g. of rubber: the wheel stands on it.

    Attributes
    ----------
    thickness : radial thickness, which adds to the wheel's radius [m]
    width : axial width, from -width/2 to width/2; without it the tire's [m]
    material : elastic material
    """

    thickness: PositiveLength
    width: PositiveLength | None = None
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_declared(self, "tread")


@dataclass(frozen=True, slots=True, kw_only=True)
class Grousers:
    """Radial fins over the width of what they stand on, flanks parallel, tip a cylinder about the axle.

    They stand on the tread where there is one, else on the tire.

    Attributes
    ----------
    count : number of fins, equally spaced [-]
    height : radial height of the tip above the surface they stand on [m]
    thickness : distance between the two flanks [m]
    phase : circumferential position of the first fin [rad]
    material : elastic material
    """

    count: Count
    height: PositiveLength
    thickness: PositiveLength
    phase: Angle = 0.0
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_declared(self, "grouser")


@dataclass(frozen=True, slots=True, kw_only=True)
class SpringSet:
    """Equal curved strips between two rings (rim and hub), bonded to both over a weld.

    A weld is a layer of the strip's thickness on the ring, centred on the station. The strip leaves the rim weld
    through the weld's end face, tangentially to the rim, and arrives tangentially at the end of the hub weld, which
    covers the same angle (theory notes 8, "Geometry trap": without an overlap the joint is a hinge). Its thickness is
    constant, or the parabola of the centreline's length through three values.

    Attributes
    ----------
    name : part name in the mesh
    count : number of stations, equally spaced [-]
    phase : circumferential position of the first station (weld centre) [rad]
    bands : axial bands ``((y0, y1), ...)`` that each station's strips occupy [m]
    thickness : strip thickness, where it varies that of the weld on the rim and of the strip's end there [m]
    shape : ``"arc"`` one semicircle; ``"hoop"`` two mirrored semicircles that share a weld; ``"spline"`` a clamped
        cubic spline through ``points``
    weld_length : arc length of the weld on the outer ring's inner surface [m]
    direction : side to which an arc or spline leaves the weld: 1 towards larger phi, -1 towards smaller phi
    thickness_middle : half way along the strip [m]; without it the mean of the ends', which makes a wedge
    thickness_hub : of the weld on the hub and of the strip's end there [m]; without it that of the rim's end
    points : for ``"spline"``: (radius fraction, angle) of points on the centreline; the fraction runs from 0 on the rim
        weld's mid-surface to 1 on the hub weld's [-], the angle is measured from the weld's end in ``direction`` [rad]
    material : elastic material
    """

    name: str
    count: Count
    bands: Bands
    thickness: PositiveLength
    shape: SpringShape
    weld_length: PositiveLength
    phase: Angle = 0.0
    direction: Literal[-1, 1] = 1
    points: tuple[tuple[Number, Angle], ...] = ()
    thickness_middle: PositiveLength | None = None
    thickness_hub: PositiveLength | None = None
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_name("spring set name", self.name, key="name")
        require_bands(f"{self.name} band", self.bands, key="bands")
        require_declared(self, self.name)
        if self.shape not in ("arc", "hoop", "spline"):
            raise InputError(f"{self.name} shape", self.shape, "is not known", "give arc, hoop or spline", key="shape")
        if self.direction not in (-1, 1):
            raise InputError(
                f"{self.name} direction",
                self.direction,
                "must be 1 or -1",
                "1 leaves towards larger phi",
                key="direction",
            )
        if (self.shape == "spline") != bool(self.points):
            rule = "points belong to the shape spline, and only to it"
            raise InputError(
                f"{self.name} points", self.points, rule, "give points such as ((0.5, 0.5),) for a spline", key="points"
            )
        if self.tapered and not (thinnest := float(self.thickness_at(np.linspace(0.0, 1.0, 201)).min())) > 0.0:
            rule = f"makes the strip {thinnest * 1e3:.3g} mm thick where it is thinnest, with these ends"
            value = f"{self._thicknesses[1] * 1e3:g} mm"
            hint = "give a middle nearer to the ends"
            raise InputError(f"thickness_middle of {self.name}", value, rule, hint, key="thickness_middle")

    @property
    def tapered(self) -> bool:
        """Whether the strip's thickness varies along it."""
        return self.thickness_middle is not None or self.thickness_hub is not None

    @property
    def _thicknesses(self) -> tuple[float, float, float]:
        """At the rim, half way, at the hub [m]."""
        hub = self.thickness if self.thickness_hub is None else self.thickness_hub
        middle = 0.5 * (self.thickness + hub) if self.thickness_middle is None else self.thickness_middle
        return self.thickness, middle, hub

    @property
    def hub_thickness(self) -> float:
        """Thickness of the weld on the hub and of the strip's end there [m]."""
        return self._thicknesses[2]

    @property
    def mean_thickness(self) -> float:
        """Mean thickness of the strip along its centreline [m]; Simpson's rule is exact for a parabola."""
        rim, middle, hub = self._thicknesses
        return (rim + 4.0 * middle + hub) / 6.0 if self.tapered else self.thickness

    @property
    def largest_thickness(self) -> float:
        """Largest thickness of strip and welds [m]."""
        return float(self.thickness_at(np.linspace(0.0, 1.0, 201)).max())

    def thickness_at(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """Thickness [m] at shares of the centreline's length, 0 at the rim, 1 at the hub; the same shape."""
        if not self.tapered:
            return np.full_like(share, self.thickness)
        rim, middle, hub = self._thicknesses
        at_ends = rim * (1.0 - share) * (1.0 - 2.0 * share) + hub * share * (2.0 * share - 1.0)
        return at_ends + 4.0 * middle * share * (1.0 - share)


@dataclass(frozen=True, slots=True, kw_only=True)
class HubRing:
    """A cylindrical ring of the hub.

    Attributes
    ----------
    outer_radius : radius of the outer surface [m]
    thickness : radial thickness [m]
    width : axial width, from -width/2 to width/2 [m]
    material : elastic material
    """

    outer_radius: PositiveLength
    thickness: PositiveLength
    width: PositiveLength
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_declared(self, "hub")
        if self.thickness >= self.outer_radius:
            rule = f"must be smaller than the hub's outer radius {self.outer_radius * 1e3:g} mm"
            raise InputError(
                "hub thickness", f"{self.thickness * 1e3:g} mm", rule, "give a ring such as 2 mm", key="thickness"
            )

    @property
    def inner_radius(self) -> float:
        """Radius of the inner surface (bore) [m]."""
        return self.outer_radius - self.thickness


@dataclass(frozen=True, slots=True, kw_only=True)
class Cone:
    """A frustum shell from the outer hub's bore to the inner hub's outer face, and its mirror image about y = 0.

    Attributes
    ----------
    thickness : thickness normal to the shell [m]
    outer_position : axial position of the middle of its joint with the outer hub, y > 0 [m]
    inner_position : axial position of the middle of its joint with the inner hub, y > 0 [m]
    material : elastic material
    """

    thickness: PositiveLength
    outer_position: PositiveLength
    inner_position: PositiveLength
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_declared(self, "cone")

    def axial_width(self, outer_radius: float, inner_radius: float) -> float:
        """Axial extent [m] of a joint: thickness / cos(angle between the shell and the radius)."""
        slope = (self.outer_position - self.inner_position) / (outer_radius - inner_radius)
        return self.thickness * math.hypot(1.0, slope)
