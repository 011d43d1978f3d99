"""Task: one ANCF wheel dropped and driven over a half-round, with its energy account.

Verified by tests/unit/test_workbench_ancf_dynamics.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.motion.energy_account import EnergyAccount
from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.implicit import ImplicitSettings, integrate_implicit
from ancf_reduced.motion.plate_system import HubMass
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.tire.wheel_rig import WheelRig, wheel_rig
from contracts.errors import ConvergenceError
from contracts.series import TimeSeries, write_series
from contracts.terrain import Plane, TerrainUnion
from contracts.terrain_ridges import HalfRound
from workbench.execution.result_files import write_result
from workbench.questions.ancf_dynamics.records import MotionNumbers
from workbench.study.ancf_tire import tire_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["move_wheel"]

STEP_FRACTION = 0.35
"""Of the longest stable step: the ride starts with a blow, and its fast modes are to be followed as well."""


def move_wheel(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """One motion by the explicit integrator, and by the implicit one if asked: ``series.csv``, ``result.json``."""
    rig = _rig(inputs)
    start = rig.start(np.array(inputs["hub"]), np.array([inputs["speed"], 0.0, 0.0]), inputs["spin"])
    times = np.linspace(0.0, inputs["end"], inputs["points"] + 1)[1:]
    length, account = STEP_FRACTION * stable_step(rig.system, start.z), EnergyAccount(rig.system)
    account.watch(start)
    states, message = [start], None
    try:
        for state in integrate_explicit(rig.system, start, times, length, account.watch):
            states.append(state)
            progress(state.time / inputs["end"])
    except ConvergenceError as error:
        message = str(error)
    write_series(_series(inputs, rig, states, partial=message is not None), out / "series.csv")
    heights = np.array([rig.hub(s.z)[2] for s in states])
    difference, steps = _by_implicit(rig, start, times, heights[1:]) if inputs["implicit"] else (None, None)
    numbers = MotionNumbers(
        closure=account.closure() if message is None else None,
        energies=next(row for row in reversed(account.rows) if row.time <= states[-1].time),
        lowest_m=float(heights.min()),
        largest_load_N=max(float(rig.load(s)[2]) for s in states),
        step_s=length,
        stopped=message,
        end_s=float(states[-1].time),
        viscosity=float(rig.tire.model.viscosity[1]),
        implicit_difference_m=difference,
        implicit_steps=steps,
    )
    write_result(out, asdict(numbers))
    return 3 * rig.system.coordinates.n_vectors


def _rig(inputs: Mapping[str, Any]) -> WheelRig:
    """Wheel and ground of a task."""
    tire = tire_from(inputs)
    rock = [HalfRound(radius=r, position=x) for r, x in inputs["rocks"]]
    spin = inputs["spin"]
    return wheel_rig(
        tire,
        TerrainUnion(parts=(Plane(), *rock)) if rock else Plane(),
        hub=HubMass(mass=inputs["hub_mass"], inertia=inputs["hub_inertia"] * np.eye(3)),
        law=ContactLaw(stiffness=tire.preset.contact_stiffness, **inputs["law"]),
        damping_ratio=inputs["damping_ratio"],
        drive=(spin, inputs["drive_gain"]) if spin else None,
    )


def _by_implicit(
    rig: WheelRig, start: MotionState, times: NDArray[np.float64], explicit: NDArray[np.float64]
) -> tuple[float, int]:
    """Largest difference of the hub's height between both integrators [m], and steps of the implicit one."""
    steps: list[float] = []
    states = integrate_implicit(
        rig.system, start, times, ImplicitSettings(tolerance=2e-7), lambda state: steps.append(state.time)
    )
    heights = np.array([rig.hub(state.z)[2] for state in states])
    return float(np.abs(heights - explicit).max()), len(steps)


def _series(inputs: Mapping[str, Any], rig: WheelRig, states: Sequence[MotionState], *, partial: bool) -> TimeSeries:
    """Hub and load against time."""
    hub, load = (np.array([of(state) for state in states]) for of in (lambda s: rig.hub(s.z), rig.load))
    spacing = 1e3 * inputs["end"] / inputs["points"]
    return TimeSeries(
        scenario="motion",
        tire="ancf",
        time=np.array([state.time for state in states]),
        columns={"hub_x_m": hub[:, 0], "hub_z_m": hub[:, 2], "load_x_N": load[:, 0], "load_z_N": load[:, 2]},
        source=f"ANCF tire with {inputs['hub_mass']:g} kg on its hub, Mars gravity; x forward, z up from the ground, "
        f"load of the ground on the wheel; explicit integration, a sample every {spacing:g} ms",
        partial=partial,
    )
