"""Boundary conditions of a static problem as data: supports, tractions, and a rigid plane in contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError

__all__ = ["PlaneContact", "Support", "Traction"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Support:
    """Prescribed displacement of named faces or of all nodes of named parts.

    Attributes
    ----------
    faces, parts : names in the mesh; at least one
    components : displacement components held, of 0 (x), 1 (y), 2 (z)
    value : displacement at load factor 1, one for each component [m]; zero holds the faces
    """

    faces: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    components: tuple[int, ...] = (0, 1, 2)
    value: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        if not self.faces and not self.parts:
            raise InputError("support", "no face, no part", "must name where it holds", "name a face or a part")
        if not self.components or not set(self.components) <= {0, 1, 2}:
            raise InputError("support components", self.components, "must be of 0, 1, 2", "0 is x, 1 is y, 2 is z")
        if self.value is not None and len(self.value) != len(self.components):
            raise InputError("support value", self.value, "needs one number for each component", "give as many")


@dataclass(frozen=True, slots=True, kw_only=True)
class Traction:
    """Dead traction on named faces, per undeformed area.

    Attributes
    ----------
    faces : face names
    vector : traction at load factor 1 [Pa]
    """

    faces: tuple[str, ...]
    vector: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneContact:
    """Frictionless penalty contact of named faces with a rigid plane that is raised against them.

    The plane's unit normal n points to the body. Its distance from the origin along -n is ``distance_at_touch`` minus
    the control parameter. Normal gap (open > 0): g = n . x + distance; the pressure on the undeformed area follows
    `reference_fe.contact_law.plane_pressure`.

    Attributes
    ----------
    faces : face names that may touch the plane
    normal : unit normal, plane to body [-]
    distance_at_touch : distance of the plane from the origin at control parameter 0 [m]
    stiffness : penalty stiffness [N/m^3]
    ramp : gap below which the pressure begins, and above which (negative) it is linear [m]
    quadrature_degree : degree of the facet quadrature [-]
    """

    faces: tuple[str, ...]
    normal: tuple[float, float, float]
    distance_at_touch: float
    stiffness: float
    ramp: float = 5e-6
    quadrature_degree: int = 8

    def __post_init__(self) -> None:
        if abs(math.hypot(*self.normal) - 1.0) > 1e-9:
            raise InputError("plane normal", self.normal, "must have length 1", "normalise it")
        if not (math.isfinite(self.stiffness) and self.stiffness > 0.0):
            raise InputError("contact stiffness", f"{self.stiffness:g} N/m^3", "must be > 0", "about 1e12 suits metal")
