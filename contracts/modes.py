"""Natural modes of a body about a state of rest, whatever model they come from.

With the stiffness K and the mass M of small motions, K phi = lambda M phi, modes have unit modal mass, phi^T M phi = 1.
A rigid motion r of the body's support moves mode i by its participation g = phi^T M r; g^2 is the modal effective
mass of that direction (docs/theory/vibration.md). Verified by tests/unit/test_modes_contract.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["DIRECTIONS", "Modes", "rigid_motions"]

Array = NDArray[np.float64]
DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
"""Translations along the axes of the wheel frame and turns about them through the origin, in the order of arrays."""
_SAME = 1e-3
"""Relative difference of frequencies below which modes share theirs: a wheel's come in pairs."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Modes:
    """Modes in the order of their eigenvalues, the lowest first.

    Attributes
    ----------
    eigenvalue : (n,) lambda [1/s^2], negative where the state is unstable
    shape : (n, n_points, 3) displacement of each mode at the points, wheel frame, unit modal mass [1/sqrt(kg)]
    points : (n_points, 3) places of the points at rest without load [m]
    weight : (n_points,) share of the body's mass at each point, for shares of energy alone [kg]
    participation : (n, 6) by `DIRECTIONS` [sqrt(kg) for translations, m sqrt(kg) for turns about the origin]
    moving : (6,) what effective masses add up to over all modes: the mass that moves against the support
        [kg; kg m^2]
    whole : (6,) mass and moments of inertia of the body with what its support holds [kg; kg m^2]
    rigid : (n,) whether a mode is a motion of the whole body as a rigid one
    parity : (n,) 1 for modes with a mirror plane y = 0 (even), -1 for those that are odd about it, 0 where not known

    Raises
    ------
    InputError
        For arrays that do not belong together.
    """

    eigenvalue: Array
    shape: Array
    points: Array
    weight: Array
    participation: Array
    moving: Array
    whole: Array
    rigid: NDArray[np.bool_]
    parity: NDArray[np.int64]

    def __post_init__(self) -> None:
        n, m = len(self.eigenvalue), len(self.points)
        shapes = {
            "shape": (n, m, 3),
            "points": (m, 3),
            "weight": (m,),
            "participation": (n, 6),
            "moving": (6,),
            "whole": (6,),
            "rigid": (n,),
            "parity": (n,),
        }
        for name, expected in shapes.items():
            found = np.shape(getattr(self, name))
            if found != expected:
                raise InputError(f"modes: {name}", found, f"must have the shape {expected}", "see contracts.modes")

    @property
    def frequency(self) -> Array:
        """(n,) sqrt(lambda) / 2 pi [Hz]; 0 for rigid motions and where lambda < 0."""
        found = np.sqrt(np.maximum(self.eigenvalue, 0.0)) / (2.0 * np.pi)
        return np.where(self.rigid, 0.0, found)

    @property
    def growth(self) -> Array:
        """(n,) rate sqrt(-lambda) at which a disturbance grows where lambda < 0, else 0 [1/s]."""
        return np.where(self.rigid, 0.0, np.sqrt(np.maximum(-self.eigenvalue, 0.0)))

    @property
    def unstable(self) -> int:
        """Number of modes that grow: the state is no stable equilibrium if there are any."""
        return int((self.growth > 0.0).sum())

    @property
    def effective_mass(self) -> Array:
        """(n, 6) modal effective masses and moments of inertia [kg; kg m^2]."""
        return self.participation**2

    def whole_pairs(self, count: int) -> Modes:
        """The first ``count`` modes besides rigid ones, and the next where it shares the last one's frequency."""
        end = int(self.rigid.sum()) + count
        if end < len(self.eigenvalue) and self._shared(end):
            end += 1
        cut = {f: getattr(self, f)[:end] for f in ("eigenvalue", "shape", "participation", "rigid", "parity")}
        return replace(self, **cut)

    def _shared(self, i: int) -> bool:
        """Whether a mode shares the frequency of the one before."""
        value, before = self.eigenvalue[i], self.eigenvalue[i - 1]
        return bool(abs(value - before) <= 2.0 * _SAME * abs(value))

    def clusters(self) -> list[NDArray[np.int64]]:
        """Numbers of modes that share a frequency, group by group, ascending; any mixture of a group is a mode too."""
        groups: list[list[int]] = []
        for i in range(len(self.eigenvalue)):
            if groups and self._shared(i):
                groups[-1].append(i)
            else:
                groups.append([i])
        return [np.array(group) for group in groups]


def rigid_motions(points: Array) -> Array:
    """Displacement of points (n, 3) under unit translations and turns about the origin, (6, n, 3) [-; m]."""
    found = np.zeros((6, *points.shape))
    for k, axis in enumerate(np.eye(3)):
        found[k] = axis
        found[3 + k] = np.cross(axis, points)
    return found
