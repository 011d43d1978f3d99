"""A motion on flexible tires that was ended in the middle goes on from its checkpoint and ends with the same numbers.

Claim: what a resumed run returns is that of an uninterrupted one bit for bit, with or without a file to keep.
Source: the state at a checkpoint holds all a step begins with, and the Newton matrix is made anew there in every run.
Tolerance: none.
Negative controls: a number changed in the file shows in the result; a damaged file, or one of another motion, does not.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rover_dynamics.flexible.implicit_motion as module
from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.kept_arrays import read_kept, write_kept
from contracts.terrain import Plane
from rover_dynamics.flexible.flexible_system import Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle, on_flexible_tires
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.vehicle.vehicle import Vehicle

TIMES = np.linspace(0.0, 0.06, 13)
KILLED_AT = 0.043


class KilledError(Exception):
    """Ends a run in the middle of a step's end."""


@pytest.fixture(scope="module")
def wheel() -> FlexibleVehicle:
    """One wheel that falls onto the ground and rolls."""
    law = ContactLaw(stiffness=1000.0, damping=5.0, friction=0.6, slip_velocity=0.05)
    tires = wheel_set(build_tire(thesis_preset()), Plane(), 1, law=law)
    hub = body("wheel", 16.0, 0.2 * np.eye(3), (0.0, 0.0, 0.143), velocity=(0.2, 0.0, -0.2))
    model = MultibodyModel(bodies=(hub,), gravity=(0.0, 0.0, -3.711))
    return on_flexible_tires(Vehicle(model=model, wheels=("wheel",), terrain=Plane()), tires)


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    """A checkpoint every 10 ms of the motion."""
    monkeypatch.setattr(module, "EVERY", 0.01)


def _kill(t: float, _: Instant) -> None:
    if t > KILLED_AT:
        raise KilledError


def _killed(wheel: FlexibleVehicle, path: Path) -> Path:
    with pytest.raises(KilledError):
        drive_on_flexible_tires(wheel, TIMES, checkpoint=path, watch=_kill)
    assert path.is_file()
    return path


def _same(a: FlexibleMotion, b: FlexibleMotion) -> bool:
    arrays = ("times", "positions", "rotations", "velocities", "tires", "wrenches", "vectors", "rates")
    counts = all(getattr(a, n) == getattr(b, n) for n in ("steps", "iterations", "rejected", "linearisations"))
    return counts and all(getattr(a, name).tobytes() == getattr(b, name).tobytes() for name in arrays)


def test_a_resumed_motion_is_the_uninterrupted_one(wheel: FlexibleVehicle, tmp_path: Path) -> None:
    path, seen = _killed(wheel, tmp_path / "c.npz"), list[float]()
    resumed = drive_on_flexible_tires(wheel, TIMES, checkpoint=path, watch=lambda t, _: seen.append(t))
    assert seen[0] > 0.03  # it went on, it did not begin anew
    assert not path.exists()
    assert _same(resumed, drive_on_flexible_tires(wheel, TIMES))


def test_what_is_in_the_file_is_taken_up(wheel: FlexibleVehicle, tmp_path: Path) -> None:
    """Negative control."""
    path = _killed(wheel, tmp_path / "c.npz")
    arrays = read_kept(path)
    assert arrays is not None
    write_kept(path, arrays | {"joints0": arrays["joints0"] + 1e-6})
    assert not _same(drive_on_flexible_tires(wheel, TIMES, checkpoint=path), drive_on_flexible_tires(wheel, TIMES))


def test_a_damaged_file_or_that_of_another_motion_counts_as_absent(wheel: FlexibleVehicle, tmp_path: Path) -> None:
    path, seen = _killed(wheel, tmp_path / "c.npz"), list[float]()
    drive_on_flexible_tires(wheel, TIMES[:2] + 1e-3, checkpoint=path, watch=lambda t, _: seen.append(t))
    assert seen[0] < 0.005
    path.write_bytes(_killed(wheel, tmp_path / "d.npz").read_bytes()[:5000])
    seen.clear()
    drive_on_flexible_tires(wheel, TIMES[:2], checkpoint=path, watch=lambda t, _: seen.append(t))
    assert seen[0] < 0.005
