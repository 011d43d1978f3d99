"""A clamped 90 degree arch of rim plates with a line load at its crown, and the corner of an L, against beam theory.

Arch: R = 130 mm, t = 25 mm, nu = 0. Source: straight Timoshenko beams assembled here (512 elements, converged to 1e-4;
shear factor 1, because plates with a straight director have no other). Beam theory leaves out terms of order (t/R)^2,
and the kink of slope under the line load is spread over one plate.
Corner: two plates that share 12 structure coordinates pass a moment only by shear strain of the plates next to the
node. Its rotational stiffness is found from the excess of an L's tip displacement over that with a rigid corner.
Verified by tests/verification/test_ancf_arch.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.mesh import PlatePatch, build_plate_mesh
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.tire.mesh import rim_patch
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.verification.plate_strips import compliance, strip
from contracts.frames import ground_direction_h

__all__ = ["THICKNESS", "PressedArch", "corner_stiffness", "pressed_arch"]

FloatArray = NDArray[np.float64]
YOUNG, WIDTH, THICKNESS, RADIUS, ARM = 280e3, 0.12, 0.025, 0.13, 0.1
AREA, INERTIA = THICKNESS * WIDTH, WIDTH * THICKNESS**3 / 12.0
X, Y, Z = np.eye(3)


@dataclass(frozen=True, slots=True, kw_only=True)
class PressedArch:
    """What the run measured, and beam theory at the nominal thickness: line load over its displacement [N/m]."""

    stiffness: float
    beam: float

    @property
    def error(self) -> float:
        """|stiffness / beam - 1| [-]."""
        return abs(self.stiffness / self.beam - 1.0)


def pressed_arch(plates: int = 32, thickness: float = THICKNESS) -> PressedArch:
    """Crown stiffness [N/m] of the arch of plates of a ``thickness`` [m], mid-surface radius 130 mm."""
    preset = replace(thesis_preset(), rim_thickness=thickness, outer_radius=RADIUS + 0.5 * thickness)
    angle = 0.5 * np.pi / plates
    ends = [RADIUS * ground_direction_h(phi)[[0, 2]] for phi in (0.0, 0.5 * np.pi)]
    crown = ground_direction_h(0.25 * np.pi)
    patches = [rim_patch(preset, i * angle, angle) for i in range(plates)]
    return PressedArch(
        stiffness=1.0 / _line_compliance(patches, ends, RADIUS * crown[[0, 2]], -crown), beam=_beam_arch()
    )


def corner_stiffness(plates: int) -> float:
    """Rotational stiffness of the corner of an L of two 100 mm arms, ``plates`` each [N m/rad]."""
    patches = strip(0.0 * X, ARM * X, WIDTH * Y, THICKNESS, plates, "foot")
    patches += strip(ARM * X, ARM * Z, WIDTH * Y, THICKNESS, plates, "arm")
    tip = _line_compliance(patches, [np.zeros(2)], np.array([ARM, ARM]), X)
    bending = ARM**3 / (3.0 * YOUNG * INERTIA) + ARM**3 / (YOUNG * INERTIA)
    return ARM**2 / (tip - bending - ARM / (0.5 * YOUNG * AREA) - ARM / (YOUNG * AREA))


def _line_compliance(
    patches: Sequence[PlatePatch], held_at: Sequence[FloatArray], load_at: FloatArray, along: FloatArray
) -> float:
    """Displacement per force [m/N] of a line load over the width; nodes in the x-z plane are told by position."""
    mesh = build_plate_mesh(patches)
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=1.0)
    in_plane = mesh.points[:, [0, 2]]
    loaded = np.linalg.norm(in_plane - load_at, axis=1) < 1e-6
    held = np.linalg.norm(in_plane[:, None] - np.array(held_at), axis=2).min(axis=1) < 1e-6
    force = np.zeros((len(in_plane), 4, 3))
    force[loaded, 0] = 0.5 * along
    centred = mesh.points[loaded, 1] - mesh.points[loaded, 1].mean()
    force[loaded, 2] = -np.sign(centred)[:, None] * WIDTH / 12.0 * along  # consistent with a uniform line load
    return compliance(model, np.broadcast_to(~held[:, None, None], force.shape), force)


def _timoshenko_beam(start: FloatArray, end: FloatArray) -> FloatArray:
    """Stiffness (6, 6) of a straight Timoshenko beam in the plane: u, w, rotation at both ends; shear factor 1."""
    L = float(np.linalg.norm(end - start))
    c, s = (end - start) / L
    shear = 12.0 * YOUNG * INERTIA / (0.5 * YOUNG * AREA * L**2)
    b = YOUNG * INERTIA / ((1.0 + shear) * L**3)
    k = np.zeros((6, 6))
    k[np.ix_([0, 3], [0, 3])] = YOUNG * AREA / L * np.array([[1, -1], [-1, 1]])
    near, far = (4.0 + shear) * L**2, (2.0 - shear) * L**2
    bend = [[12, 6 * L, -12, 6 * L], [6 * L, near, -6 * L, far], [-12, -6 * L, 12, -6 * L], [6 * L, far, -6 * L, near]]
    k[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = b * np.array(bend)
    turn = np.kron(np.eye(2), np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))
    return np.asarray(turn.T @ k @ turn)


@cache
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
