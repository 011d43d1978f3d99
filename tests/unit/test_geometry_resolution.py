"""Division of the wheel: cuts of the rings, element counts, axial levels."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from contracts.errors import InputError
from geometry.build import build_mesh
from geometry.parts import Cone
from geometry.resolution import MeshSize, Ring, axial_bands, axial_levels, hub_ring, part_names, rim_ring
from geometry.wheel import exomars_hoops

WHEEL = exomars_hoops()


def size(element: float = 8e-3, thickness_elements: int = 1, **refinement: float) -> MeshSize:
    return MeshSize(
        element_size=element, axial_size=20e-3, thickness_elements=thickness_elements, refinement=refinement
    )


def total(ring: Ring) -> float:
    return sum(ring.step(i) for i in range(len(ring.angles)))


def test_rim_is_cut_at_grousers_and_weld_ends() -> None:
    ring = rim_ring(WHEEL, size())
    assert len(ring.angles) == 12 * 2 + 6 * 2
    assert total(ring) == pytest.approx(2 * math.pi)
    half_weld = 0.5 * 8e-3 / WHEEL.tire.inner_radius
    for angle in (half_weld, -half_weld, math.radians(60.0) + half_weld):
        offset = (ring.angles[ring.index(angle)] - angle) % (2 * math.pi)
        assert min(offset, 2 * math.pi - offset) < 1e-12
    assert len(ring.span(-half_weld, half_weld)) == 3


def test_no_element_is_longer_than_asked() -> None:
    for ring, radius in ((rim_ring(WHEEL, size()), 142.5e-3), (hub_ring(WHEEL, size(), "all"), 50e-3)):
        lengths = [radius * ring.step(i) / ring.counts[i] for i in range(len(ring.angles))]
        assert max(lengths) <= 8e-3 * (1 + 1e-6)


def test_refining_a_spring_set_refines_its_welds_only() -> None:
    coarse, fine = rim_ring(WHEEL, size()), rim_ring(WHEEL, size(springs_outer=0.5e-3))
    half = 0.5 * 8e-3 / WHEEL.tire.inner_radius
    inside = coarse.span(-half, half)
    assert all(fine.counts[i] > coarse.counts[i] for i in inside if coarse.step(i) > 0.01)
    far = coarse.span(math.radians(60.0) - half, math.radians(60.0) + half)
    assert all(fine.counts[i] == coarse.counts[i] for i in far)


def test_grouser_foot_has_as_many_elements_as_its_thickness() -> None:
    ring = rim_ring(WHEEL, size(thickness_elements=3))
    half = math.asin(0.5e-3 / 142.5e-3)
    assert sum(int(ring.counts[i]) for i in ring.span(-half, half)) == 3


def test_the_factor_refines_along_strips_and_axle_and_not_across_a_grouser() -> None:
    rim, divided = rim_ring(WHEEL, size()), rim_ring(WHEEL, replace(size(), factor=3.0))
    foot = np.array([rim.step(i) * WHEEL.tire.outer_radius < 1.1e-3 for i in range(len(rim.angles))])
    assert foot.sum() == 12
    assert np.array_equal(divided.counts, np.where(foot, rim.counts, 3 * rim.counts))
    hub, divided = hub_ring(WHEEL, size(), "all"), hub_ring(WHEEL, replace(size(), factor=3.0), "all")
    assert np.array_equal(divided.counts, 3 * hub.counts)
    levels = axial_levels(WHEEL, "flexible", half_width=True)
    assert [n for *_, n in axial_bands(WHEEL, replace(size(), factor=3.0), levels)] == [3, 3, 3]
    assert [n for *_, n in axial_bands(WHEEL, replace(size(), factor=1.5), levels)] == [2, 2, 2]


def test_edges_of_strips_have_elements_of_their_own() -> None:
    """Outer springs end at 20, 40 and 60 mm in all: none at the mid-plane, none where two would fill the band."""
    levels = axial_levels(WHEEL, "flexible", half_width=True)
    edged = replace(size(), axial_size=20e-3, edge_size=4e-3)
    bands = axial_bands(WHEEL, edged, levels)
    assert [1e3 * b for _, b, _ in bands] == pytest.approx([16.0, 20.0, 24.0, 36.0, 40.0, 44.0, 56.0, 60.0])
    assert all(count == 1 for *_, count in bands)
    assert [n for *_, n in axial_bands(WHEEL, replace(edged, factor=3.0), levels)] == [3] * 8
    whole = axial_bands(WHEEL, edged, axial_levels(WHEEL, "flexible", half_width=False))
    assert np.array(whole[8:]) == pytest.approx(np.array(bands))
    assert np.array(whole[:8])[:, 0] == pytest.approx(-np.array(bands)[::-1, 1])
    for long, count in ((5e-3, 4), (20e-3, 3), (1.0, 3)):
        assert len(axial_bands(WHEEL, replace(edged, edge_size=long), levels)) == count
    with pytest.raises(InputError, match="edge size"):
        build_mesh(WHEEL, element_size=30e-3, edge_size=0.0)


def test_meshes_of_a_family_are_nested() -> None:
    coarse, fine = (
        build_mesh(WHEEL, element_size=30e-3, axial_size=60e-3, order=1, parts="flexible", factor=k) for k in (1.0, 2.0)
    )
    distance, _ = cKDTree(fine.points).query(coarse.points)
    assert distance.max() < 1e-9
    for part in ("springs_outer", "springs_inner", "outer_hub"):
        cells = [int((mesh.cell_tags == mesh.parts[part]).sum()) for mesh in (coarse, fine)]
        assert 3.8 * cells[0] < cells[1] <= 4 * cells[0]
    with pytest.raises(InputError, match="refinement factor"):
        build_mesh(WHEEL, element_size=30e-3, factor=0.5)


def test_cuts_that_all_but_coincide_are_refused() -> None:
    outer, inner = WHEEL.spring_sets
    rim = WHEEL.tire.inner_radius
    foot = 2.0 * rim * math.asin(0.5e-3 / 142.5e-3)
    near = replace(WHEEL, spring_sets=(replace(outer, weld_length=foot + 1e-6), inner))
    with pytest.raises(InputError, match="sliver"):
        rim_ring(near, size())
    same = replace(WHEEL, spring_sets=(replace(outer, weld_length=foot), inner))
    assert len(rim_ring(same, size()).angles) == len(rim_ring(WHEEL, size()).angles) - 6


def test_levels_are_the_edges_of_bands() -> None:
    half = axial_levels(WHEEL, "flexible", half_width=True)
    assert half == pytest.approx([0.0, 0.02, 0.04, 0.06])
    full = axial_levels(WHEEL, "flexible", half_width=False)
    assert full == pytest.approx([-0.06, -0.04, -0.02, 0.0, 0.02, 0.04, 0.06])
    assert [count for _, _, count in axial_bands(WHEEL, size(), half)] == [1, 1, 1]


def test_joints_of_the_cone_have_the_elements_of_its_thickness() -> None:
    levels = axial_levels(WHEEL, "all", half_width=True)
    bands = axial_bands(WHEEL, size(thickness_elements=4), levels)
    assert sum(count == 4 for _, _, count in bands) == 2
    assert np.all(np.diff(levels) > 1e-4)


def test_a_cone_joint_cut_by_a_band_edge_is_refused() -> None:
    cut = replace(WHEEL, cone=Cone(thickness=1.5e-3, outer_position=40e-3, inner_position=22e-3))
    with pytest.raises(InputError, match="is cut by the band edge"):
        axial_levels(cut, "all", half_width=True)


def test_half_of_a_wheel_without_symmetry_is_refused() -> None:
    outer, inner = WHEEL.spring_sets
    skew = replace(WHEEL, spring_sets=(replace(outer, bands=((40e-3, 60e-3),)), inner))
    with pytest.raises(InputError, match=r"40..60 mm: .*mirror each other.*half_width = false"):
        axial_levels(skew, "flexible", half_width=True)
    assert len(axial_levels(skew, "flexible", half_width=False)) == 6


def test_flexible_leaves_out_the_rigid_parts() -> None:
    assert part_names(WHEEL, "flexible") == ("tire", "grousers", "springs_outer", "springs_inner", "outer_hub")
    assert set(part_names(WHEEL, "all")) - set(part_names(WHEEL, "flexible")) == {
        "cone",
        "impact_springs",
        "inner_hub",
    }


def test_sizes_out_of_range_are_refused() -> None:
    with pytest.raises(InputError, match="element size"):
        build_mesh(WHEEL, element_size=0.0)
    with pytest.raises(InputError, match="axial size"):
        build_mesh(WHEEL, element_size=8e-3, axial_size=math.nan)
    with pytest.raises(InputError, match="thickness"):
        build_mesh(WHEEL, element_size=8e-3, thickness_elements=0)
    with pytest.raises(InputError, match="not a part"):
        build_mesh(WHEEL, element_size=8e-3, refinement={"spokes": 1e-3})
    with pytest.raises(InputError, match="order"):
        build_mesh(WHEEL, element_size=8e-3, order=3)
