"""State of a wheel in motion, what moves with its hub, and its equations about a state.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

from ancf_reduced.wheel.static import System
from ancf_reduced.wheel_motion.bordered import BorderedMatrix
from ancf_reduced.wheel_motion.friction import Rubbing
from contracts.errors import InputError

__all__ = ["Hub", "Linearised", "Motion"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Hub:
    """What moves with the hub, of the whole wheel, and its drive.

    Attributes
    ----------
    mass : on the axle [kg]
    inertia : about the axle [kg m^2]
    speed, gain : drive that turns it with gain (speed - theta') [rad/s, N m s]; no gain: it turns freely
    """

    mass: float
    inertia: float
    speed: float = 0.0
    gain: float = 0.0

    def __post_init__(self) -> None:
        for what, value, unit in (("hub mass", self.mass, "kg"), ("hub inertia", self.inertia, "kg m^2")):
            if not (np.isfinite(value) and value > 0.0):
                raise InputError(what, f"{value:g} {unit}", "must be finite and > 0", "check the unit")
        if not (np.isfinite(self.gain) and self.gain >= 0.0):
            raise InputError("drive gain", f"{self.gain:g} N m s", "must be finite and >= 0", "0 turns freely")
        if not np.isfinite(self.speed):
            raise InputError("drive speed", f"{self.speed:g} rad/s", "must be finite", "e.g. 0.14 rad/s")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """Coordinates y, their rates v and accelerations a (n_free + 3,) at a time [s]; forces of all contacts [N]."""

    time: float
    y: Array
    v: Array
    a: Array
    pressed: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Linearised:
    """Residual (n_free + 3,), its derivatives by coordinates, rates and accelerations; contacts for `settle`.

    Attributes
    ----------
    residual : inertia and inner forces less weight and drive, without forces of contacts
    by_place, by_rate, by_acceleration : its derivatives
    slopes : (m, n_free + 3) of the gaps
    push : what a unit of force does at each contact: the slopes, and friction of the ground
    rubbing, rubs : friction of the ground where it is near, and which of the contacts near that are
    damping : (n_free, n_free) by rates of strain, part of ``by_rate``
    system : the wheel without inertia
    """

    residual: Array
    by_place: BorderedMatrix
    by_rate: BorderedMatrix
    by_acceleration: BorderedMatrix
    slopes: csr_array
    push: csr_array
    rubbing: Rubbing | None
    rubs: NDArray[np.int64]
    damping: csc_array
    system: System
