"""Contact of the wheel's rim with every kind of terrain, against brute force; potential, continuity, sharing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.height_field import sampled_terrain
from contracts.terrain import PieceKind, Plane, Terrain, TerrainUnion, inclined_plane
from contracts.terrain_ridges import Crevasse, HalfRound, Sinusoid, Step
from contracts.terrain_rocks import RandomRocks
from rover_dynamics.tires.brush_contact import find_contacts
from rover_dynamics.tires.brush_edges import convex_distance
from rover_dynamics.tires.brush_force import brush_scratch
from rover_dynamics.tires.brush_graph import graph
from rover_dynamics.tires.brush_profile import SAMPLES, profile_distance
from rover_dynamics.tires.brush_wheel import BrushWheels
from tests.brush_rig import RADIUS, STIFFNESS, motion, turned

FloatArray = NDArray[np.float64]
WIDTH = 0.12


def outline(terrain: Terrain, kind: PieceKind, yaw: float) -> FloatArray:
    """(n, 2) float: points s, z of the piece's profile, dense."""
    row = next(row for row in terrain.pieces().rows if row[0] == kind)
    if kind is PieceKind.CORNER:
        s0, z0, r = row[3:6]
        psi = np.linspace(np.pi / 2, np.pi, 20001)
        arc = np.column_stack([s0 + r + r * np.cos(psi), z0 - r + r * np.sin(psi)])
        top = np.column_stack([np.linspace(s0 + r, s0 + 1.0, 20001), np.full(20001, z0)])
        face = np.column_stack([np.full(20001, s0), np.linspace(z0 - 1.0, z0 - r, 20001)])
        return np.concatenate([top, arc, face])
    if kind is PieceKind.HALF_ROUND:
        psi = np.linspace(0.0, np.pi, 40001)
        return np.column_stack([row[3] + row[5] * np.cos(psi), row[4] + row[5] * np.sin(psi)])
    s = np.linspace(-0.6, 0.6, 200001)
    z = terrain.height(s * np.cos(yaw), s * np.sin(yaw))
    return np.column_stack([s, z])


def nearest(points: FloatArray, yaw: float, p: FloatArray, e: FloatArray) -> float:
    """Distance of p from the profile's rulings where they pass through the wheel's plane."""
    along, ruling = np.array([np.cos(yaw), np.sin(yaw), 0.0]), np.array([-np.sin(yaw), np.cos(yaw), 0.0])
    r = points[:, :1] * along + points[:, 1:] * np.array([0.0, 0.0, 1.0])
    r = r - ((r - p) @ e / (ruling @ e))[:, None] * ruling
    return float(np.linalg.norm(r - p, axis=1).min())


RIDGES = [
    (Step(rise=0.25, edge_radius=0.03, position=0.1, yaw=0.3), PieceKind.CORNER, 0.3),
    (HalfRound(radius=0.06, position=0.0, yaw=-0.2), PieceKind.HALF_ROUND, -0.2),
]


@pytest.mark.parametrize(("terrain", "kind", "yaw"), RIDGES, ids=["step", "half-round"])
def test_distance_from_edges_is_that_of_brute_force(terrain: Terrain, kind: PieceKind, yaw: float) -> None:
    draw = np.random.default_rng(3)
    piece, points = next(row for row in terrain.pieces().rows if row[0] == kind), outline(terrain, kind, yaw)
    seen = 0
    for _ in range(60):
        e = turned(*draw.uniform(-0.5, 0.5, 2))[:, 1]
        p = np.array([draw.uniform(-0.3, 0.3), draw.uniform(-0.2, 0.2), draw.uniform(0.05, 0.5)])
        s = p[0] * np.cos(yaw) + p[1] * np.sin(yaw)
        if kind is PieceKind.CORNER and s > 0.1 - 0.01 and p[2] < 0.27:
            continue  # inside the block
        if kind is PieceKind.HALF_ROUND and np.hypot(s, p[2]) < 0.08:
            continue
        phi, n, tilt, _ = convex_distance(piece, tuple(p), tuple(e))
        assert phi == pytest.approx(nearest(points, yaw, p, e), abs=2e-6)
        assert np.linalg.norm(n) == pytest.approx(1.0, abs=1e-12)
        assert tilt == pytest.approx(np.dot(n, e), abs=1e-14)
        seen += 1
    assert seen > 25


