"""A file in which a long motion on flexible tires keeps how far it came, so that a killed run goes on.

Arrays with a checksum, replaced by one rename: whole or absent. It begins with a digest of the motion it belongs to; a
damaged file, or that of another motion, counts as absent. A motion writes every `EVERY` seconds of
simulated time, at the next sample, and makes its Newton matrix anew there whether it keeps a file or not: a resumed run
then computes the same numbers bit for bit.

Verified by tests/verification/test_flexible_resume.py.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.kept_arrays import read_kept, write_kept
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle

__all__ = ["EVERY", "MotionCheckpoint", "motion_key"]

type Arrays = Mapping[str, NDArray[Any]]
EVERY = 1.0
"""Simulated time between two states that are kept [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionCheckpoint:
    """One file for one motion.

    Attributes
    ----------
    path : the file
    key : digest of everything the motion depends on, see `motion_key`
    """

    path: Path
    key: str

    def read(self) -> Arrays | None:
        """What was kept last, or None without a file that fits."""
        arrays = read_kept(self.path)
        return arrays if arrays is not None and str(arrays.get("key")) == self.key else None

    def write(self, arrays: Arrays) -> None:
        """Keep these; the last file stays whole until this one is."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        write_kept(self.path, {"key": np.array(self.key), **arrays})

    def discard(self) -> None:
        """Remove the file: the motion has ended."""
        self.path.unlink(missing_ok=True)


def motion_key(vehicle: FlexibleVehicle, times: NDArray[np.float64], steps: EvenSteps, settles_until: float) -> str:
    """SHA-256 of what a motion begins with and of the laws that drive it; not of efforts, which are functions.

    ``times`` (n,) and ``settles_until`` are in [s].
    """
    model, tires = vehicle.vehicle.model, vehicle.tires
    body = vehicle.vehicle
    driven = (model.drives, body.motors, body.control)
    inputs = (model.gravity, model.bodies, model.joints, driven, body.wheels, steps, settles_until)
    digest = hashlib.sha256(repr(inputs).encode())
    ground = [np.asarray(part) for part in vehicle.vehicle.terrain.pieces()]
    start = tires.reference()[None].repeat(tires.n_wheels, axis=0)
    place = np.zeros_like(start)
    place[:, tires.position_rows, 2] = vehicle.vehicle.settings.wheel_radius - 0.01
    force = tires.force(1.01 * start + place, 0.1 * start)  # a stretched tire that moves: elasticity, damping, contact
    for array in (times, tires.reference(), tires.mass, vehicle.mounts, force, *ground):
        digest.update(repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
