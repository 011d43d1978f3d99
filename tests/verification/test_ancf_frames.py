"""Claim: L-, T- and V-frames of plates that share their corner nodes bend as closed-form frames, to 1 %.

A stem of height H stands clamped; at its top an arm of length B goes off at an angle theta to the horizontal (L: 0;
V: 50 and -35 degrees; T: two arms, one loaded). A vertical force P at the arm's end moves it by
    P cos(theta)^2 (B^3 / 3 + B^2 H) / (E I)
(unit-load theorem, bending only; legs 1 mm thick and 50 mm long, so that axial and shear parts stay below 0.1 %). The
plates' slopes differ at the corner by any angle and no constraint equation joins them (thesis eqs. 2.17 to 2.19). Eight
plates a leg: six times as long as thick. Tolerance 1 %: the shared node lets the corner shear, with a stiffness in
proportion to the plates' length (see `plate_mesh`), which is measured below: plates half as long as thick are far too
soft. Negative control: 2 % of thickness.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import build_plate_model

HEIGHT, LENGTH, WIDTH, THICKNESS, YOUNG, FORCE = 0.05, 0.05, 0.01, 1e-3, 1e9, 1.0
X, Y, Z = np.eye(3)


@functools.cache
def tip_drop(angles_deg: tuple[float, ...], plates: int = 8, thickness: float = THICKNESS) -> float:
    """Linear drop of the first arm's end under the force [m]; one arm for each angle."""
    patches = [
        flat_patch(i * HEIGHT / plates * Z, HEIGHT / plates * Z, WIDTH * Y, thickness, "stem") for i in range(plates)
    ]
    ways = [np.cos(a) * X + np.sin(a) * Z for a in np.deg2rad(angles_deg)]
    for way in ways:
        start, step = HEIGHT * Z, LENGTH / plates * way
        patches += [flat_patch(start + i * step, step, WIDTH * Y, thickness, "arm") for i in range(plates)]
    mesh = build_plate_mesh(patches)
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=1.0)
    tip = np.abs((mesh.points - HEIGHT * Z - LENGTH * ways[0]) @ np.array([X, Z]).T).max(axis=1) < 1e-9
    assert tip.sum() == 2
    assert len(mesh.points) == 2 * (plates * (1 + len(ways)) + 1)  # the corner is shared
    force = np.zeros((len(mesh.points), 4, 3))
    force[tip, 0, 2] = -0.5 * FORCE
    rows = np.flatnonzero(np.repeat(mesh.points[:, 2] > 1e-9, 12) | np.repeat(mesh.points[:, 0] > 1e-9, 12))
    K = model.elastic_tangent(mesh.reference_coordinates())[np.ix_(rows, rows)]
    return float(np.linalg.solve(K, force.ravel()[rows]) @ force.ravel()[rows]) / FORCE


def frame_drop(angle_deg: float) -> float:
    """Closed form [m]."""
    bending = YOUNG * WIDTH * THICKNESS**3 / 12.0
    return float(FORCE * np.cos(np.deg2rad(angle_deg)) ** 2 * (LENGTH**3 / 3.0 + LENGTH**2 * HEIGHT) / bending)


@pytest.mark.parametrize("angles", [(0.0,), (0.0, 180.0), (50.0,), (-35.0, 200.0)], ids=["L", "T", "V", "skew T"])
def test_frames_bend_as_frames(angles: tuple[float, ...]) -> None:
    assert tip_drop(angles) == pytest.approx(frame_drop(angles[0]), rel=0.01)


def test_short_plates_soften_the_corner() -> None:
    """The limit stated in `plate_mesh`: plates half as long as thick have a soft corner; longer ones do not."""
    thick = 0.2 * LENGTH
    slender_part = frame_drop(0.0) * (THICKNESS / thick) ** 3
    soft, stiff = (tip_drop((0.0,), n, thick) / slender_part for n in (10, 2))
    assert soft > 1.15
    assert soft > stiff + 0.05


def test_a_thicker_strip_is_caught() -> None:
    """Negative control: 2 % of thickness is 6 % of stiffness."""
    assert tip_drop((0.0,), thickness=1.02 * THICKNESS) / frame_drop(0.0) < 0.96