def test_distance_from_waves_is_that_of_brute_force() -> None:
    waves, draw = Sinusoid(amplitude=0.01, wavelength=0.8, yaw=0.25), np.random.default_rng(5)
    piece, points = waves.pieces().rows[0], outline(waves, PieceKind.SINUSOID, 0.25)
    scratch = np.zeros((SAMPLES + 1, 4))
    for _ in range(40):  # crests and troughs rounder than the wheel: one place of contact
        e = turned(*draw.uniform(-0.3, 0.3, 2))[:, 1]
        p = np.array([draw.uniform(-0.2, 0.2), draw.uniform(-0.2, 0.2), 0.0])
        p[2] = waves.height(p[0], p[1]) + 0.125
        phi, n, _, _ = profile_distance(piece, np.empty((0, 0)), tuple(p), tuple(e), RADIUS, scratch)
        assert phi == pytest.approx(nearest(points, 0.25, p, e), abs=1e-6)
        c = p - (np.array(n) - np.dot(n, e) * e) / np.sqrt(1 - np.dot(n, e) ** 2) * phi
        assert c[2] == pytest.approx(float(waves.height(c[0], c[1])), abs=1e-6)


def test_heights_and_derivatives_are_those_of_the_terrain() -> None:
    waves = Sinusoid(amplitude=0.02, wavelength=0.5, yaw=0.4)
    field = sampled_terrain(waves, np.linspace(-1.0, 1.0, 101), np.linspace(-0.5, 0.7, 61))
    draw, h = np.random.default_rng(0), 1e-5
    for terrain in (waves, field):
        pieces = terrain.pieces()
        for x, y in draw.uniform(-0.45, 0.45, (30, 2)):
            found = graph(pieces.rows[0], pieces.knots, x, y)
            around = [(x, y), (x + h, y), (x - h, y), (x, y + h), (x, y - h)]
            z, east, west, north, south = (graph(pieces.rows[0], pieces.knots, *at) for at in around)
            assert z[0] == pytest.approx(float(terrain.height(np.array(x), np.array(y))), abs=1e-14)
            np.testing.assert_allclose(found[1:3], terrain.gradient(np.array(x), np.array(y)), atol=1e-12)
            by_x, by_y = np.subtract(east, west) / (2 * h), np.subtract(north, south) / (2 * h)
            np.testing.assert_allclose(found[3:5], by_x[1:3], atol=2e-3)  # second derivatives jump at grid lines
            np.testing.assert_allclose(found[4:6], by_y[1:3], atol=2e-3)


def deflections(terrain: Terrain, p: tuple[float, float, float], rotation: FloatArray | None = None) -> FloatArray:
    """lambda of every piece."""
    pieces, e = terrain.pieces(), (np.eye(3) if rotation is None else rotation)[:, 1]
    scratch = brush_scratch(pieces)
    find_contacts(p, (e[0], e[1], e[2]), (RADIUS, WIDTH), pieces, scratch.contacts, scratch.samples)
    return scratch.contacts[:, 0].copy()


def test_in_the_corner_of_a_step_ground_and_face_press_each_for_itself() -> None:
    step = Step(rise=0.25, edge_radius=0.02, position=0.3)  # its edge lies above the axle
    found = deflections(step, (0.3 - RADIUS + 0.01, 0.0, RADIUS - 0.02))
    np.testing.assert_allclose(found, [0.01, 0.02], atol=1e-12)
    assert deflections(step, (0.3 - RADIUS - 0.001, 0.0, RADIUS - 0.02))[0] == 0.0


def test_both_edges_of_a_crevasse_carry_the_wheel() -> None:
    trench = Crevasse(width=0.15, depth=0.5, edge_radius=0.01, position=-0.075)
    found = deflections(trench, (0.0, 0.0, RADIUS - 0.04))
    assert found[0] == pytest.approx(found[1], abs=1e-12)
    assert found[0] > 0.001
    assert found[2] == 0.0
    wrench = BrushWheels(trench, 1).forces(motion((0.0, 0.0, RADIUS - 0.04)), np.zeros((1, 6))).wrench[0]
    np.testing.assert_allclose(wrench[[0, 1, 3, 4, 5]], 0.0, atol=1e-9)


