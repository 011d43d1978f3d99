"""The section: which blocks share which corners."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest

from geometry.resolution import MeshSize, hub_ring, rim_ring
from geometry.section import Section, build_section
from geometry.wheel import exomars_hoops

WHEEL = exomars_hoops()


def section(*active: str, thickness_elements: int = 1) -> Section:
    size = MeshSize(element_size=8e-3, axial_size=0.02, thickness_elements=thickness_elements, refinement={})
    rings = rim_ring(WHEEL, size), hub_ring(WHEEL, size, "all")
    return build_section(WHEEL, size, rings, frozenset(active))


def test_strip_and_rim_share_one_corner_at_the_crack_tip() -> None:
    parts = section("tire", "springs_outer")
    corners = {part: set() for part in ("tire", "springs_outer")}
    for block in parts.blocks:
        corners[block.part] |= {block.inner.start, block.inner.end, block.outer.start, block.outer.end}
    shared = corners["tire"] & corners["springs_outer"]
    half_weld = 0.5 * 8e-3 / WHEEL.tire.inner_radius
    angles = sorted({round(math.atan2(*(parts.corners[key] * [1, -1])), 9) for key in shared})
    at_first = [a for a in angles if abs(a) < 0.1]
    foot = math.asin(0.5e-3 / 142.5e-3)
    assert at_first == pytest.approx([-half_weld, -foot, foot, half_weld], abs=1e-8)


def test_no_two_corners_coincide() -> None:
    everything = section(*WHEEL.materials)
    points = np.array(list(everything.corners.values()))
    distance = np.linalg.norm(points[:, None] - points[None], axis=2) + np.eye(len(points))
    assert distance.min() > 1e-5


def test_layers_through_the_thickness() -> None:
    one = Counter(block.part for block in section("tire", "springs_outer", "outer_hub").blocks)
    three = Counter(b.part for b in section("tire", "springs_outer", "outer_hub", thickness_elements=3).blocks)
    assert three == {part: 3 * count for part, count in one.items()}


def test_a_half_ring_has_at_least_eight_elements() -> None:
    size = MeshSize(element_size=0.5, axial_size=0.5, thickness_elements=1, refinement={})
    rings = rim_ring(WHEEL, size), hub_ring(WHEEL, size, "all")
    blocks = build_section(WHEEL, size, rings, frozenset({"springs_outer"})).blocks
    strips = [block for block in blocks if block.inner.centre is not None and np.any(block.inner.centre != 0.0)]
    assert len(strips) == 3 * 2 * 2
    assert all(2 * block.n_length >= 8 for block in strips)
