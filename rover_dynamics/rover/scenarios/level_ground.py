"""The thesis' scenarios on level ground: equilibrium, drop, load sweep, straight path, traction (Figs 15 to 25).

Verified by tests/unit/test_rover_scenarios.py and tests/verification/test_rover_statics.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from rover_dynamics.multibody.motion_law import Hold, MotionLaw, SpeedTrapezoid
from rover_dynamics.rover.rover import Actuators
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.closed_forms import drive_force, single_wheel_drop
from rover_dynamics.rover.scenarios.offsets import loads_against_offset
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario, sampled
from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw
from rover_dynamics.tires.brush_tire import THESIS_BRUSH

__all__ = ["LEVEL_GROUND", "SPEED", "all_drives", "drive_forward", "straight_ahead", "sweep_of_gravity"]

FloatArray = NDArray[np.float64]
SPEED = 70.0 / 3600.0
"""70 m/h [m/s]."""
OBSERVED = "front_right"
SWEEP = tuple(np.linspace(160.0, 250.0, 10))
TORQUE, DROP_HEIGHT = 3.5, 0.010
"""[N m], [m]."""
ROLLS = 0.005
"""Slip below which what the closed form leaves out of the mean tractive force is less than 4e-4 of it [-]."""


def all_drives(design: RoverDesign, law: MotionLaw) -> Actuators:
    """Every wheel driven by the same law."""
    return Actuators(laws={f"drive_{leg.name}": law for leg in design.legs})


def drive_forward(design: RoverDesign, ends: float = float("inf"), ramp: float = 5.0) -> Actuators:
    """70 m/h at the nominal radius, reached in ``ramp`` [s] from time zero; standing again at ``ends`` [s]."""
    law = SpeedTrapezoid(speed=SPEED / design.wheel_radius, accelerates=ramp, decelerates=ramp, ends=ends)
    return all_drives(design, law)


def straight_ahead(way: float) -> Callable[[RoverDesign], FloatArray]:
    """Of a design, the places of its wheels at the start and ``way`` [m] ahead, (n, 2) [m]."""

    def places(design: RoverDesign) -> FloatArray:
        start = np.array([leg.drive[:2] for leg in design.legs])
        return np.concatenate([start, start + np.array([way, 0.0])])

    return places


def _mean_load(run: ScenarioRun) -> Outcome:
    reference = run.design.static_load
    value = float(run.loads[-1].mean())
    return Outcome(quantity="mean wheel load at the end", value=value, unit="N", reference=reference)


def _static(run: ScenarioRun) -> tuple[Outcome, ...]:
    each = [
        Outcome(quantity=f"wheel load, {leg.name.replace('_', ' ')}", value=float(load), unit="N")
        for leg, load in zip(run.design.legs, run.loads[-1], strict=True)
    ]
    return (_mean_load(run), *each, Outcome(quantity="deflection", value=float(run.deflections[-1].mean()), unit="m"))


def _drop(run: ScenarioRun) -> tuple[Outcome, ...]:
    """Peaks against those of a single wheel with its share of the mass, sampled at the same times."""
    scenario, design, times = run.scenario, run.design, run.motion.times
    law, alone = "", None
    if scenario.has_closed_forms:
        alone = float(single_wheel_drop(design, DROP_HEIGHT, times, scenario.tire, scenario.settings).max())
        builds_up = scenario.settings.damper_law is DamperLaw.BUILDS_UP
        law = f", damper {'builds up with the deflection' if builds_up else 'as printed'}"
    return (
        Outcome(quantity=f"largest wheel load{law}", value=float(run.loads.max()), unit="N", reference=alone),
        Outcome(
            quantity="time of the largest wheel load", value=float(times[run.loads.max(axis=1).argmax()]), unit="s"
        ),
        Outcome(quantity=f"largest deflection{law}", value=float(run.deflections.max()), unit="m"),
        _mean_load(run),
    )


def _sweep(run: ScenarioRun) -> tuple[Outcome, ...]:
    """Deflection at each load, against the tire's static line."""
    found = []
    for load, deflection in zip(run.loads.mean(axis=1), run.deflections.mean(axis=1), strict=True):
        expected = float(load) / run.scenario.tire.radial_stiffness if run.scenario.has_closed_forms else None
        text = f"deflection at {load:.1f} N"
        found.append(Outcome(quantity=text, value=float(deflection), unit="m", reference=expected))
    return tuple(found)


