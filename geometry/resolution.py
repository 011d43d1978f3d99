"""How finely a wheel is divided: break angles of the rings, axial levels, element counts.

The rim and the hub rings are cut at the same angles in every axial band, so that bands meet node to node.
Verified by tests/unit/test_geometry_resolution.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.division import Interval, MeshSize, Ring, divide
from geometry.lattice import JOINTS, LATTICE
from geometry.lattice_ring import across_walls, foot_intervals
from geometry.parts import SpringSet
from geometry.sidewall import SidewallSprings, weld_half_angle
from geometry.springs import station_angles, weld_angle
from geometry.wheel import WheelDesign

__all__ = [
    "MeshSize",
    "Ring",
    "active_parts",
    "axial_bands",
    "axial_levels",
    "hub_ring",
    "part_bands",
    "part_names",
    "rim_ring",
    "sidewall_angles",
]

Parts = Literal["all", "flexible"]
_SAME_LEVEL = 1e-9


def part_names(design: WheelDesign, parts: Parts) -> tuple[str, ...]:
    """Names of the parts that are meshed; ``"flexible"`` leaves out cone, impact springs and inner hub."""
    rigid = ("cone", "impact_springs", "inner_hub") if parts == "flexible" else ()
    return tuple(name for name in design.materials if name not in rigid)


def rim_ring(design: WheelDesign, size: MeshSize) -> Ring:
    """Division of the rim: cut at grouser flanks, weld ends and walls of a lattice."""
    radius = design.tire.inner_radius
    intervals: list[Interval] = []
    if design.grousers is not None:
        half = math.asin(0.5 * design.grousers.thickness / design.ground_radius)
        for k in range(design.grousers.count):
            middle = design.grousers.phase + 2.0 * math.pi * k / design.grousers.count
            intervals.append((middle - half, middle + half, math.inf))
    for springs in design.spring_sets:
        intervals += _weld_intervals(springs, radius, size.of(springs.name) / radius)
    if design.sidewall_springs is not None:
        half = weld_half_angle(design.sidewall_springs, radius)
        limit = size.of(design.sidewall_springs.name) / radius
        intervals += [(a - half, a + half, limit) for a in sidewall_angles(design.sidewall_springs)]
    grouser = [(a, b) for a, b, limit in intervals if limit == math.inf]
    if design.lattice is not None:
        intervals += foot_intervals(design.lattice, design.lattice.layers, radius, size)
    ring = divide(intervals, size.of("tire") / design.tire.outer_radius)
    counts = np.array([size.refined(int(n)) for n in ring.counts])
    for a, b in grouser:
        for i in ring.span(a, b):
            share = ring.step(i) / (b - a)
            counts[i] = max(ring.counts[i], math.ceil(size.thickness_elements * share - 1e-6))
    ring = Ring(angles=ring.angles, counts=counts)
    return ring if design.lattice is None else across_walls(ring, design.lattice, design.lattice.layers, radius, size)


def sidewall_angles(springs: SidewallSprings) -> NDArray[np.float64]:
    """Circumferential positions of the strips' middles, shape (count,) [rad]."""
    return springs.phase + 2.0 * math.pi / springs.count * np.arange(springs.count, dtype=np.float64)


def hub_ring(design: WheelDesign, size: MeshSize, parts: Parts) -> Ring:
    """Division shared by outer hub, cone and inner hub: cut at the ends of the welds on them."""
    intervals: list[Interval] = []
    hub = design.outer_hub.outer_radius
    for springs in design.spring_sets:
        intervals += _weld_intervals(springs, design.tire.inner_radius, size.of(springs.name) / hub)
    impact = design.impact_springs
    names = part_names(design, parts)
    if design.lattice is not None:
        intervals += foot_intervals(design.lattice, 0, hub, size)
    if impact is not None and impact.name in names:
        bore = design.outer_hub.inner_radius
        intervals += _weld_intervals(impact, bore, size.of(impact.name) / bore)
    largest = size.of("outer_hub") / hub
    if "cone" in names:
        largest = min(largest, size.of("cone") / hub)
    if design.inner_hub is not None and "inner_hub" in names:
        largest = min(largest, size.of("inner_hub") / design.inner_hub.outer_radius)
    ring = divide(intervals, largest)
    ring = Ring(angles=ring.angles, counts=np.array([size.refined(int(n)) for n in ring.counts]))
    return ring if design.lattice is None else across_walls(ring, design.lattice, 0, hub, size)


def _weld_intervals(springs: SpringSet, rim: float, largest: float) -> list[Interval]:
    half = 0.5 * weld_angle(springs, rim)
    return [(a - half, a + half, largest) for a in station_angles(springs)]


