"""Springs of an ANCF wheel: legs between rim and hub, strips at its sides.

Verified by tests/unit/test_ancf_wheel_mesh.py and tests/unit/test_ancf_wheel_sidewall.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ancf_reduced.thin_plates.plates import Layer
from ancf_reduced.wheel.draft import Draft, Rim, TieLine
from ancf_reduced.wheel.joints import turning_stiffness
from ancf_reduced.wheel.supports import HubEnd, on_cylinder
from geometry.parts import SpringSet
from geometry.resolution import MeshSize, sidewall_angles
from geometry.sidewall import SidewallSprings, weld_half_angle
from geometry.sidewall_mesh import elements_along
from geometry.springs import leg_sides, spring_leg, station_angles, weld_angle
from geometry.wheel import WheelDesign

__all__ = ["add_legs", "add_sidewall", "sidewall_surface"]

Array = NDArray[np.float64]
_LEAST_PER_LEG = 8
_FIRST, _LAST = np.array([[0.0, 0.0], [0.0, 1.0]]), np.array([[1.0, 0.0], [1.0, 1.0]])
"""Ends of the edges u = 0 and u = 1 of a plate."""
_HELD = math.inf
"""Stiffness against turning of an edge whose slope is held [N/rad]."""


def add_legs(
    draft: Draft, springs: SpringSet, size: MeshSize, rim: Rim, hub: Rim | float, *, touches: bool = True
) -> None:
    """Draw all legs of a set, tied to the rim where their welds end, and to the hub, or held by a rigid one.

    rim, hub : rings between which they lie, or the rigid hub's radius [m]; touches : as `Draft.add_strip`
    """
    gap = hub.outer_radius if isinstance(hub, Rim) else hub, rim.inner_radius
    half = 0.5 * weld_angle(springs, rim.inner_radius)
    layer = Layer(material=springs.material, thickness=springs.thickness)
    turning = [
        turning_stiffness(
            springs.material, springs.thickness, springs.thickness / on.thickness if isinstance(on, Rim) else None
        )
        for on in (rim, hub)
    ]
    for station in station_angles(springs):
        for side in leg_sides(springs):
            leg = spring_leg(springs, gap, station, side)
            count = size.refined(max(_LEAST_PER_LEG, math.ceil(leg.length / size.of(springs.name) - 1e-6)))
            along = np.column_stack([-leg.normals[[0, -1], 1], leg.normals[[0, -1], 0]])
            along *= np.sign(along[0] @ (leg.points[1] - leg.points[0]))
            arc = np.linspace(0.0, leg.length, len(leg.points))
            line = CubicSpline(arc, leg.points, bc_type=((1, along[0]), (1, along[1])))
            at = np.linspace(0.0, leg.length, count + 1)
            tangents = line(at, 1) / np.linalg.norm(line(at, 1), axis=1)[:, None]
            end = station + side * half
            for columns in draft.columns(springs.bands):
                steps = np.full(count, leg.length / count)
                numbers, plates = draft.add_strip(
                    springs.name, (line(at), tangents), steps, columns, leg.normals[0], touches=touches
                )
                draft.layers += [(layer,)] * plates.size
                offset, on_rim = 0.5 * (rim.thickness + springs.thickness), rim.beginning(end, columns)
                draft.ties.append(TieLine.of(plates[0], on_rim, (_FIRST, _FIRST), offset, turning[0]))
                if isinstance(hub, Rim):
                    offset, on_hub = -0.5 * (hub.thickness + springs.thickness), hub.beginning(end, columns)
                    draft.ties.append(TieLine.of(plates[-1], on_hub, (_LAST, _FIRST), offset, turning[1]))
                else:
                    draft.ends.append(HubEnd(numbers[-1], plates[-1], on_cylinder(end), turning[1]))


def add_sidewall(draft: Draft, design: WheelDesign, springs: SidewallSprings, size: MeshSize, rim: Rim) -> None:
    """Draw the strips at both sides of the wheel, or at y > 0 of its half; the clamp holds their last edges.

    They leave the rim at its edge. They touch neither rim nor hub nor each other, as in the solid model.
    """
    inner, ring = design.tire.inner_radius, rim.ring
    half, middle = weld_half_angle(springs, inner), inner - 0.5 * springs.thickness
    curl, arc, _ = elements_along(springs, size)
    lengths = math.pi * springs.curl_radius, springs.sweep * springs.arc_radius
    steps = np.repeat([lengths[0] / curl, lengths[1] / arc], [curl, arc])
    layer = Layer(material=springs.material, thickness=springs.thickness)
    offset = 0.5 * (design.tire.thickness + springs.thickness)
    turning = turning_stiffness(springs.material, springs.thickness, springs.thickness / design.tire.thickness)
    sides = (1.0,) if draft.levels[0] > -1e-12 else (1.0, -1.0)
    for station in sidewall_angles(springs):
        span = ring.span(station - half, station + half)
        rows = np.concatenate([rim.breaks[i] + np.arange(ring.counts[i]) for i in span])
        around = np.repeat([ring.step(i) / ring.counts[i] for i in span], [ring.counts[i] for i in span])
        angles = -half + np.concatenate([[0.0], np.cumsum(around)])
        at = np.concatenate([[0.0], np.cumsum(steps)])
        surface = sidewall_surface(springs, inner, 0.5 * design.tire.width, at, angles)
        c, s = math.cos(station), math.sin(station)
        for side in sides:
            # Columns of (chord, y, outwards) in the wheel's frame.
            to_wheel = np.array([[c, 0.0, s], [0.0, side, 0.0], [s, 0.0, -c]]).T
            nodes = surface @ to_wheel.T
            strip = draft.next_strip(touches=False)
            numbers, plates = draft.add_grid(springs.name, nodes, (steps, middle * around), strip, 1.0)
            draft.layers += [(layer,)] * plates.size
            edge = np.array([[0.0, 1.0], [1.0, 1.0]]) if side > 0.0 else np.array([[0.0, 0.0], [1.0, 0.0]])
            on_rim = rim.plates[rows, -1 if side > 0.0 else 0]
            draft.ties.append(TieLine.of(plates[0], on_rim, (_FIRST, edge), offset, turning))
            along, across = nodes[-1, 0, 1], to_wheel[:, 0]
            frame = np.stack([along, across, np.cross(along, across)], axis=1)
            draft.ends.append(HubEnd(numbers[-1], plates[-1], frame, _HELD))


def sidewall_surface(springs: SidewallSprings, rim: float, edge: float, at: Array, angles: Array) -> Array:
    """r, r_1, r_2, r_12 (m, n, 4, 3) of a strip's middle surface in coordinates chord, y, outwards, without its clamp.

    `geometry.sidewall_mesh` has the same surface; the second parameter is the length along the rim at the weld.

    Parameters
    ----------
    rim, edge : radius of the rim's inside, half of its width [m]
    at : (m,) length of the centreline from the rim's edge [m]
    angles : (n,) about the axle of the strip's lines at the rim, from its middle [rad]
    """
    t, A, rho = springs.thickness, springs.arc_radius, springs.curl_radius
    R, turn = rim - 0.5 * t, math.pi * rho
    curls = (at < turn * (1.0 + 1e-12))[:, None]
    theta, phi = np.minimum(at / rho, math.pi), np.maximum(at - turn, 0.0) / A
    normal = np.where(curls, np.stack([np.sin(theta), np.cos(theta)], -1), np.stack([np.sin(phi), -np.cos(phi)], -1))
    tangent = np.stack([normal[:, 1], -normal[:, 0]], axis=-1)
    bent = np.where(curls, 1.0 / rho, -1.0 / A) * tangent
    centres = np.array([edge, R - rho]), np.array([edge, R - 2.0 * rho - A])
    line = np.where(curls, centres[0] + rho * normal, centres[1] - A * normal)
    flat, rate = np.where(curls[:, 0], 0.5 * (1.0 - np.cos(theta)), 1.0), np.where(curls[:, 0], np.sin(theta), 0.0)
    flat, rate = flat[:, None], 0.5 / rho * rate[:, None]
    sine, cosine = np.sin(angles), np.cos(angles)
    # Height above the centreline's tangent plane and chord, by length, by the second parameter and by both.
    heights = -(1.0 - flat) * R * (1.0 - cosine), rate * R * (1.0 - cosine), -(1.0 - flat) * sine, rate * sine
    thick = 0.5 * t
    chords = (
        (R + thick * flat) * sine,
        thick * rate * sine,
        (1.0 + thick / R * flat) * cosine,
        thick / R * rate * cosine,
    )
    N, T, B, P = (one[:, None] for one in (normal, tangent, bent, line))
    h, h1, h2, h12 = (one[..., None] for one in heights)
    planes = P + h * N, T + h1 * N + h * B, h2 * N, h12 * N + h2 * B
    found = [
        np.stack([c, np.broadcast_to(p, (*c.shape, 2))[..., 0], np.broadcast_to(p, (*c.shape, 2))[..., 1]], axis=-1)
        for c, p in zip(chords, planes, strict=True)
    ]
    return np.stack(found, axis=2)