def sweep_of_gravity(scenario: Scenario, design: RoverDesign, loads: Sequence[float] = SWEEP) -> ScenarioRun:
    """Gravity scaled to each mean wheel load [N]; one sample for each, at the end of its settling."""
    single = replace(scenario, composed=None)
    runs: list[ScenarioRun] = []
    stopped = None
    for load in loads:
        try:
            run = run_scenario(single, replace(design, gravity=design.gravity * load / design.static_load))
        except ConvergenceError as error:
            stopped = f"{load:g} N: {error}"
        else:
            stopped = run.stopped
        if stopped is not None:
            break
        runs.append(run)
    if not runs:
        raise ConvergenceError(f"the rover settles at no load of the sweep, {stopped}", [])
    ends = [sampled(run.motion) for run in runs]
    kept: dict[str, Any] = {name: np.concatenate([end[name][-1:] for end in ends]) for name in ends[0]}
    kept["times"] = (single.settles + single.lasts) * np.arange(1.0, len(runs) + 1.0)
    return ScenarioRun(scenario=scenario, design=design, motion=replace(runs[-1].motion, **kept), stopped=stopped)


def _straight(run: ScenarioRun) -> tuple[Outcome, ...]:
    times, speed = run.motion.times, run.motion.velocities[:, 0, 0]
    window = (times >= 15.0) & (times <= 35.0)
    loads = run.loads[window]
    wheel = _observed(run)
    return (
        Outcome(
            quantity="mean speed between 15 and 35 s", value=float(speed[window].mean()), unit="m/s", reference=SPEED
        ),
        Outcome(quantity="distance", value=float(run.place[-1, 0] - run.place[0, 0]), unit="m", reference=35.0 * SPEED),
        Outcome(quantity="sideways drift", value=float(np.abs(run.place[:, 1] - run.place[0, 1]).max()), unit="m"),
        Outcome(quantity="smallest wheel load between 15 and 35 s", value=float(loads.min()), unit="N"),
        Outcome(quantity="largest wheel load between 15 and 35 s", value=float(loads.max()), unit="N"),
        Outcome(
            quantity=f"deflection between 15 and 35 s, {run.design.legs[wheel].name.replace('_', ' ')}",
            value=float(run.deflections[window, wheel].mean()),
            unit="m",
        ),
    )


def _torques(design: RoverDesign) -> Actuators:
    """The thesis' torque on every drive from time zero; the wheels are free before."""
    return Actuators(torques={f"drive_{leg.name}": lambda t: TORQUE if t > 0.0 else 0.0 for leg in design.legs})


def _observed(run: ScenarioRun) -> int:
    """Row of the wheel the thesis observes, or the first one."""
    names = [leg.name for leg in run.design.legs]
    return names.index(OBSERVED) if OBSERVED in names else 0


def _traction(run: ScenarioRun) -> tuple[Outcome, ...]:
    """Forces of the last 5 s: the observed wheel's against its own balance, the mean of all against a closed form."""
    wheel, last = _observed(run), run.motion.times >= run.motion.times[-1] - 5.0
    name = run.design.legs[wheel].name.replace("_", " ")
    forces, known = run.tractive[last], run.scenario.has_closed_forms
    return (
        Outcome(
            quantity=f"tractive force of the last 5 s, {name}",
            value=float(forces[:, wheel].mean()),
            unit="N",
            reference=_driven_wheel(run, wheel, last) if known else None,
        ),
        Outcome(
            quantity="mean tractive force of all wheels in the last 5 s",
            value=float(forces.mean()),
            unit="N",
            reference=_mean_force(run, last) if known else None,
        ),
        Outcome(
            quantity=f"tractive force by load, {name}",
            value=float((forces[:, wheel] / run.loads[last, wheel]).mean()),
            unit="-",
        ),
        Outcome(quantity="speed at the end", value=float(run.motion.velocities[-1, 0, 0]), unit="m/s"),
    )


