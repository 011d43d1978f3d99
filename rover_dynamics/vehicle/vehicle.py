"""A vehicle: a tree of bodies in joints, some of them wheels with brush tires, on a terrain.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from contracts.terrain import Terrain
from rover_dynamics.multibody.generalised_alpha import generalised_alpha
from rover_dynamics.multibody.implicit_steps import ImplicitSteps
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.tree_kernels import tree_motion
from rover_dynamics.soil.cells import keep_step
from rover_dynamics.soil.field import Ruts, SoilBed, ruts_of
from rover_dynamics.tires.brush_derivatives import derivative_result
from rover_dynamics.tires.brush_force import BrushResult, brush_scratch, empty_result
from rover_dynamics.tires.brush_settings import BrushSettings, wheel_numbers
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters
from rover_dynamics.vehicle.drive_control import DriveControl, Motoring
from rover_dynamics.vehicle.implicit_kernels import evaluate, hub_motions, implicit_step
from rover_dynamics.vehicle.implicit_method import Moment, rescaled
from rover_dynamics.vehicle.joint_actions import JointActions, JointEffort
from rover_dynamics.vehicle.motors import JointMotor
from rover_dynamics.vehicle.system import System, Tires, work_for

__all__ = ["JointEffort", "Vehicle", "VehicleMotion", "drive_vehicle"]

FloatArray = NDArray[np.float64]
ITERATIONS = 8
"""Newton iterations of a step before it is tried shorter."""
NEWTON_SHARE = 0.01
"""Change at which they end, over the error allowed in the step."""
_EQUAL = 1e-12
"""Relative difference of the lengths of equal steps, which is that of their rounding."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Vehicle:
    """Bodies, wheels and ground.

    Attributes
    ----------
    model : tree of bodies without forces of its own; its drives hold or move joints
    wheels : names of the wheels' bodies; y of their frames is the axle
    terrain : the ground
    tire, settings : of all wheels
    soil : what they stand on instead of hard ground, wheels of its own kind; or None
    efforts : torques and forces in joints
    motors, control : of the wheels, one each in their order or none, and what they are told
    until : whether the motion ends at a sample already, by its time [s] and the bodies' positions (n_b, 3) [m]

    Raises
    ------
    InputError
        For a model with forces of its own, a wheel that is no body of it or named twice, or motors of some wheels only.
    """

    model: MultibodyModel
    wheels: tuple[str, ...]
    terrain: Terrain
    tire: BrushTireParameters = THESIS_BRUSH
    settings: BrushSettings = field(default_factory=BrushSettings)
    soil: SoilBed | None = None
    efforts: tuple[JointEffort, ...] = ()
    motors: tuple[JointMotor, ...] = ()
    control: DriveControl = field(default_factory=DriveControl)
    until: Callable[[float, FloatArray], bool] | None = None

    def __post_init__(self) -> None:
        if self.model.forces:
            rule = "the implicit step knows joint efforts and tires only"
            raise InputError("forces of the vehicle's model", len(self.model.forces), rule, "give them as efforts")
        for wheel in self.wheels:
            if self.model.number(wheel) < 0 or self.wheels.count(wheel) > 1:
                raise InputError("wheel", repr(wheel), "must be a body, and named once", "name the wheels' bodies")
        if self.motors and len(self.motors) != len(self.wheels):
            rule = f"must be one for each of the {len(self.wheels)} wheels"
            raise InputError("motors of the vehicle", len(self.motors), rule, "drive the others by motors too")

    @property
    def actuated(self) -> tuple[str, ...]:
        """Joints of the drives, then of the motors: what the columns of `VehicleMotion.efforts` belong to."""
        return (*[drive.joint for drive in self.model.drives], *[one.joint for one in self.motors])

    def joint_actions(self) -> JointActions:
        """What drives, efforts and motors do in one motion, from its start."""
        motoring = Motoring(self.motors, self.control, self.settings.wheel_radius) if self.motors else None
        return JointActions(self.model, self.efforts, motoring)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VehicleMotion:
    """A motion at the times asked for.

    Attributes
    ----------
    times : (n,) float [s]
    positions, rotations, velocities : (n, n_b, 3), (n, n_b, 3, 3), (n, n_b, 6) float, of all bodies, world
    tires : (n, n_w, 10) float, outputs of the tires, see `rover_dynamics.tires.brush_force.OUTPUT_SIZE`
    wrenches : (n, n_w, 6) float, on the hubs, world [N, N m]
    efforts : (n, n_d + n_m) float, of the drives, in the order of the model's, then of the motors [N m, N]
    steps, iterations, rejected : counts
    ruts : what the wheels left in soil, or None
    """

    times: FloatArray
    positions: FloatArray
    rotations: FloatArray
    velocities: FloatArray
    tires: FloatArray
    wrenches: FloatArray
    efforts: FloatArray
    steps: int
    iterations: int
    rejected: int
    ruts: Ruts | None = None


