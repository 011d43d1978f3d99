"""A scenario as a record: the vehicle it makes of a rover, its times, and what is read from its motion.

Every scenario starts at rest on the ground: the wheels are pressed in by the mean static deflection, so that nothing
falls, and the rover settles with the drives held before time zero. A slope is a tilt of gravity; the ground stays
level.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, InputError
from contracts.terrain import Plane, Terrain
from rover_dynamics.rover.rover import Actuators, build_rover
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.ends import (
    hubs_over,
    on_its_soil,
    refuse_beside_terrain,
    wheel_bodies,
    within_curves,
)
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.set_down import set_down
from rover_dynamics.soil.field import SoilBed
from rover_dynamics.tires.brush_settings import BrushSettings
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters, with_friction
from rover_dynamics.vehicle.motors import Motor, electrical_power
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion, drive_vehicle

__all__ = [
    "LATERAL",
    "Judge",
    "Ride",
    "Scenario",
    "ScenarioRun",
    "Tilt",
    "run_scenario",
    "sampled",
]

FloatArray = NDArray[np.float64]
_PENETRATION, _LOAD, _SLIP, _TRACTIVE, LATERAL = 0, 1, 2, 7, 8
"""Columns of `rover_dynamics.tires.brush_force.OUTPUT_SIZE`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tilt:
    """A slope: gravity turned by ``angle`` [rad] so that it pulls towards ``heading`` [rad], from +x about +z."""

    angle: float = 0.0
    heading: float = 0.0

    def gravity(self, size: float) -> tuple[float, float, float]:
        """Acceleration in the ground's frame, z its normal [m/s^2]."""
        pull = size * math.sin(self.angle)
        return pull * math.cos(self.heading), pull * math.sin(self.heading), -size * math.cos(self.angle)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScenarioRun:
    """A scenario's motion from time zero on.

    Attributes
    ----------
    scenario, design : what moved
    motion : settling left out, times from 0 s
    stopped : why it ended before its time, or None
    """

    scenario: Scenario
    design: RoverDesign
    motion: VehicleMotion
    stopped: str | None = None

    @property
    def loads(self) -> FloatArray:
        """Wheel loads (n, n_w) [N], in the order of the design's legs."""
        return self.motion.tires[:, :, _LOAD]

    @property
    def deflections(self) -> FloatArray:
        """Radial deflections (n, n_w) [m]."""
        return self.motion.tires[:, :, _PENETRATION]

    @property
    def tractive(self) -> FloatArray:
        """Tractive forces (n, n_w) [N], ground on wheel, forwards."""
        return self.motion.tires[:, :, _TRACTIVE]

    @property
    def place(self) -> FloatArray:
        """Centre of the first body (n, 3) [m]."""
        return self.motion.positions[:, 0]

    @property
    def wheel_bodies(self) -> slice:
        """Rows of the wheels among the bodies."""
        return wheel_bodies(self.design)

    @property
    def wheels(self) -> FloatArray:
        """Centres of the wheels (n, n_w, 3) [m]."""
        return self.motion.positions[:, self.wheel_bodies]

    @property
    def spins(self) -> FloatArray:
        """Angular velocities of the wheels about their axles (n, n_w) [rad/s], positive rolling forwards."""
        axles = self.motion.rotations[:, self.wheel_bodies, :, 1]
        return np.asarray(np.sum(axles * self.motion.velocities[:, self.wheel_bodies, 3:], axis=-1))

    @property
    def slips(self) -> FloatArray:
        """Longitudinal and lateral slips of the wheels (n, n_w, 2) [-]."""
        return self.motion.tires[:, :, _SLIP : _SLIP + 2]

    @property
    def sinkages(self) -> FloatArray:
        """Of the wheels' lowest points below the undisturbed ground (n, n_w) [m]; on soil."""
        hubs = hubs_over(self.wheels, self.scenario.terrain(self.design), self.design.wheel_radius)
        return self.design.wheel_radius - self.deflections - hubs

    @property
    def met(self) -> bool:
        """Whether the motion came to its end and misses no requirement."""
        return self.stopped is None and all(one.met is not False for one in self.scenario.judge(self))

    def torques(self, kind: str) -> FloatArray:
        """Of all actuators whose names begin so, such as ``drive`` (n, n_a) [N m], as they move or hold."""
        joints = self.scenario.vehicle(self.design).actuated
        return self.motion.efforts[:, [k for k, joint in enumerate(joints) if joint.startswith(f"{kind}_")]]

    @property
    def drive_speeds(self) -> FloatArray:
        """Speeds of the drives' joints (n, n_w) [rad/s]: of the wheels against their spindles, about the axles."""
        wheels = self.wheel_bodies
        spindles = slice(wheels.start - 1, None, wheels.step)
        axles = self.motion.rotations[:, wheels, :, 1]
        relative = self.motion.velocities[:, wheels, 3:] - self.motion.velocities[:, spindles, 3:]
        return np.asarray(np.sum(axles * relative, axis=-1))

    @property
    def drive_power(self) -> FloatArray:
        """What each drive takes (n, n_w) [W], nothing where it would give back.

        Of motors the electrical power, none where a brake holds; of drives without limits what they give to the wheels.
        """
        motor = Motor() if self.design.drive is None else self.design.drive.motor
        power = np.maximum(electrical_power(motor, self.torques("drive"), self.drive_speeds), 0.0)
        for column, one in zip(power.T, self.scenario.vehicle(self.design).motors, strict=False):
            column[[one.stands(t) for t in self.motion.times.tolist()]] = 0.0
        return power

    @property
    def lean(self) -> FloatArray:
        """Angle (n,) [rad] between the first body's upright axis and the ground's normal."""
        return np.arccos(np.clip(self.motion.rotations[:, 0, 2, 2], -1.0, 1.0))


