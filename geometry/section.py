"""The wheel's section in the x-z plane as four-sided blocks with shared corners.

A spring and the rim beside its weld's end share one corner (the crack tip) and nothing beyond.
Verified by tests/unit/test_geometry_section.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from geometry.blocks import Block, Curve, Draft, Key, Section
from geometry.lattice import LATTICE
from geometry.lattice_section import add_lattice
from geometry.parts import Grousers, HubRing, SpringSet, Tread
from geometry.resolution import MeshSize, Ring
from geometry.springs import Leg, leg_sides, polar, spring_leg, station_angles, weld_angle
from geometry.wheel import WheelDesign

__all__ = ["build_section"]

Array = NDArray[np.float64]

_LEAST_PER_HALF_RING = 8


def build_section(design: WheelDesign, size: MeshSize, rings: tuple[Ring, Ring], active: frozenset[str]) -> Section:
    """Return the blocks of the parts named in ``active``.

    Parameters
    ----------
    design : the wheel
    size : element sizes
    rings : divisions of the rim and of the hub
    active : names of the parts this axial band has
    """
    draft = Draft(size=size)
    rim, hub = rings
    if "tire" in active:
        _add_rim(draft, design, rim)
    if design.tread is not None and "tread" in active:
        _add_tread(draft, design.tread, design.tire.outer_radius, rim)
    if design.grousers is not None and "grousers" in active:
        surface = "rim_out" if design.tread is None else "tread_out"
        _add_grousers(draft, design.grousers, (surface, design.ground_radius), rim)
    for name, part in (("outer_hub", design.outer_hub), ("inner_hub", design.inner_hub)):
        if part is not None and name in active:
            _add_hub(draft, name, part, hub)
    for springs in design.spring_sets:
        if springs.name in active:
            gap = (design.outer_hub.outer_radius, design.tire.inner_radius)
            _add_springs(draft, springs, gap, (("rim_in", rim), ("outer_hub_out", hub)))
    if design.lattice is not None and LATTICE in active:
        add_lattice(draft, design.lattice, (design.outer_hub.outer_radius, design.tire.inner_radius), rings)
    impact = design.impact_springs
    if impact is not None and design.inner_hub is not None and impact.name in active:
        gap = (design.inner_hub.outer_radius, design.outer_hub.inner_radius)
        _add_springs(draft, impact, gap, (("outer_hub_in", hub), ("inner_hub_out", hub)))
    return Section(corners=draft.corners, blocks=tuple(draft.blocks))


def _add_rim(draft: Draft, design: WheelDesign, ring: Ring) -> None:
    radii = design.tire.inner_radius, design.tire.outer_radius
    for i in range(len(ring.angles)):
        groups = {"inner": "tire_inner", "outer": "tire_outer"}
        draft.add_ring_piece("tire", (("rim_in", "rim_out"), radii), ring, i, groups)


def _add_tread(draft: Draft, tread: Tread, radius: float, ring: Ring) -> None:
    """A layer on the rim's outer surface at ``radius``, as many elements through it as its size asks for."""
    size = draft.size
    least = max(size.thickness_elements, math.ceil(tread.thickness / size.of("tread") - 1e-6))
    radii = radius, radius + tread.thickness
    for i in range(len(ring.angles)):
        groups = {"outer": "tread_outer"}
        draft.add_ring_piece("tread", (("rim_out", "tread_out"), radii), ring, i, groups, size.refined(least))


def _add_grousers(draft: Draft, fins: Grousers, surface: tuple[str, float], ring: Ring) -> None:
    """Fins with parallel flanks on a surface of the rim's division; its name and radius [m]."""
    name, radius = surface
    half, tip = 0.5 * fins.thickness, radius + fins.height
    n_height = draft.size.refined(max(1, math.ceil(fins.height / draft.size.of("grousers") - 1e-6)))
    foot_angle = math.asin(half / radius)
    for k in range(fins.count):
        middle = fins.phase + 2.0 * math.pi * k / fins.count
        for i in ring.span(middle - foot_angle, middle + foot_angle):
            ends: list[Key] = []
            for j in (i, (i + 1) % len(ring.angles)):
                offset = (ring.angle(j) - middle + math.pi) % (2.0 * math.pi) - math.pi
                at_tip = middle + math.asin(radius * math.sin(offset) / tip)
                ends.append(draft.corner(("tip", k, j), polar(tip, at_tip)))
            draft.blocks.append(
                Block(
                    part="grousers",
                    inner=draft.ring_arc(name, radius, ring, i),
                    outer=Curve(start=ends[0], end=ends[1], centre=np.zeros(2)),
                    n_length=int(ring.counts[i]),
                    n_thickness=n_height,
                    groups={"outer": "grouser_outer", "ends": "grouser_outer"},
                )
            )


