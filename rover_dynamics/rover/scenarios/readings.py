"""Numbers every scenario with a requirement states: loads, lean, torques and slip.

Verified by tests/unit/test_rover_requirements.py.
"""

from __future__ import annotations

import math

import numpy as np

from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.scenario import ScenarioRun

__all__ = ["STARTED", "energy_of_drives", "largest_lean", "stated"]

STARTED = 5.0
"""Time at which the drives have reached their speed [s]; slip while a wheel stands says nothing."""


def stated(run: ScenarioRun) -> tuple[Outcome, ...]:
    """What it took: torques without a bound (the mission names none, nothing limits the drives here), slip, loads."""
    moving = run.motion.times >= min(STARTED, run.motion.times[-1])
    numbers = (
        ("largest torque of a drive", run.torques("drive"), "N m"),
        ("largest torque of a steering actuator", run.torques("steer"), "N m"),
        ("largest longitudinal slip of a wheel", run.slips[moving, :, 0], "-"),
        ("largest wheel load", run.loads, "N"),
    )
    found = [Outcome(quantity=words, value=float(np.abs(all_of).max()), unit=unit) for words, all_of, unit in numbers]
    return (
        *found,
        Outcome(quantity="smallest wheel load", value=float(run.loads.min()), unit="N"),
        Outcome(quantity="largest power of all drives", value=float(run.drive_power.sum(axis=1).max()), unit="W"),
        Outcome(quantity="energy of the drives", value=energy_of_drives(run), unit="J"),
    )


def energy_of_drives(run: ScenarioRun) -> float:
    """What the drives took from time zero to the end [J], by the trapezoidal rule over the samples."""
    return float(np.trapezoid(run.drive_power.sum(axis=1), run.motion.times))


def largest_lean(run: ScenarioRun, limit: float) -> Outcome:
    """Lean of the body against the ground's normal and the largest allowed [rad]."""
    value = math.degrees(float(run.lean.max()))
    return Outcome(
        quantity="largest lean of the body", value=value, unit="deg", limit=math.degrees(limit), at_least=False
    )