Judge = Callable[[ScenarioRun], tuple[Outcome, ...]]
Study = Callable[["Scenario", RoverDesign], tuple[Outcome, ...]]
Ride = Callable[["Scenario", RoverDesign], VehicleMotion]


def _on_brush_tires(scenario: Scenario, design: RoverDesign) -> VehicleMotion:
    return drive_vehicle(scenario.vehicle(design), scenario.times())


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """One thing the rover does.

    Attributes
    ----------
    name, title : as on the command line, and in words
    source : figure or section of the thesis
    lasts : duration after settling [s]
    judge : reads the outcomes from the motion
    settles : time at rest before time zero [s]
    every : spacing of the samples [s]
    closer : begin, end and spacing [s] of more samples, or None
    height : lowest points of the wheels over the ground [m]; None for the mean static deflection below it
    actuators, terrain : of a rover's design
    tilt : of gravity
    tire, settings : of all wheels
    friction : Coulomb's coefficient of every tire, whatever its own is, or None for its own
    holds_fast : whether that friction is part of the question, so that no other ground replaces it
    tire_model : what series and files call them
    ride : its vehicle's motion at its times; other tires than the brush have one of their own
    has_closed_forms : whether the brush tire's formulas are references of what is judged
    path : places (n, 2) [m] the wheels are to reach, or None for a scenario that has a ground of its own
    soil : of a rover's design, lying as the terrain does, with wheels of its own; or None
    until : of a rover's design, what ends its motion before its time, see `Vehicle`; or None
    study : more outcomes by more runs, a few seconds, or None
    search : how far the requirement could be raised, by bisection (up to a minute), or None
    composed : makes the run out of several, or None
    """

    name: str
    title: str
    source: str
    lasts: float
    judge: Judge
    settles: float = 5.0
    every: float = 0.05
    closer: tuple[float, float, float] | None = None
    height: float | None = None
    actuators: Callable[[RoverDesign], Actuators] = field(default=lambda _: Actuators())
    terrain: Callable[[RoverDesign], Terrain] = field(default=lambda _: Plane())
    tilt: Tilt = field(default_factory=Tilt)
    tire: BrushTireParameters = THESIS_BRUSH
    settings: BrushSettings = field(default_factory=BrushSettings)
    friction: float | None = None
    holds_fast: bool = False
    tire_model: str = "brush"
    ride: Ride = _on_brush_tires
    has_closed_forms: bool = True
    path: Callable[[RoverDesign], FloatArray] | None = None
    soil: Callable[[RoverDesign], SoilBed] | None = None
    until: Callable[[RoverDesign], Callable[[float, FloatArray], bool]] | None = None
    study: Study | None = None
    search: Study | None = None
    composed: Callable[[Scenario, RoverDesign], ScenarioRun] | None = None

    def __post_init__(self) -> None:
        for what, value in (("duration", self.lasts), ("spacing of samples", self.every)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{what} of scenario {self.name}", f"{value:g} s", "must be finite and > 0", "lengthen it"
                )
        if not (math.isfinite(self.settles) and self.settles >= 0.0):
            rule = "must be finite and >= 0"
            raise InputError(f"settling of scenario {self.name}", f"{self.settles:g} s", rule, "give e.g. 5 s")

    @property
    def on_brush_tires(self) -> bool:
        """Whether it drives on ``tire``; ANCF tires have a ride of their own."""
        return self.ride is _on_brush_tires

    def vehicle(self, design: RoverDesign) -> Vehicle:
        """The rover at the scenario's start; raises InputError for a brush tire that sinks in beyond its hub."""
        height, soil = self.height, None if self.soil is None else self.soil(design)
        if soil is not None:
            height = soil.standing()[0] - design.wheel_radius
        if height is None:
            height = -design.static_load * math.cos(self.tilt.angle) / self.tire.radial_stiffness
            if -height >= design.wheel_radius:
                rule = f"at rest must be below the wheel's radius, {1e3 * design.wheel_radius:g} mm"
                hint = f"give more radial stiffness than {self.tire.radial_stiffness:g} N/m"
                raise InputError("deflection of the rover's brush tires", f"{-1e3 * height:.4g} mm", rule, hint)
        vehicle = build_rover(
            design,
            terrain=self.terrain(design),
            actuators=self.actuators(design),
            height=height,
            tire=with_friction(self.tire, self.friction),
            settings=self.settings,
        )
        model = replace(vehicle.model, gravity=self.tilt.gravity(design.gravity))
        if soil is not None and soil.terrain != Plane():
            model = set_down(model, design, soil)
        return replace(vehicle, model=model, soil=soil, until=None if self.until is None else self.until(design))

    def times(self) -> FloatArray:
        """Samples from the start of the settling to the end [s]."""
        after = np.linspace(0.0, self.lasts, max(2, round(self.lasts / self.every) + 1))
        if self.closer is not None:
            more = np.arange(*self.closer)
            after = np.concatenate([more, after[(after < more[0]) | (after > more[-1])]])
            after.sort()
        return after if self.settles == 0.0 else np.concatenate([[-self.settles], after])


