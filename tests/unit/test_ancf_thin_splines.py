"""Thin plates as B-spline surfaces and back: points between the nodes, a whole wheel through a STEP file, kinks."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer
from ancf_reduced.thin_plates.shape_functions import shape_tables
from ancf_reduced.thin_plates.splines import bezier_points, plate_surfaces, plates_on_surface
from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround, press
from contracts.errors import InputError
from contracts.materials import Material
from geometry.spline_surface import SplineSurface
from geometry.step_surfaces import read_surfaces_step
from geometry.surface_step import write_surfaces_step
from geometry.wheel import exomars

Array = NDArray[np.float64]
STEEL = Material(name="steel", young_modulus=2e11, poisson_ratio=0.3, density=7800.0, yield_strength=1e9, source="-")
SHEET = Layer(material=STEEL, thickness=1e-3)
RANDOM = np.random.default_rng(3)


def smooth(knots_u: Array, knots_v: Array, shape: tuple[int, int]) -> SplineSurface:
    """A sheet of about 0.3 by 0.1 m, bent along u and rippled."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, shape[0]), np.linspace(0.0, 1.0, shape[1]), indexing="ij")
    points = np.stack([0.3 * u, 0.1 * v, 0.05 * np.sin(4.0 * u)], axis=-1) + 1e-3 * RANDOM.standard_normal((*shape, 3))
    return SplineSurface(name="sheet", control_points=points, degrees=(3, 3), knots=(knots_u, knots_v))


def clamped(*inner: float) -> Array:
    return np.concatenate([np.zeros(4), inner, np.ones(4)])


SURFACE = smooth(clamped(0.3, 0.55, 0.55), clamped(0.6), (7, 5))
"""A knot that stands twice leaves slopes alone continuous, as plates are."""


@pytest.mark.parametrize("subdivisions", [(1, 1), (3, 2)])
def test_plates_on_a_surface_are_the_surface(subdivisions: tuple[int, int]) -> None:
    plates = plates_on_surface(SURFACE, [SHEET], subdivisions)
    assert len(plates.plates) == 3 * 2 * subdivisions[0] * subdivisions[1]
    u, v = (np.append((b[:-1, None] + np.diff(b)[:, None] * np.arange(n) / n).ravel(), b[-1])
            for b, n in zip(SURFACE.breaks, subdivisions, strict=True))  # fmt: skip
    place = np.array([0.23, 0.71])
    for k, nodes in enumerate(plates.plates):
        i, j = divmod(k, len(v) - 1)
        at = np.array([u[i] + place[0] * (u[i + 1] - u[i]), v[j] + place[1] * (v[j + 1] - v[j])])
        shape = shape_tables(plates.sizes[k], place[:1], place[1:])[0, 0]
        found = shape @ plates.reference[nodes].reshape(16, 3)
        np.testing.assert_allclose(found, SURFACE.value(at[None])[0], atol=1e-12)
    assert np.linalg.norm(plates.reference[:, 1], axis=1).mean() == pytest.approx(1.0, abs=0.2)


def test_there_and_back() -> None:
    """Nodes moved at random: each plate's surface, taken for a plate again, has the same coordinates."""
    square = (4, 4)
    plates = plates_on_surface(SURFACE, [SHEET])
    q = plates.reference + 1e-3 * RANDOM.standard_normal(plates.reference.shape)
    for k, surface in enumerate(plate_surfaces(plates, q, ["sheet"] * len(plates.plates))):
        one = plates_on_surface(surface, [SHEET], membrane_points=square)
        scale = one.sizes[0] / plates.sizes[k]
        factors = np.array([1.0, scale[0], scale[1], scale[0] * scale[1]])[:, None]
        np.testing.assert_allclose(one.reference * factors, q[plates.plates[k]], atol=1e-12)


def test_a_pressed_wheel_survives_its_step_file(tmp_path: Path) -> None:
    wheel = build_ancf_wheel(exomars(), element_size=80e-3, axial_size=80e-3)
    (state,) = press(WheelOnGround(wheel, math.radians(15.0)), [5e-3])
    q = wheel.coordinates(state.free)
    surfaces = plate_surfaces(wheel.plates, q, wheel.parts.tolist())
    write_surfaces_step(surfaces, tmp_path / "wheel.step")
    found = {one.name: one for one in read_surfaces_step(tmp_path / "wheel.step")}
    assert len(found) == len(wheel.plates.plates)
    points = bezier_points(wheel.plates, q)
    for k, part in enumerate(wheel.parts.tolist()):
        np.testing.assert_allclose(found[f"{part} {k}"].control_points, points[k], atol=1e-9)


