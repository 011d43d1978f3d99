"""A tire from named surfaces: the preset's own, one drawn with five surfaces, and every kind that is refused."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.plates.mesh import PlateMesh
from ancf_reduced.plates.spline_plates import plate_surfaces
from ancf_reduced.tire.from_surfaces import surface_mesh
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError
from geometry.spline_surface import SplineSurface
from tests.spline_tire import ring, spokes

PRESET = thesis_preset()
MESH = build_tire(PRESET).mesh
WHOLE = plate_surfaces(MESH, MESH.reference_coordinates())
MIDDLES = tuple(surface for surface in WHOLE if surface.name.endswith("middle"))
DRAWN = (replace(ring(PRESET, 4), name="Rim"), *spokes(PRESET))


def assert_same(found: PlateMesh, wanted: PlateMesh) -> None:
    """Nodes and frames J0 diag(a, b, t), all that the element sees, to 1e-12 m."""
    np.testing.assert_array_equal(found.elements, wanted.elements)
    np.testing.assert_allclose(found.points, wanted.points, atol=1e-12)
    frames = [mesh.gradients * mesh.dimensions[:, None, None, :] for mesh in (found, wanted)]
    np.testing.assert_allclose(*frames, atol=1e-12)
    assert found.parts == wanted.parts


def renamed(surfaces: Sequence[SplineSurface], old: str, new: str) -> list[SplineSurface]:
    return [replace(surface, name=surface.name.replace(old, new)) for surface in surfaces]


def moved(surface: SplineSurface, by: Sequence[float]) -> SplineSurface:
    return replace(surface, control_points=surface.control_points + np.asarray(by))


@pytest.mark.parametrize("surfaces", [WHOLE, MIDDLES, WHOLE[::-1], DRAWN], ids=["all", "middle", "reversed", "drawn"])
def test_the_same_tire_again(surfaces: tuple[SplineSurface, ...]) -> None:
    """With faces or without, drawn as plates or as a closed ring with a ring's name; the order does not matter."""
    found = surface_mesh(surfaces, PRESET)
    if surfaces == WHOLE[::-1]:
        assert sorted(found.points.round(9).tolist()) == sorted(MESH.points.round(9).tolist())
        assert found.parts == MESH.parts
    else:
        assert_same(found, MESH)


def test_negative_control_another_tire_is_another_mesh() -> None:
    wider = build_tire(replace(PRESET, hub_radius=0.049)).mesh
    with pytest.raises(AssertionError):
        assert_same(surface_mesh(plate_surfaces(wider, wider.reference_coordinates()), PRESET), MESH)


def _quintic() -> SplineSurface:
    """The rim's first mid-surface, of degree 5 along u."""
    ends = np.repeat([0.0, 1.0], 6), np.repeat([0.0, 1.0], 4)
    points = np.repeat(MIDDLES[0].control_points[[0, 1, 1, 2, 2, 3]], 1, axis=0)
    return replace(MIDDLES[0], control_points=points, degrees=(5, 3), knots=ends)


def _crowned() -> SplineSurface:
    points = MIDDLES[0].control_points.copy()
    points[1:3, 1:3, ::2] *= 1.05
    return replace(MIDDLES[0], control_points=points)


LOADED = MESH.reference_coordinates()
LOADED[MESH.points[:, 2] < -0.12, 3, 0] += 0.05  # directors that lean, as under load

BAD: dict[str, tuple[Sequence[SplineSurface], str]] = {
    "no part": (renamed(MIDDLES, "rim", "tread"), "'tread 0 middle': must have a name that begins with rim or spoke"),
    "one name twice": ([*MIDDLES, MIDDLES[0]], "'rim 0 middle': has the name of another one"),
    "face alone": (WHOLE[:1], "'rim 0 lower': is a face without its mid-surface"),
    "one face of two": (WHOLE[:2], "'rim 0 middle': has one face of two"),
    "a loaded tire": (plate_surfaces(MESH, LOADED), "a deformed tire cannot be a reference"),
    "degree": ([_quintic(), *MIDDLES[1:]], "must be at most 3, the degree of an ANCF plate"),
    "doubly curved": ([_crowned(), *MIDDLES[1:]], "lies outside the space of the ANCF plate"),
    "inside out": (
        [replace(MIDDLES[0], control_points=MIDDLES[0].control_points[::-1]), *MIDDLES[1:]],
        "'rim 0 middle': must have its normal r_u x r_v away from the axle",
    ),
    "no rim": ([s for s in MIDDLES if s.name.startswith("spoke")], "must have one whose name begins with rim"),
    "metres as millimetres": (
        [replace(s, control_points=1e-3 * s.control_points) for s in MIDDLES],
        "outer radius of the surfaces = 12.63 mm: must be 142.5 mm",
    ),
    "narrower": (
        [replace(s, control_points=s.control_points * [1.0, 0.9, 1.0]) for s in MIDDLES],
        "width of the surfaces = 108 mm: must be 120 mm",
    ),
    "off the axle": ([moved(s, [0.01, 0.0, 0.0]) for s in MIDDLES], "the axle, which is y through the origin"),
    "a spoke too few": (MIDDLES[:-1], "spoke plates of the surfaces = 3: must be 4"),
    "a spoke off the rim": (
        [*MIDDLES[:-1], moved(MIDDLES[-1], [0.0, 0.0, 0.002])],
        r"'spoke 7 middle': does not join: its corner at \(.*\) mm is no other's",
    ),
    "rim torn": (
        [replace(MIDDLES[0], control_points=MIDDLES[0].control_points * 1.001), *MIDDLES[1:]],
        "does not join",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_surfaces_are_refused(case: str) -> None:
    surfaces, text = BAD[case]
    with pytest.raises(InputError, match=text):
        surface_mesh(surfaces, PRESET)


def test_another_thickness_than_the_file_s_is_refused() -> None:
    """Faces are 25 mm apart; 24 mm in the study contradicts them, and without faces nothing does."""
    thinner = replace(PRESET, spoke_thickness=0.024)
    with pytest.raises(InputError, match=r"'spoke 4 middle': has faces that are not those of a plate of 24 mm on it"):
        surface_mesh(WHOLE, thinner)
    assert_same(surface_mesh(MIDDLES, thinner), build_tire(thinner).mesh)


def test_a_hub_that_no_spoke_reaches_is_refused() -> None:
    with pytest.raises(InputError, match="hub radius = 45 mm: must be reached"):
        surface_mesh(MIDDLES, replace(PRESET, hub_radius=0.045))


def test_a_second_ring_that_hangs_on_nothing_is_refused() -> None:
    """All its corners are shared, but no spoke carries it."""
    inner = ring(replace(PRESET, outer_radius=0.1), 4)
    more = [*DRAWN, replace(inner, name="rim inner")]
    with pytest.raises(InputError, match="'rim inner': does not hang on the hub"):
        surface_mesh(more, replace(PRESET, circumferential_plates=8))