def run_scenario(scenario: Scenario, design: RoverDesign) -> ScenarioRun:
    """Drive the scenario; a motion that stops early is kept and says why.

    Raises
    ------
    ConvergenceError
        If it stops before time zero, or its numbers overflow.
    InputError
        If a wheel leaves the terrain's height field.
    """
    if scenario.composed is not None:
        return scenario.composed(scenario, design)
    stopped = None
    try:
        motion = scenario.ride(scenario, design)
    except ConvergenceError as error:
        if not isinstance(error.last_good, VehicleMotion) or error.last_good.times[-1] < 0.0:
            raise
        motion, stopped = error.last_good, str(error)
    except np.linalg.LinAlgError as error:  # a fall whose numbers overflow within a step
        message = f"motion of scenario {scenario.name} cannot be followed: a step's numbers overflow, as in a fall"
        raise ConvergenceError(message, []) from error
    begin = int(np.searchsorted(motion.times, 0.0))
    if scenario.soil is None:
        refuse_beside_terrain(motion)
        end, deep = within_curves(motion, design, scenario.settings)
    else:
        end, deep = on_its_soil(motion, design, scenario.terrain(design))
    kept = {name: rows[begin:end] for name, rows in sampled(motion).items()}
    stopped = deep or stopped
    return ScenarioRun(scenario=scenario, design=design, motion=replace(motion, **kept), stopped=stopped)


def sampled(motion: VehicleMotion) -> dict[str, Any]:
    """Arrays of a motion, with one row for each time, by name."""
    values = {one.name: getattr(motion, one.name) for one in fields(motion)}
    return {name: value for name, value in values.items() if isinstance(value, np.ndarray)}