def drive_vehicle(vehicle: Vehicle, times: FloatArray, steps: ImplicitSteps | None = None) -> VehicleMotion:
    """Integrate from the model's start at ``times[0]`` by the generalised-alpha method with adaptive steps.

    Parameters
    ----------
    vehicle : its bodies start as its model says
    times : (n,) ascending [s]; each is the end of a step
    steps : how they are chosen

    Raises
    ------
    ConvergenceError
        If the step falls below the shortest one; with the motion up to there.
    InputError
        If the times do not ascend; if the bodies form loops, which need `multibody.motion.integrate`; if every joint is
        driven; or for a joint effort at a joint that is driven, or neither a hinge nor a slider.
    """
    return _Run(vehicle, _ascending(times), steps or ImplicitSteps()).to_its_end()


def _ascending(times: FloatArray) -> FloatArray:
    found = np.asarray(times, dtype=np.float64)
    if found.ndim != 1 or len(found) < 2 or not np.all(np.isfinite(found)) or not np.all(np.diff(found) > 0.0):
        rule = "must be two or more and ascend"
        raise InputError("times of a vehicle's motion", f"{times} s", rule, "give e.g. numpy.linspace(0, 1)")
    return found


class _Run:
    """One motion under way."""

    def __init__(self, vehicle: Vehicle, times: FloatArray, steps: ImplicitSteps) -> None:
        self.vehicle, self.times, self.steps = vehicle, times, steps
        self.actions = vehicle.joint_actions()
        self.system = self._system()
        self.work = work_for(self.system)
        self.result: BrushResult = self.work.result
        self.method = generalised_alpha(steps.spectral_radius, NEWTON_SHARE * steps.tolerance, ITERATIONS)
        self.accepted = self.iterations = self.rejected = 0
        self.rows: list[tuple[FloatArray, ...]] = []

    def _system(self) -> System:
        """Arrays for the compiled calls."""
        vehicle, actions = self.vehicle, self.actions
        pieces = vehicle.terrain.pieces()
        wheels = np.array([vehicle.model.number(name) for name in vehicle.wheels], dtype=np.int64)
        soil = None if vehicle.soil is None else vehicle.soil.ground(len(wheels))
        pair = derivative_result(pieces) if soil is None else empty_result(2, soil.states)
        numbers = wheel_numbers(vehicle.tire, vehicle.settings)
        tires = Tires(wheels, numbers, pieces, brush_scratch(pieces), pair, soil)
        gravity = np.array(vehicle.model.gravity, dtype=np.float64)
        tree, free, driven = actions.coordinates.tree, actions.free, actions.driven
        return System(tree, tires, gravity, free, driven, actions.driven_q, actions.motors)

    def start(self, t: float) -> Moment:
        """State and consistent accelerations at t [s]; the method's own begin as these."""
        q, v = self.actions.start(t)
        s = np.zeros_like(self.result.rate)
        if self.vehicle.soil is not None:
            s[:] = self.vehicle.soil.standing()[1]
        known, free = self.actions.known(t), self.system.free
        _, _, h, M = evaluate(self.system, q, v, s, self.result)
        a = np.zeros(len(h))
        a[self.system.driven] = known.a
        a[free] = np.linalg.solve(M[np.ix_(free, free)], (self.actions.torques(known, v)[0] - h - M @ a)[free])
        rate = self.result.rate.copy()
        return Moment(q, v, a, a.copy(), s, rate, rate.copy())

    def to_its_end(self) -> VehicleMotion:
        """Step from one time asked for to the next."""
        t, length, last = float(self.times[0]), self.steps.first, 0.0
        now = self.start(t)
        self._keep(now)
        for target in self.times[1:].tolist():
            while t < target:
                dt = self.steps.towards(target - t, length)
                before = now if last == 0.0 or math.isclose(dt, last, rel_tol=_EQUAL) else rescaled(now, dt / last)
                error, after = self._step(before, t + dt, dt)
                length = self.steps.after(dt, length, error)
                if self.steps.accepts(error):
                    now, last = after, dt
                    t = target if dt == target - t else t + dt
                    self._look(now, t, dt)
                elif length < self.steps.shortest or self.steps.fixed is not None:
                    raise self._stopped(t)
            self._keep(now)
            if self.vehicle.until is not None and self.vehicle.until(target, self.rows[-1][0]):
                break
        return self._motion()

    def _step(self, before: Moment, end: float, dt: float) -> tuple[float, Moment]:
        """Estimated error of a step, infinite if Newton's method fails, and the end of the step."""
        known = self.actions.known(end)
        self._clock(dt)
        converged, iterations, error, after = implicit_step(self.system, before, known, dt, self.method, self.work)
        self.iterations += iterations
        if not converged or not np.isfinite(error):
            error = np.inf
        self.accepted += self.steps.accepts(error)
        self.rejected += not self.steps.accepts(error)
        if self.steps.accepts(error):
            self._keep_in_soil(after)
        self._clock(0.0)
        return error, after

    def _clock(self, dt: float) -> None:
        """Tell the soil the length of the step under way [s]; 0 between steps."""
        if self.system.tires.soil is not None:
            self.system.tires.soil.field.clock[0] = dt

    def _keep_in_soil(self, now: Moment) -> None:
        """Let the soil remember the end of a step."""
        if self.system.tires.soil is not None:
            hubs = hub_motions(tree_motion(self.system.tree, now.q, now.v), self.system.tires.bodies)
            keep_step(hubs, now.s, self.system.tires.soil, self.result)

    def _look(self, now: Moment, t: float, dt: float) -> None:
        """Show the motors' controller the end of a step."""
        if self.actions.motoring is not None:
            motion = tree_motion(self.system.tree, now.q, now.v)
            self.actions.saw(t, dt, now.v, motion, (self.system.tires.bodies, self.result.output[:, 1]))

    def _keep(self, now: Moment) -> None:
        """Record bodies, tires and drives."""
        motion, _, h, M = evaluate(self.system, now.q, now.v, now.s, self.result)
        efforts = (M @ now.a + h)[np.concatenate([self.system.driven, self.system.motors.places])]
        row = (motion.positions[:-1], motion.rotations[:-1], motion.velocities[:-1])
        self.rows.append((*row, self.result.output.copy(), self.result.wrench.copy(), efforts))

    def _motion(self) -> VehicleMotion:
        r, R, u, output, wrench, efforts = (np.array(column) for column in zip(*self.rows, strict=True))
        return VehicleMotion(
            times=self.times[: len(self.rows)],
            positions=r,
            rotations=R,
            velocities=u,
            tires=output,
            wrenches=wrench,
            efforts=efforts,
            steps=self.accepted,
            iterations=self.iterations,
            rejected=self.rejected,
            ruts=None if self.system.tires.soil is None else ruts_of(self.system.tires.soil.field),
        )

    def _stopped(self, t: float) -> ConvergenceError:
        shortest = self.steps.fixed or self.steps.shortest
        message = (
            f"motion of the vehicle stopped at t = {t:g} s of {self.times[-1]:g} s: no step down to "
            f"{shortest:g} s converges; allow a larger error or shorter steps, or look at the ground there"
        )
        record = IncrementRecord(target=t, step=shortest, converged=False, residuals=())
        return ConvergenceError(message, [record], self._motion())
