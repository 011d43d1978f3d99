"""L-, T- and V-frames of plates that share their corner nodes, and the stiffness of such a corner.

A stem of height H stands clamped; at its top an arm of length B goes off at an angle theta to the horizontal (L: 0;
V: 50 and -35 degrees; T: two arms, one loaded). A vertical force P at the arm's end moves it by
    P cos(theta)^2 (B^3 / 3 + B^2 H) / (E I)
(unit-load theorem, bending only; legs 1 mm thick and 50 mm long, so that axial and shear parts stay below 0.1 %). The
plates' slopes differ at the corner by any angle and no constraint equation joins them (thesis eqs. 2.17 to 2.19).
Verified by tests/verification/test_ancf_frames.py and tests/verification/test_ancf_arch.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.verification.plate_strips import compliance, strip

__all__ = ["FRAMES", "LENGTH", "THICKNESS", "LoadedFrame", "frame_drop", "loaded_frame"]

HEIGHT, LENGTH, WIDTH, THICKNESS, YOUNG, FORCE = 0.05, 0.05, 0.01, 1e-3, 1e9, 0.01
FRAMES = {"L": (0.0,), "T": (0.0, 180.0), "V": (50.0,), "skew T": (-35.0, 200.0)}
"""Name -> angles of the arms [deg]; the first one is loaded."""
X, Y, Z = np.eye(3)


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadedFrame:
    """What the run measured, and the closed form at the nominal thickness: drop of the loaded arm's end [m].

    ``nodes`` of the mesh: the corner's two are shared by stem and arms.
    """

    drop: float
    expected: float
    nodes: int


def loaded_frame(angles_deg: tuple[float, ...], plates: int = 8, thickness: float = THICKNESS) -> LoadedFrame:
    """Linear drop [m] of the first arm's end under the force; one arm for each angle [deg], ``plates`` a leg."""
    patches = strip(0.0 * Z, HEIGHT * Z, WIDTH * Y, thickness, plates, "stem")
    ways = [LENGTH * (np.cos(a) * X + np.sin(a) * Z) for a in np.deg2rad(angles_deg)]
    for way in ways:
        patches += strip(HEIGHT * Z, way, WIDTH * Y, thickness, plates, "arm")
    mesh = build_plate_mesh(patches)
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=1.0)
    tip = np.abs((mesh.points - HEIGHT * Z - ways[0])[:, [0, 2]]).max(axis=1) < 1e-9
    foot = np.abs(mesh.points[:, [0, 2]]).max(axis=1) < 1e-9
    force = np.zeros((len(mesh.points), 4, 3))
    force[tip, 0, 2] = -FORCE / tip.sum()
    free = np.broadcast_to(~foot[:, None, None], force.shape)
    return LoadedFrame(
        drop=compliance(model, free, force) / FORCE, expected=frame_drop(angles_deg[0]), nodes=len(mesh.points)
    )


def frame_drop(angle_deg: float, thickness: float = THICKNESS) -> float:
    """Closed form [m]."""
    bending = YOUNG * WIDTH * thickness**3 / 12.0
    return float(FORCE * np.cos(np.deg2rad(angle_deg)) ** 2 * (LENGTH**3 / 3.0 + LENGTH**2 * HEIGHT) / bending)
