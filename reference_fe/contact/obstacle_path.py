"""Where an obstacle is over its control parameter: it rises, then moves along the ground, or turns about the hub.

Verified by tests/unit/test_fe_obstacle_path.py and tests/verification/test_fe_working_load.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contracts.hub_travel import HubTravel

__all__ = ["ObstaclePath", "Place"]

Array = NDArray[np.float64]
_AXLE = np.array([0.0, 1.0, 0.0])
"""In the wheel's frame."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Place:
    """Rigid motion X -> R X + p of an obstacle since control parameter 0.

    Attributes
    ----------
    rotation : R (dim, dim) [-]; None is no turn
    moved : p (dim,) [m]
    """

    rotation: Array | None
    moved: Array

    def of(self, points: Array) -> Array:
        """Where points (..., dim) of the obstacle are now."""
        return self.moved + self.turned(points)

    def back(self, points: Array) -> Array:
        """Points (..., dim) in space as points of the obstacle."""
        held = points - self.moved
        return held if self.rotation is None else np.asarray(held @ self.rotation)

    def turned(self, vectors: Array) -> Array:
        """Vectors (..., dim) that turn with the obstacle."""
        return vectors if self.rotation is None else np.asarray(vectors @ self.rotation.T)

    def turned_back(self, vectors: Array) -> Array:
        """Vectors (..., dim) in space as vectors of the obstacle."""
        return vectors if self.rotation is None else np.asarray(vectors @ self.rotation)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ObstaclePath:
    """The obstacle's place over the control parameter.

    Attributes
    ----------
    normal, along, rise : unit vectors (dim,) of the ground's normal, of what is forward on it, and of its rise [-]
    travel : what follows the rise, or None
    """

    normal: Array
    along: Array
    rise: Array
    travel: HubTravel | None = None

    def place(self, control: float) -> Place:
        """At a control parameter [m]."""
        if self.travel is None or control <= self.travel.start:
            return Place(rotation=None, moved=control * self.rise)
        motion = self.travel.ground(control)
        moved = motion.up * self.rise + motion.forward * self.along
        if motion.left:
            moved = moved + motion.left * np.cross(self.normal, self.along)
        turns = (motion.leant, self.along), (motion.wound, _AXLE), (motion.turned, self.normal)
        about = [angle * axis for angle, axis in turns if angle]
        if not about:
            return Place(rotation=None, moved=moved)
        R = Rotation.from_rotvec(sum(about[1:], start=about[0])).as_matrix()
        return Place(rotation=R, moved=R @ moved)

    def axes(self, control: float) -> tuple[Array, Array]:
        """Unit normal of the ground at a control parameter [m], and what is forward on it, (dim,) each [-]."""
        place = self.place(control)
        return place.turned(self.normal), place.turned(self.along)
