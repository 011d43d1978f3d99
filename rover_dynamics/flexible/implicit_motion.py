"""Motion of a vehicle on flexible tires by the generalised-alpha method: the fast way.

The method is that of `rover_dynamics.multibody.generalised_alpha`, with the tires' free vectors z beside the joints'
coordinates; they are a linear space, so that z and z' follow from the method's accelerations alone. Reference nodes are
eliminated onto the wheels' bodies. Unknown are the accelerations:

    joints  M a + h(q, v) - sum J^T D^T (Q_r - M_rf z'' - M_rr z_r'') = tau,      tires  M_ff z'' + M_fr z_r'' = Q_f

Verified by tests/verification/test_flexible_motion.py.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, IncrementRecord
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle
from rover_dynamics.flexible.motion_checkpoint import EVERY, MotionCheckpoint, motion_key
from rover_dynamics.flexible.step_solver import StepEnd, StepSolver
from rover_dynamics.multibody.generalised_alpha import Method, damped_newmark, generalised_alpha

__all__ = ["drive_on_flexible_tires"]

FloatArray = NDArray[np.float64]
ITERATIONS = 12
"""Newton iterations of a step before it is tried shorter."""
NEWTON_SHARE = 0.01
"""Change at which they end, over the error allowed in the step."""


def drive_on_flexible_tires(
    vehicle: FlexibleVehicle,
    times: FloatArray,
    steps: EvenSteps | None = None,
    *,
    settles_until: float = -np.inf,
    watch: Callable[[float, Instant], None] | None = None,
    start: Instant | None = None,
    checkpoint: Path | None = None,
) -> FlexibleMotion:
    """Integrate from the model's start at ``times[0]``, tires undeformed, or from where another motion ended.

    Parameters
    ----------
    vehicle : its bodies start as its model says
    times : (n,) ascending [s]; each is the end of a step
    steps : how they are chosen
    settles_until : up to this time [s] steps are those of `damped_newmark`, as long as Newton's method bears
        them: the vehicle comes to rest without bouncing
    watch : called with time and state at each step's end; a ConvergenceError of it ends the motion
    start : bodies and tires begin in this state's place, at rest
    checkpoint : file to keep the motion in every second of it and, if an earlier run of this very motion left it, to
        go on from; removed at the end

    Raises
    ------
    ConvergenceError
        If the step falls below the shortest one, or from ``watch``; with the motion up to there.
    InputError
        See `rover_dynamics.vehicle.vehicle.drive_vehicle`.
    """
    chosen, kept = steps or EvenSteps(), None
    if checkpoint is not None:
        kept = MotionCheckpoint(path=checkpoint, key=motion_key(vehicle, np.asarray(times), chosen, settles_until))
    return _Run(vehicle, times, chosen, settles_until, watch, kept).to_its_end(start)


class _Run:
    """One motion under way."""

    def __init__(
        self,
        vehicle: FlexibleVehicle,
        times: FloatArray,
        steps: EvenSteps,
        settles_until: float,
        watch: Callable[[float, Instant], None] | None,
        checkpoint: MotionCheckpoint | None = None,
    ) -> None:
        self.times, self.steps, self.watch = np.asarray(times, dtype=np.float64), steps, watch
        self.system, self.settles_until = FlexibleSystem(vehicle), settles_until
        self.settling: Method = damped_newmark(NEWTON_SHARE * steps.tolerance, ITERATIONS)
        self.moving: Method = generalised_alpha(steps.spectral_radius, NEWTON_SHARE * steps.tolerance, ITERATIONS)
        self.solver, self.checkpoint = StepSolver(self.system), checkpoint
        self.accepted = self.rejected = 0

    def to_its_end(self, start: Instant | None = None) -> FlexibleMotion:
        """Step from one time asked for to the next."""
        system = self.system
        (t, length, last), now, rows = self._start(start)
        next_kept = t + EVERY
        for target in self.times[len(rows) :].tolist():
            while t < target:
                method = self.settling if t < self.settles_until else self.moving
                dt = self.steps.towards(target - t, length)
                before = now.rescaled(dt / last) if last > 0.0 else now
                found, error = self.solver.step(before, self.system.known(t + dt), dt, method)
                length = self.steps.after(length, dt, error)
                if found is None or error > self.steps.tolerance:
                    self.rejected += 1
                    if length < self.steps.shortest:
                        raise self._stopped(t, rows)
                    continue
                self.accepted += 1
                now, last, t = found, dt, (target if dt == target - t else t + dt)
                if self.watch is not None:
                    self._show(t, now.instant, rows)
                if t == target:
                    rows.append(system.row(now.instant, t))  # with the torques that were asked for in this step
                self._look(now.instant, t, dt)
            if t >= next_kept:
                next_kept = t + EVERY
                self.solver.forget()
                self._keep((t, length, last), now, rows)
        return self._motion(rows)

    def _look(self, now: Instant, t: float, dt: float) -> None:
        """Show the motors' controller the end of a step."""
        system = self.system
        if system.actions.motoring is not None:
            loads = system.tires.contacts(*system.whole(now)).load
            system.actions.saw(t, dt, now.v, now.motion, (system.wheels, loads))

    def _show(self, t: float, now: Instant, rows: list[tuple[FloatArray, ...]]) -> None:
        assert self.watch is not None
        try:
            self.watch(t, now)
        except ConvergenceError as error:
            raise ConvergenceError(str(error), error.history, self._motion(rows)) from error

    def _start(self, start: Instant | None) -> tuple[tuple[float, float, float], StepEnd, list[tuple[FloatArray, ...]]]:
        """Time, wish for the next step and last step [s], state and rows: of the checkpoint, or of the model."""
        kept = None if self.checkpoint is None else self.checkpoint.read()
        if kept is None:
            t = float(self.times[0])
            instant = self.system.at_rest(t) if start is None else self.system.at_rest_there(start)
            now = StepEnd(instant=instant, A=instant.a, Z=instant.z_acceleration)
            return (t, self.steps.first, 0.0), now, [self.system.row(instant, t)]
        joints = kept["joints0"], kept["joints1"], kept["joints2"]
        tires = kept["tires0"], kept["tires1"], kept["tires2"]
        now = StepEnd(instant=self.system.instant(joints, tires), A=kept["A"], Z=kept["Z"])
        if self.system.actions.motoring is not None:
            self.system.actions.motoring.restore(kept["motoring"])
        counts = [int(count) for count in kept["counts"]]
        self.accepted, self.rejected, self.solver.iterations, self.solver.linearisations = counts
        names = sorted(name for name in kept if name.startswith("rows"))
        rows = list(zip(*(kept[name] for name in names), strict=True))
        t, length, last = kept["clock"].tolist()
        return (t, length, last), now, rows

    def _keep(self, clock: tuple[float, float, float], now: StepEnd, rows: list[tuple[FloatArray, ...]]) -> None:
        """Write the checkpoint, if one is wanted."""
        if self.checkpoint is None:
            return
        i, columns = now.instant, [np.array(column) for column in zip(*rows, strict=True)]
        arrays = {f"joints{k}": part for k, part in enumerate((i.q, i.v, i.a))}
        arrays |= {f"tires{k}": part for k, part in enumerate((i.z, i.z_rate, i.z_acceleration))}
        arrays |= {f"rows{k}": column for k, column in enumerate(columns)}
        counts = np.array([self.accepted, self.rejected, self.solver.iterations, self.solver.linearisations])
        if self.system.actions.motoring is not None:
            arrays["motoring"] = self.system.actions.motoring.state()
        arrays |= {"A": now.A, "Z": now.Z, "clock": np.array(clock), "counts": counts}
        self.checkpoint.write(arrays)

    def _motion(self, rows: list[tuple[FloatArray, ...]]) -> FlexibleMotion:
        """What the motion came to; it needs no checkpoint any more."""
        if self.checkpoint is not None:
            self.checkpoint.discard()
        r, R, u, outputs, wrenches, efforts, z, v = (np.array(column) for column in zip(*rows, strict=True))
        return FlexibleMotion(
            times=self.times[: len(rows)],
            positions=r,
            rotations=R,
            velocities=u,
            tires=outputs,
            wrenches=wrenches,
            efforts=efforts,
            steps=self.accepted,
            iterations=self.solver.iterations,
            rejected=self.rejected,
            vectors=z,
            rates=v,
            linearisations=self.solver.linearisations,
        )

    def _stopped(self, t: float, rows: list[tuple[FloatArray, ...]]) -> ConvergenceError:
        message = (
            f"motion on flexible tires stopped at t = {t:g} s of {self.times[-1]:g} s: no step down to "
            f"{self.steps.shortest:g} s converges; look at tires and bodies there, or allow shorter steps"
        )
        record = IncrementRecord(target=t, step=self.steps.shortest, converged=False, residuals=())
        return ConvergenceError(message, [record], self._motion(rows))
