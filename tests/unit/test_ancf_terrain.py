"""Compiled terrain: gap, normal, curvature and coarse bounds of every kind of piece."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.contact.terrain_kernels import is_clear, is_outside, piece_bound, piece_gap
from contracts.height_field import HeightField
from contracts.terrain import Terrain, TerrainPieces, inclined_plane, normals
from contracts.terrain_ridges import Cleat, HalfRound, Sinusoid, Step

LINE = np.linspace(-0.5, 0.5, 21)
FIELD = HeightField(
    heights=0.02 * np.sin(7 * LINE)[:, None] * np.cos(5 * LINE) + 0.05 * LINE[:, None] * LINE,
    spacing=(0.05, 0.05),
    origin=(-0.5, -0.5),
)
STEP = Step(rise=0.1, edge_radius=0.03, position=0.02, yaw=0.5)
SHAPES: dict[str, Terrain] = {
    "plane": inclined_plane(0.4, 0.7, 0.1),
    "step": STEP,
    "half-round": HalfRound(radius=0.05, yaw=1.1, position=0.01, base=0.01),
    "cleat": Cleat(rise=0.05, width=0.12, edge_radius=0.02, yaw=-0.8, position=0.01, base=0.01),
    "sinusoid": Sinusoid(amplitude=0.03, wavelength=0.4, yaw=0.3, base=0.1),
    "field": FIELD,
}


def gap(pieces: TerrainPieces, row: np.ndarray, r: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    g, n, H = piece_gap(row, pieces.knots, *r)
    return g, np.array(n), np.array(H)[[[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


@pytest.mark.parametrize("name", SHAPES)
def test_normal_and_curvature_are_derivatives_of_the_gap(name: str) -> None:
    pieces, rng, h, checked = SHAPES[name].pieces(), np.random.default_rng(6), 1e-6, 0
    for row in pieces.rows:
        for x, y in rng.uniform(-0.15, 0.15, (100, 2)):
            r = np.array([x, y, float(SHAPES[name].height(np.array(x), np.array(y))) - rng.uniform(5e-4, 8e-3)])
            g, n, H = gap(pieces, row, r)
            if g >= 0.0:
                continue
            sides = [[gap(pieces, row, r + sign * step) for sign in (1, -1)] for step in h * np.eye(3)]
            np.testing.assert_allclose([(a[0] - b[0]) / (2 * h) for a, b in sides], n, atol=1e-6)
            np.testing.assert_allclose([(a[1] - b[1]) / (2 * h) for a, b in sides], H, atol=2e-3)
            assert n @ n == pytest.approx(1.0, abs=1e-14)
            assert np.abs(H @ n).max() < 1e-12
            checked += 1
    assert checked > 50


@pytest.mark.parametrize("name", SHAPES)
def test_upper_surface_is_that_of_the_contract(name: str) -> None:
    """The smallest gap of the pieces vanishes at z = h(x, y), with the normal that the contract gives."""
    terrain = SHAPES[name]
    x, y = np.random.default_rng(7).uniform(-0.3, 0.3, (2, 200))
    z, n = terrain.height(x, y), normals(terrain, x, y)
    pieces = terrain.pieces()
    for k in range(200):
        g, m, _ = min(
            (gap(pieces, row, np.array([x[k], y[k], z[k]])) for row in pieces.rows), key=lambda touch: touch[0]
        )
        assert abs(g) < 1e-12
        np.testing.assert_allclose(m, n[k], atol=1e-7)


def test_gap_to_a_wave_is_the_distance_of_its_nearest_point() -> None:
    wave = Sinusoid(amplitude=0.03, wavelength=0.4)
    s = np.linspace(-0.3, 0.3, 600001)
    curve = wave.height(s, 0.0 * s)
    for x in (-0.11, -0.02, 0.05, 0.1, 0.16):
        z = float(wave.height(np.array(x), np.array(0.0))) - 0.01
        g = gap(wave.pieces(), wave.pieces().rows[0], np.array([x, 0.3, z]))[0]
        assert -g == pytest.approx(np.hypot(s - x, curve - z).min(), abs=1e-9)


def test_step_edge_presses_along_its_radius() -> None:
    pieces = Step(rise=0.1, edge_radius=0.03).pieces()
    corner = pieces.rows[0]
    for angle in (0.1, 0.8, 1.5):
        outwards = np.array([-np.cos(angle), 0.0, np.sin(angle)])
        g, n, H = gap(pieces, corner, np.array([0.03, 0.2, 0.07]) + 0.025 * outwards)
        assert g == pytest.approx(-0.005, abs=1e-15)
        np.testing.assert_allclose(n, outwards, atol=1e-14)
        assert np.trace(H) == pytest.approx(1.0 / 0.025)
    assert gap(pieces, corner, np.array([0.2, 0.0, 0.09]))[1].tolist() == [0.0, 0.0, 1.0]
    assert gap(pieces, corner, np.array([0.01, 0.0, 0.04]))[1].tolist() == [-1.0, 0.0, 0.0]


def test_half_round_has_upright_sides_below_its_axis() -> None:
    """A point below the ground's level is pushed out of the rock sideways, never down."""
    pieces = HalfRound(radius=0.05).pieces()
    g, n, _ = gap(pieces, pieces.rows[0], np.array([-0.048, 0.0, -0.004]))
    assert (g, n.tolist()) == (pytest.approx(-0.002), [-1.0, 0.0, 0.0])


