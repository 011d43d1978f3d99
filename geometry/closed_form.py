"""Volumes and joint areas of a wheel's parts in closed form, from its dimensions alone.

With a strip of thickness t along a centreline of length L the section is exactly t L (offset curves): a semicircle of
radius R gives pi R t. Where t varies it is the mean thickness times L, for the part of curvature cancels across the
strip. Verified by tests/verification/test_mesh_volume.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from contracts.materials import Material
from geometry.lattice import JOINTS, LATTICE, Lattice, lattice_plan, wall_half_angle
from geometry.parts import Grousers, SpringSet
from geometry.resolution import part_bands
from geometry.sidewall import SidewallSprings, weld_half_angle
from geometry.springs import leg_sides, spring_leg, weld_angle
from geometry.wheel import WheelDesign

__all__ = ["closed_form_joint_areas", "closed_form_volume", "part_masses"]


def closed_form_volume(design: WheelDesign, half_width: bool = True) -> Mapping[str, float]:
    """Volume of each part [m^3], over y >= 0 or over the full width.

    tire and hubs: pi (r_o^2 - r_i^2) w; weld of angle a: a/2 (r_o^2 - r_i^2) w; strip: L t w; cone with joints of axial
    width b: pi (r_o^2 - r_i^2) b; sidewall strip: L t b;
    grouser: w int_{-t/2}^{t/2} sqrt((R + h)^2 - x^2) - sqrt(R^2 - x^2) dx; a lattice's wall: t times the mean length of
    its sides between joints, which begin t/2 cot(gamma/2) from a joint's middle, gamma the angle to the next wall; a
    joint: the triangle of the points (t/2) / sin(gamma/2) from the middle half way between two walls.
    """
    widths = {name: _width(bands, half_width) for name, bands in part_bands(design).items()}
    rim = design.tire.inner_radius
    sections = {"tire": math.pi * (design.tire.outer_radius**2 - rim**2)}
    if design.grousers is not None:
        sections["grousers"] = _grouser_section(design.grousers, design.ground_radius)
    if design.tread is not None:
        sections["tread"] = math.pi * (design.ground_radius**2 - design.tire.outer_radius**2)
    for springs in design.spring_sets:
        sections[springs.name] = _spring_section(springs, (design.outer_hub.outer_radius, rim))
    if design.lattice is not None:
        sections |= _lattice_sections(design.lattice, (design.outer_hub.outer_radius, rim))
    for name, ring in (("outer_hub", design.outer_hub), ("inner_hub", design.inner_hub)):
        if ring is not None and name in widths:
            sections[name] = math.pi * (ring.outer_radius**2 - ring.inner_radius**2)
    if design.impact_springs is not None and design.inner_hub is not None:
        gap = (design.inner_hub.outer_radius, design.outer_hub.inner_radius)
        sections["impact_springs"] = _spring_section(design.impact_springs, gap)
    volumes = {name: section * widths[name] for name, section in sections.items()}
    if design.cone is not None and design.inner_hub is not None:
        r_o, r_i = design.outer_hub.inner_radius, design.inner_hub.outer_radius
        cones = 1.0 if half_width else 2.0
        volumes["cone"] = cones * math.pi * (r_o**2 - r_i**2) * design.cone.axial_width(r_o, r_i)
    if design.sidewall_springs is not None:
        sides = 1.0 if half_width else 2.0
        volumes |= {n: sides * v for n, v in _sidewall_volumes(design.sidewall_springs, rim).items()}
    return {name: volumes[name] for name in design.materials}


def closed_form_joint_areas(design: WheelDesign, half_width: bool = True) -> Mapping[tuple[str, str], float]:
    """Area [m^2] over which two parts are bonded, by their names in alphabetical order."""
    widths = {name: _width(bands, half_width) for name, bands in part_bands(design).items()}
    areas: dict[tuple[str, str], float] = {}

    def add(a: str, b: str, area: float) -> None:
        areas[(a, b) if a < b else (b, a)] = area

    tire, hub, inner = design.tire, design.outer_hub, design.inner_hub
    if design.grousers is not None:
        radius = design.ground_radius
        foot = 2.0 * radius * math.asin(0.5 * design.grousers.thickness / radius)
        base = "tire" if design.tread is None else "tread"
        add(base, "grousers", design.grousers.count * foot * widths[base])
    if design.tread is not None:
        add("tire", "tread", 2.0 * math.pi * tire.outer_radius * widths["tread"])
    if design.lattice is not None:
        lattice, width = design.lattice, widths[LATTICE]
        feet = lattice.cells * lattice.weld_length * width
        add(JOINTS, "tire", feet)
        add(JOINTS, "outer_hub", feet)
        add(LATTICE, JOINTS, width * _wall_ends(lattice, (hub.outer_radius, tire.inner_radius)))
    for springs in design.spring_sets:
        angle = springs.count * weld_angle(springs, tire.inner_radius) * widths[springs.name]
        add(springs.name, "tire", angle * tire.inner_radius)
        add(springs.name, "outer_hub", angle * hub.outer_radius)
    sidewall = design.sidewall_springs
    if sidewall is not None:
        strips = sidewall.count * (1.0 if half_width else 2.0)
        arc = 2.0 * weld_half_angle(sidewall, tire.inner_radius) * tire.inner_radius
        add(sidewall.name, "tire", strips * arc * sidewall.weld_length)
        add(sidewall.name, "outer_hub", strips * sidewall.width * sidewall.thickness)
    if inner is not None and design.impact_springs is not None:
        impact = design.impact_springs
        angle = impact.count * weld_angle(impact, hub.inner_radius) * widths["impact_springs"]
        add("impact_springs", "outer_hub", angle * hub.inner_radius)
        add("impact_springs", "inner_hub", angle * inner.outer_radius)
    if inner is not None and design.cone is not None:
        joint = design.cone.axial_width(hub.inner_radius, inner.outer_radius) * (1.0 if half_width else 2.0)
        add("cone", "outer_hub", 2.0 * math.pi * hub.inner_radius * joint)
        add("cone", "inner_hub", 2.0 * math.pi * inner.outer_radius * joint)
    return areas


def part_masses(volumes: Mapping[str, float], materials: Mapping[str, Material]) -> Mapping[str, float]:
    """Mass of each part [kg] from its volume [m^3] and the density of its material."""
    return {name: volume * materials[name].density for name, volume in volumes.items()}


def _width(bands: tuple[tuple[float, float], ...], half_width: bool) -> float:
    return sum((max(b, 0.0) - max(a, 0.0)) if half_width else b - a for a, b in bands)


def _spring_section(springs: SpringSet, gap: tuple[float, float]) -> float:
    """Section area [m^2] of all strips and welds of a set."""
    hub, rim = gap
    t, t_hub, angle = springs.thickness, springs.hub_thickness, weld_angle(springs, rim)
    welds = 0.5 * angle * (rim**2 - (rim - t) ** 2 + (hub + t_hub) ** 2 - hub**2)
    sides = leg_sides(springs)
    if springs.shape == "spline":
        length = spring_leg(springs, gap, 0.0, sides[0]).length
    else:
        length = math.pi * 0.5 * (rim - hub - 0.5 * (t + t_hub))
    strip = length * springs.mean_thickness
    return springs.count * (welds + len(sides) * strip)


def _sidewall_volumes(springs: SidewallSprings, rim: float) -> dict[str, float]:
    """Volume [m^3] of the strips at one side and of their clamped ends.

    On the curl the section, curved like the rim at first (mid-surface radius R), lies nearer to the curl's axis by
    width^2 / (24 R) in the mean, fading out as (1 + cos theta) / 2; Pappus' rule then takes off pi / 2 of that length.
    """
    weld = weld_half_angle(springs, rim) * (rim**2 - (rim - springs.thickness) ** 2) * springs.weld_length
    section = springs.width * springs.thickness
    nearer = springs.width**2 / (24.0 * (rim - 0.5 * springs.thickness))
    return {
        springs.name: springs.count * (weld + (springs.free_length - 0.5 * math.pi * nearer) * section),
        "outer_hub": springs.count * springs.clamp_length * section,
    }


def _grouser_section(grousers: Grousers, radius: float) -> float:
    half = 0.5 * grousers.thickness
    return grousers.count * (_under_arc(radius + grousers.height, half) - _under_arc(radius, half))


def _under_arc(radius: float, half: float) -> float:
    """Area [m^2] between the axle and an arc of this radius, within ``half`` [m] to either side of a ray."""
    return half * math.sqrt(radius * radius - half * half) + radius * radius * math.asin(half / radius)


def _lattice_sections(lattice: Lattice, gap: tuple[float, float]) -> dict[str, float]:
    """Section areas [m^2] of all walls, and of joints and feet."""
    plan, t, n = lattice_plan(lattice, gap), lattice.thickness, lattice.cells
    hub, rim = gap
    sides = sum(end - start for start, end in plan.rows) + 2.0 * sum(plan.oblique_lengths(lattice.pitch))
    triangles = 0.0
    for joint in (joint for joints in plan.joints for joint in joints):
        sides -= float(joint.cuts(t).mean(axis=1).sum())
        reach, turned = 0.5 * t / np.sin(0.5 * joint.gaps), 0.5 * (joint.gaps + np.roll(joint.gaps, -1))
        triangles += 0.5 * float(np.sum(reach * np.roll(reach, -1) * np.sin(turned)))
    on_feet = t * hub - _under_arc(hub + t, 0.5 * t) + _under_arc(rim - t, 0.5 * t) - t * rim
    feet = 0.5 * lattice.weld_length * (((hub + t) ** 2 - hub**2) / hub + (rim**2 - (rim - t) ** 2) / rim)
    return {LATTICE: n * (t * sides + on_feet), JOINTS: n * (triangles + feet)}


def _wall_ends(lattice: Lattice, gap: tuple[float, float]) -> float:
    """Length [m] of all lines in the section on which walls end: at joints askew, on feet along their arcs."""
    plan, t = lattice_plan(lattice, gap), lattice.thickness
    askew = [np.hypot(t, np.diff(joint.cuts(t), axis=1)) for joints in plan.joints for joint in joints]
    tops = (gap[0] + t, gap[1] - t)
    arcs = sum(2.0 * radius * wall_half_angle(lattice, radius) for radius in tops)
    return lattice.cells * (float(np.sum(askew)) + arcs)
