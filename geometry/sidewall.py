"""Sidewall springs: strips that close the sides of a wheel like the cords of a radial tire's sidewalls.

Each strip lies in a plane through the axle. It leaves a weld on the rim's inside at the rim's edge, curls outwards
through half a circle, runs back and swings towards the hub in an arc of opposite curvature, where it is clamped.
Verified by tests/unit/test_geometry_sidewall.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.declared import Angle, Count, PositiveLength, require_declared
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V, Material
from geometry.rules import require_name

__all__ = ["Profile", "SidewallSprings", "sidewall_profile", "weld_half_angle"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class SidewallSprings:
    """Equal strips at both sides of the wheel, mirrored about y = 0.

    The strip's cross-section follows the rim on the weld, flattens along the curl and is flat from there to the clamp.

    Attributes
    ----------
    name : part name in the mesh
    count : number of strips at each side, equally spaced [-]
    phase : circumferential position of the first strip's middle [rad]
    width : chord of the strip across its length, which lies along the circumference [m]
    thickness : strip thickness [m]
    curl_radius : radius of the curl's centreline, half a circle that begins at the rim's edge [m]
    arc_radius : radius of the arc's centreline [m]
    sweep : angle of the arc [rad]; at pi the strip arrives parallel to the axle
    weld_length : axial length of the weld on the rim's inside, from the rim's edge [m]; half the rim's width makes one
        strip of the two sides
    clamp_length : length that the hub holds, a straight piece beyond the arc; it belongs to the part ``outer_hub`` [m]
    material : elastic material
    """

    name: str
    count: Count
    width: PositiveLength
    thickness: PositiveLength
    curl_radius: PositiveLength
    arc_radius: PositiveLength
    sweep: Angle
    weld_length: PositiveLength
    clamp_length: PositiveLength
    phase: Angle = 0.0
    material: Material = TI_6AL_4V

    def __post_init__(self) -> None:
        require_name("sidewall springs name", self.name, key="name")
        require_declared(self, self.name)
        if min(self.curl_radius, self.arc_radius) <= 0.5 * self.thickness:
            rule = f"must exceed half the thickness, {0.5e3 * self.thickness:g} mm"
            raise InputError(
                f"{self.name} curl radius", f"{self.curl_radius * 1e3:g} mm", rule, "widen the curl", key="curl_radius"
            )
        if not 0.0 < self.sweep <= 1.25 * math.pi:
            rule = "must be greater than 0 and at most 225 deg"
            raise InputError(
                f"{self.name} sweep", f"{math.degrees(self.sweep):g} deg", rule, "180 deg is a semicircle", key="sweep"
            )

    @property
    def free_length(self) -> float:
        """Length of the centreline from the rim's edge to the clamp [m]: pi curl_radius + sweep arc_radius."""
        return math.pi * self.curl_radius + self.sweep * self.arc_radius


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """Centreline of a strip in its plane through the axle, at the side y > 0, in coordinates (y, r).

    Attributes
    ----------
    points : (n, 2) float [m], from the weld's inner end to the clamp's end
    normals : (n, 2) float [-], unit normals to the side that faces the rim on the weld
    flatness : (n,) float [-], 0 where the cross-section follows the rim, 1 where it is flat
    """

    points: Array
    normals: Array
    flatness: Array


def weld_half_angle(springs: SidewallSprings, rim: float) -> float:
    """Half the angle [rad] that a strip of chord ``width`` covers on the rim's inner surface of radius ``rim`` [m]."""
    return math.asin(0.5 * springs.width / rim)


def sidewall_profile(springs: SidewallSprings, rim: float, weld: Array, counts: tuple[int, int, int]) -> Profile:
    """Return the centreline, divided evenly within curl, arc and clamp.

    Parameters
    ----------
    springs : the strips
    rim : radius of the rim's inner surface [m]
    weld : (k,) float [m], axial positions on the weld, increasing, the last one the rim's edge
    counts : steps along curl, arc and clamp
    """
    edge, top = float(weld[-1]), rim - 0.5 * springs.thickness
    turned, swept, beyond = (
        end * np.linspace(0.0, 1.0, n + 1)[1:]
        for end, n in zip((math.pi, springs.sweep, springs.clamp_length), counts, strict=True)
    )
    curl = np.column_stack([np.sin(turned), np.cos(turned)])
    arc = np.column_stack([np.sin(swept), -np.cos(swept)])
    tangent = np.array([-math.cos(springs.sweep), -math.sin(springs.sweep)])
    at_arc_end = np.array([edge, top - 2.0 * springs.curl_radius - springs.arc_radius]) - springs.arc_radius * arc
    points = [
        np.column_stack([weld, np.full(len(weld), top)]),
        np.array([edge, top - springs.curl_radius]) + springs.curl_radius * curl,
        at_arc_end,
        at_arc_end[-1] + beyond[:, None] * tangent,
    ]
    on_weld = np.tile([0.0, 1.0], (len(weld), 1))
    flat = np.ones(len(arc) + len(beyond))
    return Profile(
        points=np.concatenate(points),
        normals=np.concatenate([on_weld, curl, arc, np.tile(arc[-1], (len(beyond), 1))]),
        flatness=np.concatenate([np.zeros(len(weld)), 0.5 * (1.0 - np.cos(turned)), flat]),
    )
