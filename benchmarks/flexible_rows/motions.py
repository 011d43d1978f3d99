"""Rows of whole motions: time, what the integrator did, and errors against a run with a tenth of the error allowed."""

from __future__ import annotations

import numpy as np

from benchmarks.flexible_rows.cases import driven, row
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle
from workbench.questions.speed.aims import FASTER, TIME

__all__ = ["TOLERANCE", "motion_rows"]

TOLERANCE = 1e-5
"""Default of `EvenSteps` [m, rad]."""


def motion_rows(case: str, vehicle: FlexibleVehicle, end: float) -> list[dict[str, object]]:
    """One motion of six tires, ten outputs a second."""
    driven(vehicle, 0.1, TOLERANCE)
    ours, fine = driven(vehicle, end, TOLERANCE), driven(vehicle, end, 0.1 * TOLERANCE)
    motion, exact = ours.motion, fine.motion
    apart = np.abs(motion.tires[1:] - exact.tires[1:])
    speed = np.abs(motion.velocities[1:, 0, 0] - exact.velocities[1:, 0, 0])
    ratios = vehicle.tires.system.model.volume_ratio  # type: ignore[attr-defined]
    least = min(float(ratios(vehicle.tires.node_coordinates(z)).min()) for z in motion.vectors[1:])  # type: ignore[attr-defined]
    return [
        row(case, TIME, "s", ours.seconds),
        row(case, FASTER, "-", end / ours.seconds),
        row(case, "steps, settling included", "-", motion.steps),
        row(case, "steps refused", "-", motion.rejected),
        row(case, "Newton iterations", "-", motion.iterations),
        row(case, "linearisations", "-", motion.linearisations),
        row(case, "largest speed", "m/s", float(motion.velocities[:, 0, 0].max())),
        row(case, "least det F at an integration point", "-", least),
        row(case, "error of the deflections, rms", "mm", 1e3 * float(np.sqrt(np.mean(apart[:, :, 0] ** 2)))),
        row(case, "error of the deflections, largest", "mm", 1e3 * float(apart[:, :, 0].max())),
        row(case, "error of the loads, rms", "N", float(np.sqrt(np.mean(apart[:, :, 1] ** 2)))),
        row(case, "error of the loads, largest", "N", float(apart[:, :, 1].max())),
        row(case, "error of the speed, rms", "mm/s", 1e3 * float(np.sqrt(np.mean(speed**2)))),
        row(case, "error of the speed, largest", "mm/s", 1e3 * float(speed.max())),
        row(case, "time with a tenth of the error allowed", "s", fine.seconds),
    ]
