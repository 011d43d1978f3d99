"""What the names of a mesh file stand for in a wheel, and where the wheel lies in the file's axes.

Verified by tests/unit/test_own_mesh_wheel.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["AXES", "Placement", "Roles"]

AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Where the wheel lies in the axes of its file.

    Attributes
    ----------
    unit : length of the file's unit [m]
    axle : axis of the file along the axle, the wheel frame's y
    up : axis of the file that is the wheel frame's z; what faces the ground at 0 degrees lies at its lower end
    centre : the hub's centre in the file's axes, (3,) [m]
    """

    unit: float
    axle: str = "y"
    up: str = "z"
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.unit) and self.unit > 0.0):
            raise InputError("unit of length", f"{self.unit:g} m", "must be > 0", 'give units = "mm"')
        if self.axle not in AXES or self.up not in AXES or self.axle == self.up:
            rule = "must be two of x, y, z"
            raise InputError("axle and up", f"{self.axle}, {self.up}", rule, "y and z are usual", key="up")

    def to_wheel(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (n, 3) of the file, in its unit, in the wheel frame [m]: x forward is axle cross up."""
        left, up = np.eye(3)[AXES.index(self.axle)], np.eye(3)[AXES.index(self.up)]
        turned = np.stack([np.cross(left, up), left, up])
        return np.asarray((self.unit * points - np.array(self.centre)) @ turned.T)


@dataclass(frozen=True, slots=True, kw_only=True)
class Roles:
    """Names of the file's groups by what they are in the wheel.

    Attributes
    ----------
    parts : part -> the file's groups of cells that it consists of
    hub : parts and groups of faces that are held
    ground : groups of faces that may touch the ground
    contact : pairs of groups of faces that may touch each other, the first is held off the second
    symmetry : group of faces in the plane y = 0 of half a wheel; empty for a whole one
    """

    parts: Mapping[str, tuple[str, ...]]
    hub: tuple[str, ...]
    ground: tuple[str, ...]
    contact: tuple[tuple[str, str], ...] = ()
    symmetry: str = ""

    @property
    def held_parts(self) -> tuple[str, ...]:
        """Parts that are held whole."""
        return tuple(name for name in self.hub if name in self.parts)

    @property
    def held_faces(self) -> tuple[str, ...]:
        """Groups of faces that are held."""
        return tuple(name for name in self.hub if name not in self.parts)

    @property
    def faces(self) -> dict[str, str]:
        """Every group of faces that is named -> the key that names it first."""
        asked = [("hub", name) for name in self.held_faces] + [("ground", name) for name in self.ground]
        asked += [("contact", name) for pair in self.contact for name in pair]
        asked += [("symmetry", self.symmetry)] if self.symmetry else []
        return {name: key for key, name in reversed(asked)}
