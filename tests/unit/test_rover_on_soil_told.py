"""What a drive on soil tells of its slip.

Claim: it is that of the last 5 s at speed, along the ground. Negative controls: a rover that brakes and slides
meanwhile tells the slip before; a way that rises is longer than its plan.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rover_dynamics.rover.scenarios import on_soil


@pytest.mark.parametrize("rise", [0.0, 0.5])
def test_slip_is_that_at_speed_along_the_ground(monkeypatch: pytest.MonkeyPatch, rise: float) -> None:
    monkeypatch.setattr(on_soil, "energy_of_drives", lambda run: 1.0)
    times = np.arange(0.0, 50.01, 0.1)
    spin = np.clip((50.0 - times) / 5.0, 0.0, 1.0)
    pace = np.where(times <= 45.0, 0.8 * 0.1, 0.1)  # a slip of 0.2 at speed, none on average while it brakes
    way = np.concatenate([[0.0], np.cumsum(0.1 * pace[1:])])
    place = np.stack([way, 0.0 * way, rise * way], axis=-1) / np.hypot(1.0, rise)
    run: Any = SimpleNamespace(
        motion=SimpleNamespace(times=times, ruts=None, rotations=np.tile(np.eye(3), (len(times), 1, 1, 1))),
        design=SimpleNamespace(legs=range(6), wheel_radius=0.1),
        scenario=SimpleNamespace(name="straight"),
        sinkages=np.zeros((len(times), 6)),
        spins=np.tile(spin[:, None], (1, 6)),
        place=place,
        torques=lambda kind: np.zeros((len(times), 6)),
    )
    told = {one.quantity: one.value for one in on_soil._told(run)}
    assert told["slip of the rover, mean of its last 5 s at speed"] == pytest.approx(0.2, abs=0.01)
    assert told["energy of the drives a metre"] == pytest.approx(1.0 / way[-1], rel=1e-6)