def axial_levels(design: WheelDesign, parts: Parts, half_width: bool) -> NDArray[np.float64]:
    """Axial positions [m] where the section changes, increasing; InputError for half of a wheel without symmetry."""
    names = part_names(design, parts)
    levels = [0.0]
    for name, bands in part_bands(design).items():
        if name not in names:
            continue
        if half_width and not _symmetric(bands):
            rule = "half width needs bands that mirror each other about y = 0"
            shown = ", ".join(f"{1e3 * y0:g}..{1e3 * y1:g} mm" for y0, y1 in bands)
            raise InputError(f"{name} bands", shown, rule, "mesh the full width (half_width = false)")
        levels += [y for band in bands for y in band]
    if design.sidewall_springs is not None:
        inner = 0.5 * design.tire.width - design.sidewall_springs.weld_length
        levels += [inner, -inner]
    joints = cone_joints(design) if "cone" in names else ()
    levels += [y for joint in joints for y in joint]
    ordered = np.sort(np.array(levels))
    kept = ordered[np.concatenate([[True], np.diff(ordered) > _SAME_LEVEL])]
    for low, high in joints:
        inside = kept[(kept > low + _SAME_LEVEL) & (kept < high - _SAME_LEVEL)]
        if len(inside):
            rule = f"its joint {low * 1e3:.4g}..{high * 1e3:.4g} mm is cut by the band edge at {inside[0] * 1e3:.4g} mm"
            raise InputError("cone position", f"{0.5e3 * (low + high):.4g} mm", rule, "move the cone or the band")
    return np.asarray(kept[kept >= -_SAME_LEVEL] if half_width else kept, dtype=np.float64)


def axial_bands(design: WheelDesign, size: MeshSize, levels: NDArray[np.float64]) -> list[tuple[float, float, int]]:
    """Axial bands (y0 [m], y1 [m], elements); the joints of the cone have as many elements as its thickness.

    With an ``edge_size`` a band that is long enough has one element of that length at each of its ends.
    """
    joints = cone_joints(design)
    bands = []
    for low, high in pairwise(float(level) for level in levels):
        if any(abs(a - low) < _SAME_LEVEL and abs(b - high) < _SAME_LEVEL for a, b in joints):
            bands.append((low, high, size.thickness_elements))
            continue
        for a, b in pairwise(_with_edges(low, high, size)):
            bands.append((a, b, size.refined(max(1, math.ceil((b - a) / size.axial_size - 1e-6)))))
    return bands


def _with_edges(low: float, high: float, size: MeshSize) -> list[float]:
    """A band's ends [m] and, where it is more than twice as long as they, the inner ends of its edge elements."""
    edge = size.edge_size
    at_low, at_high = (abs(y) > _SAME_LEVEL for y in (low, high))
    if edge is None or edge >= size.axial_size or high - low <= (at_low + at_high) * 2.0 * edge:
        return [low, high]
    return [low, *([low + edge] if at_low else []), *([high - edge] if at_high else []), high]


def active_parts(design: WheelDesign, names: Iterable[str], middle: float) -> frozenset[str]:
    """Parts of ``names`` (the cone apart) whose section is there at the axial position ``middle`` [m]."""
    bands = part_bands(design)
    return frozenset(n for n in names if n in bands and any(a < middle < b for a, b in bands[n]))


def cone_joints(design: WheelDesign) -> tuple[tuple[float, float], ...]:
    """Axial extents [m] of the cone's joints: outer, inner, and their mirror images."""
    if design.cone is None or design.inner_hub is None:
        return ()
    half = 0.5 * design.cone.axial_width(design.outer_hub.inner_radius, design.inner_hub.outer_radius)
    joints = [(y - half, y + half) for y in (design.cone.outer_position, design.cone.inner_position)]
    return tuple(joints + [(-high, -low) for low, high in joints])


def part_bands(design: WheelDesign) -> dict[str, tuple[tuple[float, float], ...]]:
    """Axial bands [m] of every part made by extrusion: all but the cone, sidewall springs and a hub of clamps alone."""
    half = 0.5 * design.tire.width
    bands: dict[str, tuple[tuple[float, float], ...]] = {"tire": ((-half, half),)}
    ground = bands["tire"]
    if design.tread is not None:
        half = 0.5 * (design.tread.width or design.tire.width)
        bands["tread"] = ground = ((-half, half),)
    if design.grousers is not None:
        bands["grousers"] = ground
    sets = (*design.spring_sets, *([design.impact_springs] if design.impact_springs else []))
    bands |= {springs.name: springs.bands for springs in sets}
    if design.lattice is not None:
        bands |= {LATTICE: design.lattice.bands, JOINTS: design.lattice.bands}
    carries_springs = bool(design.spring_sets) or design.lattice is not None or design.inner_hub is not None
    for name, ring in (("outer_hub", design.outer_hub if carries_springs else None), ("inner_hub", design.inner_hub)):
        if ring is not None:
            bands[name] = ((-0.5 * ring.width, 0.5 * ring.width),)
    return bands


def _symmetric(bands: tuple[tuple[float, float], ...]) -> bool:
    mirrored = sorted((-b, -a) for a, b in bands)
    return bool(np.allclose(sorted(bands), mirrored, rtol=0.0, atol=_SAME_LEVEL))
