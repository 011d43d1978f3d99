"""A vehicle: a tree of bodies in joints, some of them wheels with brush tires, on a terrain.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from contracts.terrain import Terrain
from rover_dynamics.brush_derivatives import derivative_result
from rover_dynamics.brush_force import BrushResult, brush_result, brush_scratch
from rover_dynamics.brush_settings import BrushSettings, wheel_numbers
from rover_dynamics.brush_tire import THESIS_BRUSH, BrushTireParameters
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.vehicle.implicit_kernels import Method, Moment, Tires, evaluate, implicit_step

__all__ = ["JointEffort", "Vehicle", "VehicleMotion", "VehicleSteps", "drive_vehicle"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class JointEffort:
    """A torque about a hinge, or a force along a slider, as a function of time.

    Attributes
    ----------
    joint : name of a joint of the tree that no drive moves
    effort : of time [s]; on the joint's second body [N m, N]
    """

    joint: str
    effort: Callable[[float], float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Vehicle:
    """Bodies, wheels and ground.

    Attributes
    ----------
    model : tree of bodies without forces of its own; its drives hold or move joints
    wheels : names of the wheels' bodies; y of their frames is the axle
    terrain : the ground
    tire, settings : of all wheels
    efforts : torques and forces in joints
    """

    model: MultibodyModel
    wheels: tuple[str, ...]
    terrain: Terrain
    tire: BrushTireParameters = THESIS_BRUSH
    settings: BrushSettings = field(default_factory=BrushSettings)
    efforts: tuple[JointEffort, ...] = ()

    def __post_init__(self) -> None:
        if self.model.forces:
            rule = "the implicit step knows joint efforts and tires only"
            raise InputError("forces of the vehicle's model", len(self.model.forces), rule, "give them as efforts")
        for wheel in self.wheels:
            self.model.number(wheel)


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleSteps:
    """How steps are chosen.

    Attributes
    ----------
    tolerance : estimated error of a step in the joint coordinates [m, rad]
    first, shortest, longest : steps [s]
    spectral_radius : at infinity; below one the highest frequencies are damped [-]
    """

    tolerance: float = 1e-6
    first: float = 1e-4
    shortest: float = 1e-9
    longest: float = 0.02
    spectral_radius: float = 0.6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VehicleMotion:
    """A motion at the times asked for.

    Attributes
    ----------
    times : (n,) float [s]
    positions, rotations, velocities : (n, n_b, 3), (n, n_b, 3, 3), (n, n_b, 6) float, of all bodies, world
    tires : (n, n_w, 10) float, outputs of the tires, see `rover_dynamics.brush_force.OUTPUT_SIZE`
    wrenches : (n, n_w, 6) float, on the hubs, world [N, N m]
    efforts : (n, n_d) float, of the drives, in the order of the model's [N m, N]
    steps, iterations, rejected : counts
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


def drive_vehicle(vehicle: Vehicle, times: FloatArray, steps: VehicleSteps | None = None) -> VehicleMotion:
    """Integrate from the model's start at ``times[0]`` by the generalised-alpha method with adaptive steps.

    Raises
    ------
    ConvergenceError
        If the step falls below the shortest one; with the motion up to there.
    InputError
        If the bodies form loops: those need `multibody.motion.integrate`.
    """
    return _Run(vehicle, np.asarray(times, dtype=np.float64), steps or VehicleSteps()).to_its_end()