def test_stiffness_does_not_depend_on_the_parameters() -> None:
    """The same surface by other knots' values: equal energy where it is turned half way to its mirror image."""
    other = SplineSurface(
        name="sheet", control_points=SURFACE.control_points, degrees=(3, 3),
        knots=(2.0 + 5.0 * SURFACE.knots[0], 0.1 * SURFACE.knots[1]),
    )  # fmt: skip
    energies = []
    for surface in (SURFACE, other):
        plates = plates_on_surface(surface, [SHEET], (2, 2))
        energies.append(plates.energy(plates.reference * np.array([1.0, 1.001, 1.0])))
    assert energies[0] > 0.0
    assert energies[1] == pytest.approx(energies[0], rel=1e-9)


def tube(lift: float) -> SplineSurface:
    """A ring of twelve cubic pieces in u, 0.1 m wide; its end is moved by ``lift`` [m] along the axle."""
    n, half = 12, math.pi / 12
    points = []
    for k in range(n):
        ends = [np.array([math.cos(a), math.sin(a)]) for a in (2 * half * k, 2 * half * (k + 1))]
        arm = 4.0 / 3.0 * math.tan(half / 2)
        turned = [np.array([-e[1], e[0]]) for e in ends]
        points += [ends[0], ends[0] + arm * turned[0], ends[1] - arm * turned[1]]
    plane = 0.15 * np.array([*points, points[0]])
    along = np.linspace(0.0, 0.1, 4)
    grid = np.stack([np.column_stack([plane[:, :1], np.full(len(plane), y), plane[:, 1:]]) for y in along], axis=1)
    grid[-1, :, 1] += lift
    knots = np.concatenate([np.zeros(4), np.repeat(np.arange(1.0, n), 3), np.full(4, float(n))])
    return SplineSurface(name="tube", control_points=grid, degrees=(3, 3), knots=(knots, clamped()))


def test_a_tube_closes_where_it_ends_as_it_began() -> None:
    """Its last plate ends on the first nodes, and pulling them bends both; lifted by a micrometre it stays slit."""
    plates = plates_on_surface(tube(0.0), [SHEET], (1, 2))
    assert plates.reference.shape == (12 * 3, 4, 3)
    assert plates.plates.max() == 35
    first, last = plates.plates[:2], plates.plates[-2:]
    np.testing.assert_array_equal(first[:, :2], last[:, 2:])
    slit = plates_on_surface(tube(1e-6), [SHEET], (1, 2))
    assert slit.reference.shape == (13 * 3, 4, 3)
    q = plates.reference.copy()
    q[0, 0] *= 1.01
    assert plates.energy(q) == pytest.approx(2.0 * slit.energy(_moved(slit.reference, 1.01)), rel=1e-3)


def test_a_tube_that_closes_with_a_kink_stays_slit_and_one_that_all_but_closes_is_told() -> None:
    def bent(by: float) -> SplineSurface:
        whole = tube(0.0)
        points = whole.control_points.copy()
        points[-2, :, 0] += by
        return SplineSurface(name="tube", control_points=points, degrees=whole.degrees, knots=whole.knots)

    assert plates_on_surface(bent(5e-3), [SHEET]).reference.shape == (13 * 2, 4, 3)
    with pytest.raises(InputError, match="where it closes"):
        plates_on_surface(bent(1e-6), [SHEET])


def _moved(reference: Array, factor: float) -> Array:
    q = reference.copy()
    q[0, 0] *= factor
    return q


def test_a_kink_and_odd_subdivisions_are_refused() -> None:
    kinked = smooth(clamped(0.5, 0.5, 0.5), clamped(), (7, 4))
    with pytest.raises(InputError, match="kink"):
        plates_on_surface(kinked, [SHEET])
    with pytest.raises(InputError, match="subdivisions"):
        plates_on_surface(SURFACE, [SHEET], (0, 1))