def _add_hub(draft: Draft, name: str, hub: HubRing, ring: Ring) -> None:
    surfaces = (f"{name}_in", f"{name}_out"), (hub.inner_radius, hub.outer_radius)
    for i in range(len(ring.angles)):
        draft.add_ring_piece(name, surfaces, ring, i, {"inner": f"{name}_bore", "outer": f"{name}_outer"})


def _add_springs(
    draft: Draft,
    springs: SpringSet,
    gap: tuple[float, float],
    surfaces: tuple[tuple[str, Ring], tuple[str, Ring]],
) -> None:
    """Welds and strips of one set; ``surfaces`` names the corners and division of the outer and the inner ring."""
    hub_radius, rim_radius = gap
    half, t, t_hub = 0.5 * weld_angle(springs, rim_radius), springs.thickness, springs.hub_thickness
    (rim_name, rim), (hub_name, hub) = surfaces
    at_rim, at_hub = (f"{springs.name}_rim", rim_name), (f"{springs.name}_hub", hub_name)
    back = {"inner": f"{springs.name}_back"}
    for station in station_angles(springs):
        for i in rim.span(station - half, station + half):
            draft.add_ring_piece(springs.name, (at_rim, (rim_radius - t, rim_radius)), rim, i, back)
        for i in hub.span(station - half, station + half):
            draft.add_ring_piece(springs.name, (at_hub, (hub_radius + t_hub, hub_radius)), hub, i, back)
        for side in leg_sides(springs):
            leg = spring_leg(springs, gap, station, side)
            i, j = rim.index(station + side * half), hub.index(station + side * half)
            start: list[Key] = [(name, i) for name in draft.level_names(*at_rim)]
            end: list[Key] = [(name, j) for name in draft.level_names(*at_hub)]
            _add_leg(draft, springs, leg, (i, side), (start, end))


def _add_leg(
    draft: Draft, springs: SpringSet, leg: Leg, key: tuple[int, int], ends: tuple[list[Key], list[Key]]
) -> None:
    """Blocks of one strip; ``ends`` are the corners, inside to outside, it shares with the welds on rim and hub."""
    stride = (len(leg.points) - 1) // leg.segments
    per_half_ring = max(_LEAST_PER_HALF_RING, math.ceil(leg.length / draft.size.of(springs.name) - 1e-6))
    thickness = springs.thickness_at(np.linspace(0.0, 1.0, len(leg.points)))
    lines = [
        leg.points + (height * thickness)[:, None] * leg.normals for height in np.linspace(-0.5, 0.5, len(ends[0]))
    ]
    slopes = [_tangents(springs, leg, line) for line in lines]
    centre = None if springs.tapered else leg.centre
    stations = [ends[0]]
    for s in range(1, leg.segments):
        names: list[Key] = [(springs.name, *key, s, level) for level in range(len(lines))]
        stations.append([draft.corner(n, line[s * stride]) for n, line in zip(names, lines, strict=True)])
    stations.append(ends[1])
    for s in range(leg.segments):
        piece = slice(s * stride, (s + 1) * stride + 1)
        curves = [
            _leg_curve(centre, line[piece], slope[piece], (stations[s][k], stations[s + 1][k]))
            for k, (line, slope) in enumerate(zip(lines, slopes, strict=True))
        ]
        sides = {"inner": f"{springs.name}_back", "outer": f"{springs.name}_front"}
        count = draft.size.refined(math.ceil(per_half_ring / leg.segments))
        draft.add_layers(springs.name, curves, count, sides)


def _tangents(springs: SpringSet, leg: Leg, line: Array) -> Array:
    """Unit tangents of a line beside a leg's centreline, (n, 2): across its normals where it is as far everywhere."""
    if springs.tapered:
        from scipy.interpolate import CubicSpline

        slope = CubicSpline(np.linspace(0.0, 1.0, len(line)), line)(np.linspace(0.0, 1.0, len(line)), 1)
        return np.asarray(slope / np.linalg.norm(slope, axis=1)[:, None])
    tangents = np.column_stack([-leg.normals[:, 1], leg.normals[:, 0]])
    return -tangents if np.dot(tangents[0], line[1] - line[0]) < 0.0 else tangents


def _leg_curve(centre: Array | None, points: Array, tangents: Array, ends: tuple[Key, Key]) -> Curve:
    if centre is not None:
        return Curve(start=ends[0], end=ends[1], centre=centre)
    return Curve(start=ends[0], end=ends[1], through=points[1:-1], tangents=tangents[[0, -1]])
