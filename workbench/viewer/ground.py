"""What a wheel stands on in the 3D view: level ground, or the obstacle it was pressed on.

Verified by tests/unit/test_viewer_ground.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import Plane, Terrain
from workbench.charts.solids import Quads

__all__ = ["Ground"]

FloatArray = NDArray[np.float64]
_BELOW = 3e-4
"""Room between the wheel and what is drawn below it [m], so that neither shows through."""
_ACROSS = 241
"""Points of an obstacle along its way."""
_SHARES = np.linspace(0.0, 1.0, 7)
"""Where a face is looked at along each side: an obstacle may be narrower than it."""
_SPOKEN = {"step": "on a step", "cleat": "on a cleat", "half_round_rock": "on a half-round"}


@dataclass(frozen=True, kw_only=True)
class Ground:
    """Ground that the wheel touches, wherever that is.

    Attributes
    ----------
    shape : ``plane``, or that of an obstacle
    terrain : in the frame of the wheel that stands upright, x forward, y left; only its shape counts
    camber : about the forward direction [rad]; positive lifts the ground's left side
    """

    shape: str = "plane"
    terrain: Terrain = field(default_factory=Plane)
    camber: float = 0.0

    @property
    def words(self) -> str:
        """``on a cleat``; nothing of level ground."""
        words = _SPOKEN.get(self.shape, "")
        return f"{words}, camber {np.degrees(self.camber):.3g}°".removeprefix(", ") if self.camber else words

    @property
    def lean(self) -> FloatArray:
        """Rotation (3, 3) from the frame of the upright wheel to that in which the ground is level."""
        sin, cos = np.sin(self.camber), np.cos(self.camber)
        return np.array([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]])

    def under(self, places: FloatArray, faces: NDArray[np.int64]) -> Quads:
        """The piece of ground that a wheel touches.

        places : of all its points (n, 3) [m], the ground level
        faces : (k, 4) of its corners
        """
        half = 0.85 * float(np.abs(places).max())
        level = isinstance(self.terrain, Plane)
        ahead = np.linspace(-half, half, 2 if level else _ACROSS)
        yaw = getattr(self.terrain, "yaw", 0.0)
        s, t = np.meshgrid(ahead, [-half, half], indexing="ij")
        x, y = np.cos(yaw) * s - np.sin(yaw) * t, np.sin(yaw) * s + np.cos(yaw) * t
        z = np.broadcast_to(self.terrain.height(x, y), x.shape)
        touching = places if level else _within(places, faces, float(np.ptp(z)))
        gap = touching[:, 2] - self.terrain.height(touching[:, 0], touching[:, 1])
        corners = np.stack([x, y, z + float(gap.min()) - _BELOW], axis=-1).reshape(-1, 3)
        first = 2 * np.arange(len(ahead) - 1)
        return corners, np.stack([first, first + 2, first + 3, first + 1], axis=-1)


def _within(places: FloatArray, faces: NDArray[np.int64], rise: float) -> FloatArray:
    """Points (m, 3) within the faces that may touch ground whose heights differ by a rise [m]."""
    corners = places[faces]
    low = corners[corners[:, :, 2].min(axis=1) <= places[:, 2].min() + rise]
    a, b = (one.ravel() for one in np.meshgrid(_SHARES, _SHARES))
    weights = np.stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    return np.asarray(np.einsum("kcx,cm->kmx", low, weights).reshape(-1, 3))