def test_ground_given_twice_carries_once() -> None:
    twice = TerrainUnion(parts=(Plane(), inclined_plane(1e-9)))
    assert deflections(twice, (0.0, 0.0, RADIUS - 0.02)).sum() == pytest.approx(0.02, abs=1e-9)


def test_a_valley_lifts_the_rim_to_where_it_fits() -> None:
    slope = np.radians(30.0)
    valley = TerrainUnion(parts=(inclined_plane(slope), inclined_plane(slope, np.pi)))
    height = RADIUS / np.cos(slope) - 0.02  # 20 mm below where the rim touches both sides
    found = deflections(valley, (0.0, 0.0, height))
    np.testing.assert_allclose(2.0 * found * np.cos(slope), 0.02, atol=1e-10)


def test_a_valley_of_a_height_field_is_the_valley_of_two_planes() -> None:
    slope, x = np.radians(30.0), np.linspace(-0.5, 0.5, 1001)
    valley = TerrainUnion(parts=(inclined_plane(slope), inclined_plane(slope, np.pi)))
    field = sampled_terrain(valley, x, np.linspace(-0.1, 0.1, 5))
    height = RADIUS / np.cos(slope) - 0.02
    for place in (-0.004, 0.0, 0.003):
        p = (place, 0.0, height)
        smooth = BrushWheels(field, 1).forces(motion(p), np.zeros((1, 2))).wrench[0]
        planes = BrushWheels(valley, 1).forces(motion(p), np.zeros((1, 4))).wrench[0]
        np.testing.assert_allclose(smooth[:3], planes[:3], atol=0.0007 * STIFFNESS)  # samples 9 mm apart


def test_a_leaning_wheel_in_a_valley_is_lifted_upright() -> None:
    slope = np.radians(30.0)
    valley = TerrainUnion(parts=(inclined_plane(slope), inclined_plane(slope, np.pi)))
    field = sampled_terrain(valley, np.linspace(-0.5, 0.5, 1001), np.linspace(-0.5, 0.5, 11))
    p, leaning = (0.0, 0.0, RADIUS / np.cos(slope) - 0.02), turned(0.2)
    smooth = BrushWheels(field, 1).forces(motion(p, leaning), np.zeros((1, 2))).wrench[0]
    planes = BrushWheels(valley, 1).forces(motion(p, leaning), np.zeros((1, 4))).wrench[0]
    np.testing.assert_allclose(planes[:2], 0.0, atol=1e-9)  # both sides together push straight up
    np.testing.assert_allclose(smooth[:3], planes[:3], atol=0.0007 * STIFFNESS)
    assert abs(smooth[1]) < 0.01 * smooth[2]


def test_force_changes_little_by_little_where_places_of_contact_come_and_go() -> None:
    long, short = Sinusoid(amplitude=0.02, wavelength=0.21), Sinusoid(amplitude=0.015, wavelength=0.13, position=0.03)
    both = TerrainUnion(parts=(long, short))
    rough = sampled_terrain(both, np.linspace(-0.5, 0.5, 101), np.linspace(-0.5, 0.5, 11))
    wheels, steps = BrushWheels(rough, 1), np.arange(-0.2, 0.2, 1e-4)
    force = np.array([wheels.forces(motion((x, 0.0, 0.13)), np.zeros((1, 2))).wrench[0, [0, 2]] for x in steps])
    jump = np.abs(np.diff(force, axis=0)).max()
    assert force[:, 1].max() - force[:, 1].min() > 50.0
    assert jump < 0.0012 * STIFFNESS  # a millimetre of deflection; the step is 0.1 mm


def test_force_changes_little_by_little_beside_a_steep_rock() -> None:
    """Two samples away from the closest point may hold the rim: the camber is theirs, not that of the closest point."""
    rock = RandomRocks(seed=2, size=(23.0, 16.0), origin=(-1.5, -8.0), abundance=0.06, diameters=(0.1, 0.625))
    wheels, steps = BrushWheels(rock.terrain(), 1), np.arange(17.29, 17.33, 1e-4)
    found = np.array([wheels.forces(motion((x, 0.7086, 0.1186)), np.zeros((1, 2))).wrench[0, :3] for x in steps])
    assert np.abs(np.diff(found, axis=0)).max() < 0.0012 * STIFFNESS  # a millimetre of deflection; it was 50 mm
    assert np.abs(found[:, 1]).max() > 20.0  # the rock pushes sideways


