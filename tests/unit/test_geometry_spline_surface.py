"""B-spline surfaces: values, Bezier pieces against knot insertion, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from contracts.errors import InputError
from geometry.spline_surface import SplineSurface, bernstein, bezier_surface

RNG = np.random.default_rng(3)
CLAMPED = np.array([0.0, 0.0, 0.0, 0.0, 0.5, 1.25, 1.25, 2.0, 2.0, 2.0, 2.0])
"""Cubic, seven control points, once C2 and once C1."""


def _surface(knots_u: np.ndarray, degrees: tuple[int, int], knots_v: np.ndarray) -> SplineSurface:
    shape = (len(knots_u) - degrees[0] - 1, len(knots_v) - degrees[1] - 1, 3)
    return SplineSurface(name="free", control_points=RNG.normal(size=shape), degrees=degrees, knots=(knots_u, knots_v))


@pytest.mark.parametrize(
    ("degree", "knots_v"),
    [(1, np.array([0.0, 0.0, 0.3, 1.0, 1.0])), (2, np.array([0.0, 0.0, 0.0, 0.3, 0.3, 1.0, 1.0, 1.0])), (3, CLAMPED)],
)
def test_pieces_are_the_surface(degree: int, knots_v: np.ndarray) -> None:
    surface = _surface(CLAMPED, (3, degree), knots_v)
    (u, v), pieces = surface.breaks, surface.bezier_pieces()
    assert pieces.shape == (len(u) - 1, len(v) - 1, 4, 4, 3)
    s = RNG.uniform(size=(20, 2))
    for a in range(len(u) - 1):
        for b in range(len(v) - 1):
            found = np.einsum("ki,kj,ijx->kx", bernstein(s[:, 0]), bernstein(s[:, 1]), pieces[a, b])
            uv = np.column_stack([u[a] + s[:, 0] * (u[a + 1] - u[a]), v[b] + s[:, 1] * (v[b + 1] - v[b])])
            np.testing.assert_allclose(found, surface.value(uv), atol=5e-14)


def test_pieces_are_those_of_knot_insertion() -> None:
    """Independent way: scipy's Boehm insertion until every interior knot is there three times."""
    surface = _surface(CLAMPED, (3, 3), np.repeat([0.0, 1.0], 4))
    spline = BSpline(CLAMPED, surface.control_points, 3)
    for knot, times in ((0.5, 2), (1.25, 1)):
        spline = spline.insert_knot(knot, times)
    inserted = np.asarray(spline.c)
    for a, piece in enumerate(surface.bezier_pieces()[:, 0]):
        np.testing.assert_allclose(piece, inserted[3 * a : 3 * a + 4], atol=1e-13)


def test_unclamped_knots_and_further_breaks() -> None:
    """A uniform closed spline, as rings are drawn; a break in the middle changes no point."""
    uniform = np.arange(-3.0, 8.0)
    surface = _surface(uniform, (3, 1), np.array([0.0, 0.0, 1.0, 1.0]))
    assert surface.breaks[0].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    finer = surface.bezier_pieces((np.linspace(0.0, 4.0, 9), np.array([0.0, 1.0])))
    assert len(finer) == 8
    np.testing.assert_allclose(finer[3, 0, 3, 0], surface.value(np.array([[2.0, 0.0]]))[0], atol=1e-14)


def test_bezier_surface_keeps_its_control_points() -> None:
    points = RNG.normal(size=(4, 4, 3))
    np.testing.assert_allclose(bezier_surface("patch", points).bezier_pieces()[0, 0], points, atol=1e-14)


def test_negative_control_another_knot_is_another_surface() -> None:
    surface = _surface(CLAMPED, (3, 1), np.array([0.0, 0.0, 1.0, 1.0]))
    moved = np.where(CLAMPED == 0.5, 0.6, CLAMPED)
    other = SplineSurface(
        name="moved", control_points=surface.control_points, degrees=(3, 1), knots=(moved, surface.knots[1])
    )
    assert np.abs(other.bezier_pieces()[0] - surface.bezier_pieces()[0]).max() > 0.01


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"control_points": np.zeros((4, 4))}, "control points"),
        ({"control_points": np.full((4, 4, 3), np.nan)}, "finite"),
        ({"degrees": (0, 3)}, "degree along u"),
        ({"degrees": (3, 4)}, "degree along v"),
        ({"knots": (np.arange(7.0), np.arange(8.0))}, "knots along u"),
        ({"knots": (np.arange(8.0)[::-1], np.arange(8.0))}, "do not decrease"),
        ({"knots": (np.zeros(8), np.arange(8.0))}, "span a range"),
    ],
)
def test_what_makes_no_surface_is_refused(change: dict[str, object], text: str) -> None:
    good = {"control_points": np.zeros((4, 4, 3)), "degrees": (3, 3), "knots": (np.arange(8.0), np.arange(8.0))}
    with pytest.raises(InputError, match=text):
        SplineSurface(name="bad", **(good | change))


def test_a_torn_surface_is_refused() -> None:
    with pytest.raises(InputError, match="torn"):
        _surface(np.array([0.0, 0.0, 1.0, 1.0, 2.0, 2.0]), (1, 1), np.array([0.0, 0.0, 1.0, 1.0]))


def test_pieces_refuse_a_fourth_degree_and_a_break_left_out() -> None:
    with pytest.raises(InputError, match="at most 3"):
        _surface(np.repeat([0.0, 1.0], 5), (4, 1), np.array([0.0, 0.0, 1.0, 1.0])).bezier_pieces()
    surface = _surface(CLAMPED, (3, 1), np.array([0.0, 0.0, 1.0, 1.0]))
    with pytest.raises(InputError, match="surface's own"):
        surface.bezier_pieces((np.array([0.0, 1.25, 2.0]), np.array([0.0, 1.0])))