class _Run:
    """One motion under way."""

    def __init__(self, vehicle: Vehicle, times: FloatArray, steps: VehicleSteps) -> None:
        self.vehicle, self.times, self.steps = vehicle, times, steps
        self.coordinates = TreeCoordinates(vehicle.model)
        if self.coordinates.spanning.cut:
            loops = ", ".join(self.coordinates.spanning.cut)
            raise InputError("joints of the vehicle", loops, "close loops", "integrate it explicitly")
        pieces = vehicle.terrain.pieces()
        bodies = np.array([vehicle.model.number(name) for name in vehicle.wheels], dtype=np.int64)
        numbers = wheel_numbers(vehicle.tire, vehicle.settings)
        self.tires = Tires(bodies, numbers, pieces, brush_scratch(pieces), derivative_result(pieces))
        self.result: BrushResult = brush_result(len(bodies), pieces)
        self._joints()
        self.gravity = np.array(vehicle.model.gravity, dtype=np.float64)
        rho = steps.spectral_radius
        alpha_m, alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
        gamma = 0.5 - alpha_m + alpha_f
        self.method = Method(alpha_m, alpha_f, 0.25 * (gamma + 0.5) ** 2, gamma, 0.01 * steps.tolerance, 8)
        self.counts = [0, 0, 0]
        self.rows: list[tuple[FloatArray, ...]] = []

    def _joints(self) -> None:
        """Which velocities are driven, which are free, and where efforts act."""
        tree, spanning = self.coordinates.tree, self.coordinates.spanning
        at = {(named.joint, named.coordinate): int(tree.v_at[named.link]) for named in spanning.joint_links}
        drives = self.vehicle.model.drives
        self.drives: tuple[Drive, ...] = drives
        self.driven = np.array([at[drive.joint, drive.coordinate] for drive in drives], dtype=np.int64)
        self.free = np.setdiff1d(np.arange(tree.v_at[-1]), self.driven)
        self.effort_at: list[tuple[int, JointEffort]] = []
        for effort in self.vehicle.efforts:
            places = [place for (joint, _), place in at.items() if joint == effort.joint]
            if len(places) != 1 or places[0] in self.driven:
                rule = "must be a hinge or a slider that no drive moves"
                raise InputError("joint of an effort", repr(effort.joint), rule, "name another, or remove its drive")
            self.effort_at.append((places[0], effort))

    def known(self, t: float) -> tuple[IntArray, IntArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """What drives and efforts prescribe at a time."""
        laws = np.array([drive.law.at(t) for drive in self.drives]).reshape(-1, 3)
        tau = np.zeros(len(self.free) + len(self.driven))
        for place, effort in self.effort_at:
            tau[place] += effort.effort(t)
        q, v, a = (np.ascontiguousarray(laws[:, k]) for k in range(3))
        return self.free, self.driven, q, v, a, tau, self.gravity

    def start(self, t: float) -> Moment:
        """State and consistent accelerations."""
        tree = self.coordinates.tree
        y = self.coordinates.corrected(t, self.coordinates.start())
        n_q = int(tree.q_at[-1])
        q, v = y[:n_q], y[n_q:]
        s = np.zeros((len(self.tires.bodies), self.result.rate.shape[1]))
        free, driven, _, _, a_d, tau, _ = self.known(t)
        _, _, h, M = evaluate(tree, self.tires, q, v, s, self.gravity, self.result)
        a = np.zeros(len(h))
        a[driven] = a_d
        a[free] = np.linalg.solve(M[np.ix_(free, free)], (tau - h - M @ a)[free])
        rate = self.result.rate.copy()
        return Moment(q, v, a, a.copy(), s, rate, rate.copy())

    def to_its_end(self) -> VehicleMotion:
        t, end, dt = float(self.times[0]), float(self.times[-1]), self.steps.first
        now = self.start(t)
        self.keep(t, now)
        while len(self.rows) < len(self.times):
            target = float(self.times[len(self.rows)])
            dt_now = min(dt, self.steps.longest)
            left = target - t
            if dt_now >= left * (1.0 - 1e-9):
                dt_now = left
            elif dt_now > 0.5 * left:
                dt_now = 0.5 * left
            good, iterations, error, after = implicit_step(
                self.coordinates.tree, self.tires, now, self.known(t + dt_now), dt_now, self.method, self.result
            )
            self.counts[1] += iterations
            if not good or not np.isfinite(error) or error > self.steps.tolerance:
                self.counts[2] += 1
                factor = 0.25 if not good or not np.isfinite(error) else max(0.2, 0.8 * (self.steps.tolerance / error) ** (1 / 3))
                dt = dt_now * factor
                if dt < self.steps.shortest:
                    raise self.stopped(t, end)
                continue
            self.counts[0] += 1
            now, t = after, t + dt_now
            growth = 0.85 * (self.steps.tolerance / max(error, 1e-300)) ** (1 / 3)
            dt = max(dt, dt_now) * min(2.0, max(0.5, growth)) if dt_now < dt else dt_now * min(2.0, max(0.5, growth))
            if abs(t - target) < 1e-12 * max(1.0, abs(target)):
                t = target
                self.keep(t, now)
        return self.motion()

    def keep(self, t: float, now: Moment) -> None:
        """Record bodies, tires and drives."""
        motion, _, h, M = evaluate(
            self.coordinates.tree, self.tires, now.q, now.v, now.s, self.gravity, self.result
        )
        efforts = (M @ now.a + h)[self.driven]
        row = (motion.positions[:-1], motion.rotations[:-1], motion.velocities[:-1])
        self.rows.append((*row, self.result.output.copy(), self.result.wrench.copy(), efforts))

    def motion(self) -> VehicleMotion:
        columns = [np.array([row[k] for row in self.rows]) for k in range(6)]
        r, R, u, output, wrench, efforts = columns
        return VehicleMotion(
            times=self.times[: len(self.rows)], positions=r, rotations=R, velocities=u, tires=output, wrenches=wrench,
            efforts=efforts, steps=self.counts[0], iterations=self.counts[1], rejected=self.counts[2],
        )

    def stopped(self, t: float, end: float) -> ConvergenceError:
        message = (
            f"motion of the vehicle stopped at t = {t:g} s of {end:g} s: no step above "
            f"{self.steps.shortest:g} s converges; allow a larger error, or look at the ground there"
        )
        record = IncrementRecord(target=t, step=self.steps.shortest, converged=False, residuals=())
        return ConvergenceError(message, [record], self.motion())
