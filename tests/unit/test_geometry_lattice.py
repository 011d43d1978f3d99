"""A lattice between rings: its plan, joints, rules, face groups, and how it divides the rings."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped]

from contracts.errors import InputError
from geometry.closed_form import closed_form_volume
from geometry.lattice import CELL, JOINTS, LATTICE, Lattice, lattice_plan
from geometry.lattice_ring import across_walls
from geometry.parts import Grousers, HubRing, SpringSet, Tire, Tread
from geometry.planar import build_planar_mesh, planar_areas
from geometry.resolution import MeshSize, hub_ring, rim_ring
from geometry.section import build_section
from geometry.wheel import WheelDesign
from reference_fe.contact.inner_pairs import wheel_contact_pairs
from tests.lattice_frame import walls

GAP = (0.05, 0.1415)
HONEYCOMB = Lattice(
    kind="honeycomb", cells=12, layers=2, thickness=1e-3, weld_length=6e-3, bands=((-0.05, 0.05),), phase=0.1
)
RE_ENTRANT = replace(HONEYCOMB, kind="re_entrant", angle=math.radians(25.0))
BOTH = pytest.mark.parametrize("lattice", [HONEYCOMB, RE_ENTRANT], ids=lambda lattice: lattice.kind)


def wheel(lattice: Lattice = HONEYCOMB, **changes: Any) -> WheelDesign:
    parts: dict[str, Any] = {
        "tire": Tire(outer_radius=0.1425, width=0.1, thickness=1e-3),
        "grousers": None,
        "spring_sets": (),
        "lattice": lattice,
        "outer_hub": HubRing(outer_radius=0.05, thickness=2e-3, width=0.1),
        "cone": None,
        "impact_springs": None,
        "inner_hub": None,
    }
    return WheelDesign(**parts | changes)


def sizes(design: WheelDesign, **changes: Any) -> tuple[MeshSize, Any]:
    size = MeshSize(**{"element_size": 6e-3, "axial_size": 0.02, "thickness_elements": 1, "refinement": {}} | changes)
    return size, (rim_ring(design, size), hub_ring(design, size, "flexible"))


@BOTH
def test_radial_walls_are_equal_and_fill_the_gap(lattice: Lattice) -> None:
    plan = lattice_plan(lattice, GAP)
    lengths = [end - start for start, end in plan.rows]
    assert lengths == pytest.approx([lengths[0]] * 3)
    assert (plan.rows[0][0], plan.rows[-1][1]) == GAP
    rises = [outer.radius - inner.radius for inner, outer in plan.joints]
    assert all(rise > 0.0 for rise in rises) == (lattice.kind == "honeycomb")


@BOTH
def test_oblique_walls_have_the_angle_at_their_middle(lattice: Lattice) -> None:
    inner, outer = lattice_plan(lattice, GAP).joints[0]
    half = 0.5 * lattice.pitch
    a = inner.radius * np.array([0.0, 1.0])
    b = outer.radius * np.array([math.sin(half), math.cos(half)])
    along, middle = b - a, 0.5 * half
    hoop, out = np.array([math.cos(middle), -math.sin(middle)]), np.array([math.sin(middle), math.cos(middle)])
    sign = 1.0 if lattice.kind == "honeycomb" else -1.0
    assert math.atan2(along @ out, along @ hoop) == pytest.approx(sign * lattice.angle, abs=1e-12)


def test_hexagons_meet_at_120_degrees_but_for_the_wheels_curvature() -> None:
    for inner, outer in lattice_plan(replace(HONEYCOMB, cells=60, layers=4, thickness=0.2e-3), GAP).joints:
        for joint in (inner, outer):
            assert np.degrees(joint.gaps) == pytest.approx(120.0, abs=3.01)
            assert joint.gaps.sum() == pytest.approx(2.0 * math.pi)


@BOTH
def test_joints_are_as_wide_as_their_walls(lattice: Lattice) -> None:
    """The corners on either side of a wall lie half a thickness from its middle line, where `cuts` says."""
    for joint in (joint for joints in lattice_plan(lattice, GAP).joints for joint in joints):
        corners, cuts = joint.corners(1e-3), joint.cuts(1e-3)
        for k, arm in enumerate(joint.arms):
            across = np.array([-arm[1], arm[0]])
            assert corners[[k, k - 1]] @ across == pytest.approx([0.5e-3, -0.5e-3])
            assert corners[[k - 1, k]] @ arm == pytest.approx(cuts[k])


@BOTH
def test_area_is_that_of_the_walls_united(lattice: Lattice) -> None:
    """Strips about the middle lines, united by shapely, are what the closed form says: overlaps count once."""
    design, lines = wheel(lattice), middle_lines(lattice)
    bent = list(lines)
    for node in {end for line in lines for end in line.coords if 0.051 < math.hypot(*end) < 0.1405}:
        far = sorted(
            (next(end for end in line.coords if end != node) for line in lines if node in line.coords),
            key=lambda end: math.atan2(end[1] - node[1], end[0] - node[0]),
        )
        for k in range(3):
            turns = [math.atan2(end[1] - node[1], end[0] - node[0]) for end in (far[k - 1], far[k])]
            if (turns[1] - turns[0]) % (2.0 * math.pi) > math.pi:  # an outer corner, where walls end in a mitre
                bent.append(shapely.LineString([far[k - 1], node, far[k]]))
    strips = [line.buffer(0.5e-3, cap_style="flat", join_style="mitre") for line in bent]
    ring = [shapely.Point(0.0, 0.0).buffer(r, quad_segs=2000) for r in (GAP[0] + 1e-3, GAP[1] - 1e-3)]
    area = shapely.union_all(strips).intersection(ring[1].difference(ring[0])).area
    volumes = closed_form_volume(design, half_width=False)
    feet = 12 * 3e-3 * sum(abs(r**2 - s**2) / r for r, s in ((GAP[0], GAP[0] + 1e-3), (GAP[1], GAP[1] - 1e-3)))
    assert (volumes[LATTICE] + volumes[JOINTS]) / 0.1 == pytest.approx(area + feet, rel=2e-6)


@BOTH
@pytest.mark.parametrize("through", [1, 2, 3])
def test_mesh_has_the_area_and_even_numbers_across_walls(lattice: Lattice, through: int) -> None:
    design = wheel(lattice)
    mesh = build_planar_mesh(design, element_size=6e-3, thickness_elements=through)
    areas, exact = planar_areas(mesh), closed_form_volume(design, half_width=False)
    assert {part: areas[part] * 0.1 for part in areas} == pytest.approx(exact, rel=2e-6)
    size, rings = sizes(design, thickness_elements=through)
    blocks = build_section(design, size, rings, frozenset({LATTICE, JOINTS})).blocks
    assert {block.n_thickness for block in blocks if block.part == LATTICE} == {math.ceil(0.5 * through)}


@BOTH
def test_each_cell_is_a_face_group_that_its_walls_close(lattice: Lattice) -> None:
    """A step out of the body leads from each facet of a group into one and the same cell, no two into the same."""
    mesh = build_planar_mesh(wheel(lattice), element_size=6e-3)
    rings = [shapely.Point(0.0, 0.0).buffer(r, quad_segs=200).exterior for r in (GAP[0] - 1e-4, GAP[1] + 1e-4)]
    longer = [shapely.LineString([_beyond(a, b), _beyond(b, a)]) for a, b in (x.coords for x in middle_lines(lattice))]
    cells = list(shapely.polygonize([shapely.unary_union([*longer, *rings])]).geoms)
    cells = [cell for cell in cells if cell.area > 1e-5 and cell.area < math.pi * 0.049**2]
    assert len(cells) == 12 * 3
    found, tree = [], shapely.STRtree(cells)
    for name in (name for name in mesh.faces if name.startswith(CELL)):
        edges = mesh.points[mesh.facets[mesh.facet_tags == mesh.faces[name]][:, :2]]
        along = edges[:, 1] - edges[:, 0]
        out = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
        points = shapely.points(edges.mean(axis=1) + 1e-4 * out)
        of_point, inside = tree.query(points, predicate="within")
        assert len(of_point) == len(points)
        assert len(set(inside.tolist())) == 1
        found.append(int(inside[0]))
    assert sorted(found) == list(range(36))


def _beyond(end: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    """A hundredth of a line beyond one of its ends."""
    return (end[0] + 0.01 * (end[0] - other[0]), end[1] + 0.01 * (end[1] - other[1]))


def middle_lines(lattice: Lattice) -> list[shapely.LineString]:
    """Middle lines of all walls."""
    radii = [r for row in lattice_plan(lattice, GAP).rows for r in row]
    ends = [[(radii[ring], lattice.phase + 0.5 * lattice.pitch * i) for ring, i in wall] for wall in walls(lattice)]
    return [
        shapely.LineString([(round(r * math.sin(phi), 12), round(-r * math.cos(phi), 12)) for r, phi in wall])
        for wall in ends
    ]


def test_walls_may_touch_within_their_cell_and_the_ring_beside_it() -> None:
    mesh = build_planar_mesh(wheel(), element_size=6e-3)
    pairs = {(pair.slave, pair.master) for pair in wheel_contact_pairs(mesh)}
    assert ("lattice_cell_1_0", "lattice_cell_1_0") in pairs
    assert ("lattice_cell_0_3", "outer_hub_outer") in pairs
    assert ("lattice_cell_2_3", "tire_inner") in pairs
    assert len(pairs) == 36 + 12 + 12 + 1
    assert ("tire_inner", "outer_hub_outer") in pairs


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"kind": "cross"}, "kind", "is not known"),
        ({"cells": 2}, "cells", "at least 3"),
        ({"angle": math.radians(85.0)}, "angle", "between 0 and 80 deg"),
        ({"weld_length": 1.5e-3}, "weld_length", "at least two thicknesses"),
        ({"layers": 9, "angle": 1.0}, "lattice.angle", "leaves no room for radial walls"),
        ({"thickness": 12e-3, "weld_length": 25e-3}, "lattice.thickness", "less than a thickness"),
        ({"kind": "re_entrant", "angle": math.radians(62.0)}, "lattice.angle", "meet at"),
        ({"weld_length": 30e-3}, "lattice.weld_length", "spacing of the feet"),
        ({"kind": "re_entrant", "cells": 6, "layers": 3, "angle": math.radians(38.0)}, "lattice.angle", "not joined"),
        ({"cells": 10, "layers": 3, "angle": math.radians(44.0)}, "lattice.angle", "to a ring"),
        ({"bands": ((-0.06, 0.06),)}, "lattice.bands", "leaves the rings"),
    ],
)
def test_what_does_not_fit_is_refused(changes: dict[str, Any], key: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as error:
        wheel(replace(HONEYCOMB, **changes))
    assert error.value.key == key


def test_springs_beside_a_lattice_are_refused() -> None:
    springs = SpringSet(name="springs", count=3, bands=((-0.05, 0.05),), thickness=1e-3, shape="arc", weld_length=6e-3)
    with pytest.raises(InputError, match="cannot be combined with springs"):
        wheel(spring_sets=(springs,))


def test_a_grouser_flank_under_a_wall_is_refused() -> None:
    """Even where it cuts neither foot nor wall into slivers: the wall's end would have an edge too many."""
    lattice = replace(HONEYCOMB, thickness=2e-3, phase=math.radians(0.6))
    with pytest.raises(InputError, match="on a grouser's flank") as error:
        sizes(wheel(lattice, grousers=Grousers(count=12, height=3e-3, thickness=2.5e-3)))
    assert error.value.key == "lattice.phase"


