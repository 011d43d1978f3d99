"""The thesis' way over a short stretch: independent or constrained coordinates, explicit steps with error control."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.flexible_rows.cases import LAW, STRAIGHT, at_rest, rover, row
from rover_dynamics.flexible.constrained_coordinates import ConstrainedCoordinates
from rover_dynamics.flexible.flexible_vehicle import FlexibleVehicle
from rover_dynamics.flexible.independent_coordinates import IndependentCoordinates
from rover_dynamics.multibody.explicit_steps import StepControl
from rover_dynamics.multibody.motion import integrate

__all__ = ["thesis_rows"]

FloatArray = NDArray[np.float64]
CONTROL = StepControl(relative=1e-5, absolute=1e-7)
WITH, WITHOUT = "", ", no damping or friction"
"""Plates' viscosity, contact damping and friction all shorten the stable step."""
STRETCH = {WITH: (2e-3, 4e-4), WITHOUT: (0.1, 0.02)}
"""Simulated time that is measured, for independent and for constrained coordinates [s]."""


class _Settled(IndependentCoordinates):
    def __init__(self, vehicle: FlexibleVehicle) -> None:
        super().__init__(vehicle)
        self.resting = at_rest(vehicle)

    def start(self) -> FloatArray:
        return self.packed(self.resting)


class _SettledNodes(ConstrainedCoordinates):
    def __init__(self, vehicle: FlexibleVehicle, of: _Settled) -> None:
        super().__init__(vehicle)
        self._y = self.with_tires(of.state(0.0, of.start()), *of.system.whole(of.resting))

    def start(self) -> FloatArray:
        return self._y


def thesis_rows(fast: float) -> list[dict[str, object]]:
    """Both forms, with and without all damping; ``fast`` is the time of the fast way for a second [s]."""
    rows = []
    smooth = replace(LAW, damping=0.0, friction=0.0)
    vehicles = {WITH: rover(STRAIGHT), WITHOUT: rover(STRAIGHT, damping_ratio=0.0, law=smooth)}
    for which, vehicle in vehicles.items():
        independent = _Settled(vehicle)
        forms = {"independent": independent, "constrained": _SettledNodes(vehicle, independent)}
        for (name, form), stretch in zip(forms.items(), STRETCH[which], strict=True):
            form.rates(0.0, form.start())
            begun = time.process_time()
            motion = integrate(form, np.array([0.0, stretch]), CONTROL)  # type: ignore[arg-type]
            spent = (time.process_time() - begun) / stretch
            case = f"thesis' way, {name} coordinates{which}"
            rows += [
                row(case, "simulated", "ms", 1e3 * stretch),
                row(case, "mean step", "us", 1e6 * stretch / motion.steps),
                row(case, "one evaluation", "us", 1e6 * spent * stretch / motion.evaluations),
                row(case, "processor time of a second, extrapolated", "s", spent),
                row(case, "over the fast way, extrapolated", "-", spent / fast),
            ]
    return rows