def _mean_force(run: ScenarioRun, last: NDArray[np.bool_]) -> float:
    """Of a wheel [N]: the closed form as far as it holds, else what speeds the rover up, M a / n.

    It holds for wheels that roll, on tires no softer and with no more rolling resistance than Table II's: with softer
    ones the rover has not come to rest by then, and resistance follows the square of loads that differ.
    """
    design, tire = run.design, run.scenario.tire
    like_the_thesis = (
        tire.radial_stiffness >= THESIS_BRUSH.radial_stiffness
        and tire.rolling_resistance <= THESIS_BRUSH.rolling_resistance
    )
    if like_the_thesis and np.abs(run.slips[last, :, 0]).max() < ROLLS:
        return drive_force(design, tire, TORQUE)
    speed, times = run.motion.velocities[last, 0, 0], run.motion.times[last]
    return float(design.mass * (speed[-1] - speed[0]) / (times[-1] - times[0]) / len(design.legs))


def _driven_wheel(run: ScenarioRun, wheel: int, last: NDArray[np.bool_]) -> float:
    """(T - f N r - I alpha) / l of one wheel, from load, loaded radius, spin and the lever l, times ``last`` [N]."""
    design, tire = run.design, run.scenario.tire
    inertia = next(body for body in design.leg_bodies if body.name == "wheel").inertia[1]
    spin, times = run.spins[last, wheel], run.motion.times[last]
    deflection = run.deflections[last, wheel]
    arm = run.loads[last, wheel] * (design.wheel_radius - deflection)
    slowed = inertia * (spin[-1] - spin[0]) / (times[-1] - times[0])
    lever = tire.lever_at(design.wheel_radius, float(deflection.mean()))
    return float((TORQUE - tire.rolling_resistance * arm.mean() - slowed) / lever)


STATIC = Scenario(
    name="static",
    title="static equilibrium on level ground, wheels free",
    source="Fig. 15",
    lasts=2.0,
    judge=_static,
    study=loads_against_offset,
)
DROP = Scenario(
    name="drop",
    title="drop of 10 mm, drives held, damper that builds up with the deflection",
    source="Figs 18, 19",
    settles=0.0,
    lasts=6.0,
    every=0.02,
    closer=(0.04, 0.16, 1e-4),
    height=DROP_HEIGHT,
    actuators=lambda design: all_drives(design, Hold()),
    judge=_drop,
)
DROP_PRINTED = replace(
    DROP,
    name="drop_printed",
    title="drop of 10 mm, drives held, damper as printed: its whole force at first touch",
    settings=BrushSettings(damper_law=DamperLaw.AS_PRINTED),
)
LOAD_SWEEP = Scenario(
    name="load_sweep",
    title="mean wheel load from 160 to 250 N by scaled gravity, one sample at the end of each settling",
    source="Fig. 20",
    lasts=1.0,
    judge=_sweep,
    composed=sweep_of_gravity,
)
STRAIGHT = Scenario(
    name="straight",
    title="straight path at 70 m/h, 5 s to accelerate, the last 5 s to stop",
    source="Figs 23, 24",
    lasts=40.0,
    every=0.1,
    actuators=lambda design: drive_forward(design, ends=40.0),
    path=straight_ahead(35.0 * SPEED),
    judge=_straight,
)
TRACTION = Scenario(
    name="traction",
    title="3.5 N m on each drive for 10 s after 5 s of settling, friction 0.6",
    source="Fig. 25",
    lasts=10.0,
    actuators=_torques,
    path=straight_ahead(20.0),
    friction=0.6,
    judge=_traction,
)
LEVEL_GROUND = (STATIC, DROP, DROP_PRINTED, LOAD_SWEEP, STRAIGHT, TRACTION)
