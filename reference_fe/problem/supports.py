"""Boundary conditions of a static problem as data: supports and loads."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from contracts.errors import InputError
from reference_fe.dolfinx_api import Expr

__all__ = ["BodyForce", "EdgeLoad", "EndMoment", "Load", "Middle", "Support", "Traction"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Middle:
    """Nodes halfway between two faces: a shell's mid-surface, or its line or point in other faces, such as a hinge.

    There are some if the wall has an even number of cells across it, or one of 27 nodes.

    Attributes
    ----------
    between : the two faces, such as the inner and outer one of a shell
    within : faces that have the nodes in common too: none for the whole mid-surface, one for its line in that face

    Verified by tests/unit/test_fe_supports.py.
    """

    between: tuple[str, str]
    within: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Support:
    """Prescribed displacement of named faces, of lines and points where faces meet, or of all nodes of named parts.

    Attributes
    ----------
    name : by which its force on the body is asked for, see `reactions`; several supports may share one
    faces, parts : names in the mesh; at least one
    meetings : each names the faces that have the supported nodes in common: two for a line, three for a point
    middles : nodes halfway between two faces
    components : displacement components held, of 0 (x), 1 (y), 2 (z); a planar body has 0 and 1 only, its two axes
    value : displacement at load factor 1, one for each component [m]; zero holds the faces
    stretch : free thermal stretch theta of what is held [-]: it is displaced by (theta - 1) X from the start, X counted
        from the origin

    Verified by tests/verification/test_fe_thermal.py (stretch) and the other verification problems.
    """

    faces: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    meetings: tuple[tuple[str, ...], ...] = ()
    middles: tuple[Middle, ...] = ()
    components: tuple[int, ...] = (0, 1, 2)
    value: tuple[float, ...] | None = None
    stretch: float = 1.0
    name: str = ""

    def __post_init__(self) -> None:
        if not self.stretch > 0.0:
            raise InputError("support stretch", self.stretch, "must be > 0", "1 is no expansion")
        if not (self.faces or self.parts or self.meetings or self.middles):
            raise InputError("support", "no face, no part", "must name where it holds", "name a face or a part")
        if any(len(faces) < 2 for faces in self.meetings):
            raise InputError("support meetings", self.meetings, "need two faces or more each", "use faces for one face")
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
    vector : traction at load factor 1 [Pa], one component an axis of space
    """

    faces: tuple[str, ...]
    vector: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyForce:
    """Dead force on named parts, per undeformed volume.

    Attributes
    ----------
    parts : part names
    field : force at load factor 1 [N/m^3] as a UFL vector, given the UFL reference position X [m]
    quadrature_degree : degree of the cell quadrature [-]

    Verified by tests/verification/test_fe_manufactured.py.
    """

    parts: tuple[str, ...]
    field: Callable[[Expr], Expr]
    quadrature_degree: int = 6


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeLoad:
    """Dead load on the line where two named faces meet, per undeformed length.

    Attributes
    ----------
    meeting : the two face names
    vector : load at load factor 1 [N/m]

    Verified by tests/unit/test_fe_loads.py and tests/verification/test_fe_shell_hemisphere.py.
    """

    meeting: tuple[str, str]
    vector: tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class EndMoment:
    """Moment on named faces that turns with them: a pure couple about a fixed axis, without resultant force.

    With the director d = F D (D lies in the face, across the strip) and theta its angle about the axis a, the work is
    the integral of magnitude times theta over the undeformed face; so it has a potential and a symmetric stiffness as
    long as the motion is plane. On one quadratic element through the thickness its nodal forces are those of the
    linear bending stress.

    Attributes
    ----------
    faces : face names
    magnitude : moment per undeformed area at load factor 1 [N m/m^2]
    axis : unit vector a about which it turns, right-handed [-]
    director : unit vector D in the undeformed face, at right angles to the axis [-]

    Verified by tests/unit/test_fe_loads.py and tests/verification/test_fe_shell_cantilever.py.
    """

    faces: tuple[str, ...]
    magnitude: float
    axis: tuple[float, float, float]
    director: tuple[float, float, float]

    def __post_init__(self) -> None:
        for what, vector in (("axis", self.axis), ("director", self.director)):
            if abs(math.hypot(*vector) - 1.0) > 1e-9:
                raise InputError(f"end moment {what}", vector, "must have length 1", "normalise it")
        if abs(sum(a * d for a, d in zip(self.axis, self.director, strict=True))) > 1e-9:
            raise InputError("end moment director", self.director, "must be at right angles to the axis", "turn it")


type Load = BodyForce | EdgeLoad | EndMoment | Traction
"""What a static problem takes as a load; all grow with the load factor."""