CASES: list[tuple[Terrain, FloatArray, FloatArray]] = [
    (inclined_plane(0.3, 0.4), np.array([0.0, 0.0, 0.13]), turned(0.2, 0.5)),
    (inclined_plane(0.3, 0.4), np.array([0.0, 0.0, 0.145]), turned(0.35, 0.5)),
    (Step(rise=0.25, edge_radius=0.02, position=0.1), np.array([-0.03, 0.0, 0.12]), np.eye(3)),
    (Step(rise=0.1, edge_radius=0.02, position=0.1), np.array([0.0, 0.0, 0.13]), np.eye(3)),
    (HalfRound(radius=0.05), np.array([0.03, 0.0, 0.15]), np.eye(3)),
    (Sinusoid(amplitude=0.01, wavelength=0.8, yaw=0.3), np.array([0.1, 0.0, 0.12]), turned(0.0, 0.1)),
]


@pytest.mark.parametrize(("terrain", "p", "rotation"), CASES)
def test_spring_force_and_moment_derive_from_the_energy(terrain: Terrain, p: FloatArray, rotation: FloatArray) -> None:
    wheels = BrushWheels(terrain, 1)
    state = wheels.initial_state()

    def work(a: FloatArray, b: FloatArray, steps: int = 200) -> float:
        """Work of the wrench from a to b at fixed rotation."""
        t = (np.arange(steps) + 0.5) / steps
        return float(
            sum(wheels.forces(motion(a + s * (b - a), rotation), state).wrench[0, :3] @ (b - a) for s in t) / steps
        )

    assert wheels.forces(motion(p, rotation), state).output[0, 1] > 1.0
    corners = list(p + np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.01, 0.0, 0.008], [0.0, 0.004, 0.008]]))
    loop = sum(work(a, b) for a, b in zip(corners, [*corners[1:], p], strict=True))
    scale = STIFFNESS * 0.02**2
    assert abs(loop) < 2e-4 * scale


def test_moment_of_camber_is_the_derivative_of_the_energy_by_rotation() -> None:
    p, h = np.array([0.0, 0.0, 0.13]), 1e-6
    wheels = BrushWheels(Plane(), 1)

    def energy(camber: float) -> float:
        """Integral of k/2b max(delta, 0)^2 over the width."""
        y = (np.arange(200000) + 0.5) / 200000 * WIDTH - 0.5 * WIDTH
        delta = RADIUS - (p[2] + y * np.sin(camber)) / np.cos(camber)
        return float(0.5 * STIFFNESS * np.mean(np.maximum(delta, 0.0) ** 2))

    for camber in (0.05, 0.3):
        moment = wheels.forces(motion(p, turned(camber)), wheels.initial_state()).wrench[0, 3]
        assert moment == pytest.approx(-(energy(camber + h) - energy(camber - h)) / (2 * h), rel=1e-5)


def test_force_is_continuous_over_an_edge_and_through_camber() -> None:
    wheels = BrushWheels(Step(rise=0.05, edge_radius=0.01, position=0.0), 1)
    state = wheels.initial_state()
    z = np.linspace(-0.2, 0.2, 8001)
    passed = np.array([wheels.forces(motion((x, 0.0, 0.16)), state).wrench[0] for x in z])
    leaned = np.array([wheels.forces(motion((-0.5, 0.0, 0.1), turned(a)), state).wrench[0] for a in 7.0 * z])
    assert np.abs(np.diff(passed, axis=0)).max() < 4.0
    assert np.abs(np.diff(leaned, axis=0)).max() < 4.0
    assert np.abs(passed).max() > 100.0
    assert np.abs(leaned).max() > 100.0


def test_a_wheel_on_its_side_is_not_carried() -> None:
    wheels = BrushWheels(TerrainUnion(parts=(Plane(), Sinusoid(amplitude=0.001, wavelength=1.0))), 1)
    assert wheels.forces(motion((0.0, 0.0, 0.01), turned(np.pi / 2)), wheels.initial_state()).output[0, 1] == 0.0
