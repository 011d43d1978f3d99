"""Curved plates and shared-gradient joints against beam theory.

Claim 1: a 90 deg arch of rim plates (R = 130 mm, t = 25 mm, nu = 0), clamped at both ends, line load at its crown,
converges to the Timoshenko arch. Source: straight Timoshenko beams assembled here (512 elements, converged to 1e-4;
shear factor 1, because plates with a straight director have no other). Tolerance: 1.5 % at 32 plates: beam theory
leaves out terms of order t/R squared, and the kink of slope under the line load is spread over one plate. The
differences between meshes fall at an order above 1.4 (the kink), on 8, 16, 32 plates. Negative control: 24 mm plates.

Claim 2 (a limitation found here): a corner of two plates that share 12 structure coordinates passes moments only by
shear strain of the plates next to the node, so its rotational stiffness falls in proportion to the plates' length.
Source: computed here, L of two 100 mm arms against beam theory with a rigid corner. Tolerance: order 1 +- 0.1.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.plate_mesh import PlatePatch, build_plate_mesh, flat_patch
from ancf_reduced.plate_model import build_plate_model
from ancf_reduced.tire_mesh import rim_patch
from ancf_reduced.tire_preset import thesis_preset
from contracts.frames import ground_direction_h

E, WIDTH, THICKNESS, RADIUS, ARM = 280e3, 0.12, 0.025, 0.13, 0.1
X, Y, Z = np.eye(3)


def _line_compliance(patches: list[PlatePatch], fixed_at: np.ndarray, load_at: np.ndarray, along: np.ndarray) -> float:
    """Displacement per force [m/N] of a line load over the width; nodes in the x-z plane are told by position."""
    mesh = build_plate_mesh(patches)
    model = build_plate_model(mesh, young_modulus=E, poisson_ratio=0.0, density=1.0)
    in_plane = mesh.points[:, [0, 2]]
    loaded = np.linalg.norm(in_plane - load_at, axis=1) < 1e-6
    fixed = np.linalg.norm(in_plane[:, None] - fixed_at, axis=2).min(axis=1) < 1e-6
    force = np.zeros((len(in_plane), 4, 3))
    force[loaded, 0] = 0.5 * along
    centred = mesh.points[loaded, 1] - mesh.points[loaded, 1].mean()
    force[loaded, 2] = -np.sign(centred)[:, None] * WIDTH / 12.0 * along  # consistent with a uniform line load
    rows = (12 * np.flatnonzero(~fixed)[:, None] + np.arange(12)).ravel()
    tangent = model.elastic_tangent(mesh.reference_coordinates())[np.ix_(rows, rows)]
    return float(force.ravel()[rows] @ np.linalg.solve(tangent, force.ravel()[rows]))


def _arch(plates: int, thickness: float = THICKNESS) -> float:
    """Crown stiffness [N/m] of the arch of plates, mid-surface radius 130 mm."""
    preset = replace(thesis_preset(), rim_thickness=thickness, outer_radius=RADIUS + 0.5 * thickness)
    angle = 0.5 * np.pi / plates
    ends = np.array([RADIUS * ground_direction_h(phi)[[0, 2]] for phi in (0.0, 0.5 * np.pi)])
    crown = ground_direction_h(0.25 * np.pi)
    patches = [rim_patch(preset, i * angle, angle) for i in range(plates)]
    return 1.0 / _line_compliance(patches, ends, RADIUS * crown[[0, 2]], -crown)


def _timoshenko_beam(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Stiffness (6, 6) of a straight Timoshenko beam in the plane: u, w, rotation at both ends; shear factor 1."""
    area, inertia = THICKNESS * WIDTH, WIDTH * THICKNESS**3 / 12.0
    L = float(np.linalg.norm(end - start))
    c, s = (end - start) / L
    shear = 12.0 * E * inertia / (0.5 * E * area * L**2)
    b = E * inertia / ((1.0 + shear) * L**3)
    k = np.zeros((6, 6))
    k[np.ix_([0, 3], [0, 3])] = E * area / L * np.array([[1, -1], [-1, 1]])
    near, far = (4.0 + shear) * L**2, (2.0 - shear) * L**2
    bend = [[12, 6 * L, -12, 6 * L], [6 * L, near, -6 * L, far], [-12, -6 * L, 12, -6 * L], [6 * L, far, -6 * L, near]]
    k[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = b * np.array(bend)
    turn = np.kron(np.eye(2), np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))
    return np.asarray(turn.T @ k @ turn)


def _beam_arch(beams: int = 512) -> float:
    """Crown stiffness [N/m] of the same arch by beam theory."""
    angle = np.linspace(0.0, 0.5 * np.pi, beams + 1)
    points = RADIUS * np.column_stack([np.cos(angle), np.sin(angle)])
    stiffness, force = np.zeros((3 * beams + 3,) * 2), np.zeros(3 * beams + 3)
    for i in range(beams):
        rows = slice(3 * i, 3 * i + 6)
        stiffness[rows, rows] += _timoshenko_beam(points[i], points[i + 1])
    force[3 * (beams // 2) : 3 * (beams // 2) + 2] = -points[beams // 2] / RADIUS
    inner = slice(3, -3)
    return 1.0 / float(force[inner] @ np.linalg.solve(stiffness[inner, inner], force[inner]))


def test_arch_converges_to_beam_theory() -> None:
    stiffness = np.array([_arch(n) for n in (8, 16, 32)])
    order = np.log2((stiffness[0] - stiffness[1]) / (stiffness[1] - stiffness[2]))
    assert stiffness[-1] == pytest.approx(_beam_arch(), rel=0.015)
    assert order > 1.4


def test_thinner_arch_is_caught() -> None:
    """Negative control: 24 mm plates must miss the 1.5 %."""
    assert abs(_arch(32, thickness=0.024) / _beam_arch() - 1.0) > 0.015


def _joint_stiffness(plates: int) -> float:
    """Rotational stiffness [N m/rad] of the corner of an L, from the tip's excess over a rigid corner."""
    h = ARM / plates
    patches = [flat_patch(i * h * X, h * X, WIDTH * Y, THICKNESS, "foot") for i in range(plates)]
    patches += [flat_patch(ARM * X + i * h * Z, h * Z, WIDTH * Y, THICKNESS, "arm") for i in range(plates)]
    tip = _line_compliance(patches, np.zeros((1, 2)), np.array([ARM, ARM]), X)
    area, inertia = THICKNESS * WIDTH, WIDTH * THICKNESS**3 / 12.0
    bending = ARM**3 / (3.0 * E * inertia) + ARM**3 / (E * inertia)
    return ARM**2 / (tip - bending - ARM / (0.5 * E * area) - ARM / (E * area))


def test_shared_gradients_make_a_corner_that_softens_with_the_mesh() -> None:
    stiffness = np.array([_joint_stiffness(n) for n in (8, 16, 32)])
    np.testing.assert_allclose(np.log2(stiffness[:-1] / stiffness[1:]), 1.0, atol=0.1)
