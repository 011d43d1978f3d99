"""Sidewall springs: centreline in closed form, mesh that meets the rim node to node, rules of the design."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.build import build_mesh
from geometry.checks import check_matches_design, check_mesh
from geometry.parts import Grousers, HubRing, SpringSet, Tire
from geometry.planar import build_planar_mesh
from geometry.sidewall import SidewallSprings, sidewall_profile
from geometry.wheel import WheelDesign

SPRINGS = SidewallSprings(
    name="springs",
    count=8,
    width=9.5e-3,
    thickness=0.4e-3,
    curl_radius=5e-3,
    arc_radius=27.5e-3,
    sweep=math.radians(140.0),
    weld_length=10e-3,
    clamp_length=3e-3,
)

IN_PLANE = SpringSet(name="in_plane", count=3, bands=((-5e-3, 5e-3),), thickness=0.4e-3, shape="arc", weld_length=8e-3)


def wheel(springs: SidewallSprings = SPRINGS, **parts: Any) -> WheelDesign:
    values: dict[str, Any] = {
        "tire": Tire(outer_radius=90e-3, width=70e-3, thickness=0.4e-3),
        "grousers": None,
        "spring_sets": (),
        "sidewall_springs": springs,
        "outer_hub": HubRing(outer_radius=17e-3, thickness=2e-3, width=80e-3),
        "cone": None,
        "impact_springs": None,
        "inner_hub": None,
    }
    return WheelDesign(name="sidewall", **(values | parts))


def test_there_is_no_planar_model() -> None:
    with pytest.raises(InputError, match="out of the plane"):
        build_planar_mesh(wheel(), element_size=8e-3)


def test_centreline_has_its_length_radii_and_tangents() -> None:
    weld = np.linspace(25e-3, 35e-3, 5)
    profile = sidewall_profile(SPRINGS, 89.6e-3, weld, (400, 800, 4))
    free = profile.points[4:1205]
    assert np.linalg.norm(np.diff(free, axis=0), axis=1).sum() == pytest.approx(SPRINGS.free_length, rel=1e-5)
    np.testing.assert_allclose(np.linalg.norm(profile.normals, axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(profile.points[404], [35e-3, 89.4e-3 - 10e-3], atol=1e-12)  # half a circle of 5 mm
    centre = np.array([35e-3, 89.4e-3 - 10e-3 - 27.5e-3])
    np.testing.assert_allclose(np.linalg.norm(profile.points[404:1205] - centre, axis=1), 27.5e-3, rtol=1e-12)
    steps = np.diff(profile.points, axis=0)
    across = np.abs(np.einsum("ij,ij->i", steps, 0.5 * (profile.normals[1:] + profile.normals[:-1])))
    assert (across < 1e-3 * np.linalg.norm(steps, axis=1)).all()  # no kink at any joint


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("half_width", [True, False])
def test_mesh_is_conforming_and_has_the_closed_form_volume(order: int, half_width: bool) -> None:
    mesh = build_mesh(wheel(), element_size=6e-3, axial_size=9e-3, order=order, half_width=half_width)
    check_mesh(mesh)
    check_matches_design(mesh, wheel(), tolerance=1e-3 if order == 2 else 3e-2)  # chords: four to the curl
    assert set(mesh.parts) == {"tire", "springs", "outer_hub"}


def test_a_weld_over_the_whole_width_ends_in_the_symmetry_plane_or_joins_the_other_side() -> None:
    design = wheel(replace(SPRINGS, weld_length=35e-3))
    for half_width in (True, False):
        mesh = build_mesh(design, element_size=8e-3, axial_size=12e-3, half_width=half_width)
        check_mesh(mesh)
        check_matches_design(mesh, design)
    half = build_mesh(design, element_size=8e-3, axial_size=12e-3)
    facets = half.facets[half.facet_tags == half.faces["symmetry"]]
    at_plane = half.facets[(np.abs(half.points[half.facets][..., 1]) < 1e-12).all(axis=1)]
    assert len(facets) == len(at_plane) > 0


def test_a_factor_multiplies_every_count() -> None:
    coarse, fine = (build_mesh(wheel(), element_size=14e-3, axial_size=20e-3, factor=f) for f in (1.0, 2.0))
    for part in coarse.parts:
        cells = [np.count_nonzero(m.cell_tags == m.parts[part]) for m in (coarse, fine)]
        assert cells[1] == 4 * cells[0]
    check_mesh(fine)


def test_grousers_may_stand_over_the_strips() -> None:
    design = wheel(grousers=Grousers(count=8, height=7e-3, thickness=1e-3))
    mesh = build_mesh(design, element_size=8e-3, axial_size=12e-3)
    check_mesh(mesh)
    check_matches_design(mesh, design)


def test_a_wrong_volume_is_found() -> None:
    """Negative control: the mesh of a strip 2 % wider does not match the design."""
    mesh = build_mesh(wheel(replace(SPRINGS, width=1.02 * SPRINGS.width)), element_size=8e-3, axial_size=12e-3)
    with pytest.raises(Exception, match="springs"):
        check_matches_design(mesh, wheel())


@pytest.mark.parametrize(
    ("springs", "parts", "message"),
    [
        (replace(SPRINGS, weld_length=36e-3), {}, "weld length"),
        (replace(SPRINGS, width=80e-3), {}, "spacing"),
        (replace(SPRINGS, count=16, width=15e-3), {}, "neighbours overlap"),
        (replace(SPRINGS, arc_radius=40e-3), {}, "outside the outer hub"),
        (SPRINGS, {"spring_sets": (IN_PLANE,)}, "cannot be combined"),
        (SPRINGS, {"sidewall_springs": None}, "needs springs"),
    ],
)
def test_designs_that_do_not_fit_are_refused(
    springs: SidewallSprings, parts: dict[str, tuple[SpringSet, ...]], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        wheel(springs, **parts)


@pytest.mark.parametrize(("key", "value"), [("sweep", 0.0), ("sweep", 5.0), ("curl_radius", 1e-4), ("width", -1e-3)])
def test_dimensions_out_of_range_are_refused(key: str, value: float) -> None:
    with pytest.raises(InputError, match="springs"):
        replace(SPRINGS, **{key: value})
