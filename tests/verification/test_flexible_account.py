"""Energy and momentum of a vehicle on flexible tires are accounted for.

Claim: on a cart that lands on two ANCF tires, damped, with friction and drives, stored and spent energy less the work
of the drives stays constant to 1 %, and the change of momentum is the impulse of weight and ground to 1 %.
Source: laws of conservation; every term is evaluated from the state, none from another.
Tolerance: 1 % as issue 6 asks; 7e-5 and 2e-6 are found.
Negative controls: an account without friction, or without the drives, does not close.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rover_dynamics.flexible.account import COLUMNS, FlexibleAccount
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import FlexibleSystem
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from tests.verification.flexible_cart import LAW, cart

CLOSED = 0.01


@pytest.fixture(scope="module")
def account() -> FlexibleAccount:
    """Landing at 0.12 m/s, accelerating to 0.5 m/s, slipping."""
    vehicle = cart(height=0.002, ratio=0.05, law=replace(LAW, slip_velocity=0.02))
    found = FlexibleAccount(FlexibleSystem(vehicle))
    steps = EvenSteps(tolerance=1e-6, first=1e-4, longest=2e-3, spectral_radius=0.9)
    drive_on_flexible_tires(vehicle, np.array([0.0, 0.4]), steps, watch=found.watch)
    return found


def test_the_energy_account_closes(account: FlexibleAccount) -> None:
    print(f"\n{account.energy_closure():.2e}", dict(zip(COLUMNS, np.ptp(account.table(), axis=0), strict=True)))
    assert account.energy_closure() < CLOSED


def test_the_momentum_account_closes(account: FlexibleAccount) -> None:
    print(f"\n{account.momentum_closure():.2e}")
    assert account.momentum_closure() < CLOSED


@pytest.mark.parametrize("column", ["friction", "drives", "strain"])
def test_an_account_without_one_column_does_not_close(account: FlexibleAccount, column: str) -> None:
    """Negative control."""
    table = account.table().copy()
    table[:, COLUMNS.index(column)] = 0.0
    damaged = FlexibleAccount(account.system, times=account.times, energies=list(table))
    assert damaged.energy_closure() > CLOSED