def test_rings_have_as_many_elements_under_walls_as_these_have_across() -> None:
    size, (rim, hub) = sizes(wheel(), thickness_elements=3, factor=2.0)
    for ring, row, radius in ((rim, 2, GAP[1]), (hub, 0, GAP[0])):
        divided = across_walls(ring, HONEYCOMB, row, radius, size)
        assert np.array_equal(divided.counts, ring.counts)
        half = math.asin(0.5e-3 / (radius + (1e-3 if row == 0 else -1e-3)))
        assert [ring.counts[k] for k in ring.span(0.1 - half, 0.1 + half)] == [2, 2]


def test_tread_carries_the_grousers_and_is_as_wide_as_it_says() -> None:
    tread = Tread(thickness=6e-3, width=0.08)
    design = wheel(tread=tread, grousers=Grousers(count=6, height=3e-3, thickness=4e-3))
    volumes = closed_form_volume(design, half_width=False)
    assert volumes["tread"] == pytest.approx(math.pi * (0.1485**2 - 0.1425**2) * 0.08)
    assert design.ground_radius == pytest.approx(0.1485)
    mesh = build_planar_mesh(design, element_size=6e-3, refinement={"tread": 2.5e-3})
    assert {"tread_outer", "grouser_outer"} <= set(mesh.faces)
    assert "tire_outer" not in mesh.faces
    assert {part: area * mesh.widths[part] for part, area in planar_areas(mesh).items()} == pytest.approx(
        volumes, rel=1e-5
    )
    radii = np.linalg.norm(mesh.points[np.unique(mesh.cells[mesh.cell_tags == mesh.parts["tread"]])], axis=1)
    assert len(np.unique(radii.round(7))) == 2 * 3 + 1  # three quadratic elements through it


def test_a_tread_wider_than_the_tire_is_refused() -> None:
    with pytest.raises(InputError, match="must not exceed the tire's width") as error:
        wheel(tread=Tread(thickness=6e-3, width=0.11))
    assert error.value.key == "tread.width"
