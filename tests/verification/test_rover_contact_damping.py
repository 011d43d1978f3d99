"""The contact damping of every tire but the thesis' does not drag, and lets the rover come to rest.

Claim: under 3.5 N m on each drive Hunt and Crossley's damping takes less than 5 % of what the drives put in; the
thesis' c = 100 N s/m, read from eq. 2.22 as of each point, more than 40 % of it. The loss of the plates alone, 5 % of
their first mode, halves the rover's bouncing within 3 s.
Source: energy account of `rover_dynamics.flexible.account`, which closes (tests/verification/test_flexible_account.py).
Tolerance: 5 % is our bound for damping that does not decide a result.
Negative controls: the thesis' law on the same tire fails the bound by far; without any damping the rover bounces on.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import ContactDamping, thesis_preset
from rover_dynamics.flexible.account import COLUMNS, FlexibleAccount
from rover_dynamics.flexible.flexible_system import FlexibleSystem
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.scenario import run_scenario
from workbench.questions.rover.tire_shapes import Watch
from workbench.questions.rover.tires import AncfRide, on_ancf_tires, watching

DESIGN = read_rover()
BOUND = 0.05


def share_taken(damping: ContactDamping) -> float:
    """Of the drives' work over half a second under 3.5 N m."""
    accounts: list[FlexibleAccount] = []

    def account(system: FlexibleSystem) -> Watch:
        accounts.append(FlexibleAccount(system))
        return accounts[-1].watch

    tire = build_tire(replace(thesis_preset(), contact_damping=damping))
    short = on_ancf_tires(replace(SCENARIOS["traction"], lasts=1.0, settles=2.0, every=0.1), tire)
    run = run_scenario(watching(short, account), DESIGN)
    assert run.stopped is None
    assert accounts[0].energy_closure() < 5e-3
    table = accounts[0].table()
    rest = table[np.searchsorted(accounts[0].times, 0.5) :]
    spent = dict(zip(COLUMNS, (rest[-1] - rest[0]).tolist(), strict=True))
    return spent["contact_damping"] / spent["drives"]


def test_the_default_takes_little_of_the_drives_power() -> None:
    assert 0.0 < share_taken("hunt_crossley") < BOUND
    assert share_taken("as_printed") > 8.0 * BOUND


def bouncing_left(damping: ContactDamping) -> float:
    """Rms of the body's vertical speed from 3 to 4 s after a twentieth of the weight is laid on, over the first's."""
    tire = build_tire(replace(thesis_preset(), contact_damping=damping))
    still = replace(SCENARIOS["straight"], settles=0.0, lasts=4.0, every=0.02, actuators=SCENARIOS["drop"].actuators)
    scenario = on_ancf_tires(still, tire)
    ride = scenario.ride
    assert isinstance(ride, AncfRide)
    start = ride.standing(scenario, replace(DESIGN, gravity=0.95 * DESIGN.gravity), 0.0)
    motion = ride.moved(scenario, DESIGN, start)
    speed = motion.velocities[:, 0, 2]
    early, late = (np.sqrt(np.mean(speed[part] ** 2)) for part in (motion.times <= 1.0, motion.times >= 3.0))
    return float(late / early)


def test_the_plates_own_loss_brings_the_rover_to_rest() -> None:
    """Less than half of the bouncing is left 3 s later without any contact damping, and less still with the default."""
    alone, default = bouncing_left("none"), bouncing_left("hunt_crossley")
    assert default < alone < 0.5


def test_negative_control_without_any_damping_the_rover_goes_on_bouncing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("workbench.questions.rover.tires.DAMPING_RATIO", 0.0)
    assert bouncing_left("none") > 0.8