def test_points_deeper_than_a_crest_is_round_stay_finite() -> None:
    wave = Sinusoid(amplitude=0.05, wavelength=0.1).pieces()  # crests of 5 mm radius
    for z in (0.04, 0.02, -0.5):
        g, n, H = gap(wave, wave.rows[0], np.array([0.026, 0.0, z]))
        assert g < 0.0
        assert np.all(np.isfinite([*n, *H.ravel()]))
        assert n @ n == pytest.approx(1.0)


@pytest.mark.parametrize("name", SHAPES)
def test_bounds_hold_all_of_a_piece_in_the_box(name: str) -> None:
    """No point of a box that is clear touches; boxes far above are clear, boxes that reach the ground are not."""
    pieces, rng, clear = SHAPES[name].pieces(), np.random.default_rng(8), 0
    for row in pieces.rows:
        for _ in range(200):
            low = rng.uniform([-0.4, -0.4, -0.1], [0.2, 0.2, 0.3])
            high = low + rng.uniform(0.0, 0.2, 3)
            bound = piece_bound(row, pieces, tuple(low), tuple(high))
            clear += is_clear(bound, tuple(low), tuple(high))
            for r in rng.uniform(low, high, (20, 3)):
                if gap(pieces, row, r)[0] < 0.0:
                    assert np.array(bound[:3]) @ r <= bound[3]
        assert is_clear(
            piece_bound(row, pieces, (-0.1, -0.1, 0.9), (0.1, 0.1, 1.0)), (-0.1, -0.1, 0.9), (0.1, 0.1, 1.0)
        )
    assert 10 < clear < 200 * len(pieces.rows)


def test_wave_bound_is_that_of_the_stretch_below_the_box() -> None:
    wave = Sinusoid(amplitude=0.03, wavelength=0.4).pieces()
    for first, last, highest in ((0.05, 0.15, 0.03), (0.2, 0.25, 0.0), (0.15, 0.2, 0.03 * np.sqrt(0.5))):
        d = piece_bound(wave.rows[0], wave, (first, 0.0, 0.0), (last, 1.0, 1.0))[3]
        assert d == pytest.approx(highest, abs=1e-15)


def test_beside_a_height_field_is_outside() -> None:
    pieces = FIELD.pieces()
    inside = [
        is_outside(pieces.rows[0], pieces.knots, x, y) for x, y in ((0.0, 0.0), (0.5, -0.5), (0.51, 0.0), (0.0, -0.6))
    ]
    assert inside == [False, False, True, True]
    assert piece_bound(pieces.rows[0], pieces, (0.4, 0.0, 0.0), (0.6, 0.1, 1.0))[3] == np.inf
