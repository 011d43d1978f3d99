"""Wheel-walking: legs and drives in a gait in which most wheels stand while one axle's are moved forward.

A cycle of n axles has n + 1 phases of equal length: half a phase in which all wheels stand and the body moves ahead by
half a stride, a phase for each axle, from the front to the rear, in which its wheels move ahead by a stride and all
others stand, and another half phase for the body. Every part begins and ends at rest, without a jump in acceleration
(`rover_dynamics.multibody.motion_law.Turn`), and the cycle in the pose in which the rover drives.

The legs' angles are those of `planar_pose.SideView`. A wheel whose centre has gone X ahead has turned by X / R against
the ground if it rolls, so that its drive has turned by X / R less its arm's own turn: the drive of a wheel that stands
turns back what the leg turns. Wheels that move may be turned faster than they roll, by the share ``overdrive``:
slipping, they pull while the others stand. Tires that deflect, slopes and rough ground are not known to the gait.

Sources: that legs and wheels move together without slip, and that the wheels are turned a little to anchor them behind
each movement, is told of the ExoMars rover (phys.org, December 2021, after the European Space Agency). No sequence of
it in numbers was found: those here are chosen. Verified by tests/unit/test_walking.py and
tests/verification/test_rover_walking.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.multibody.motion_law import MotionLaw, Turn
from rover_dynamics.rover.planar_pose import side_view
from rover_dynamics.rover.rover import Actuators
from rover_dynamics.rover.rover_design import SIDES, RoverDesign

__all__ = ["Gait", "RepeatedLaw", "repeated", "walking_actuators"]

FloatArray = NDArray[np.float64]
SAMPLES = 40
"""Of a phase, joined by a spline of degree five."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """How a rover walks. Its wheels move at 20 mm/s in the mean, as those of the rover that drives at 70 m/h.

    Attributes
    ----------
    stride : way of a cycle [m]
    period : of a cycle [s]
    overdrive : how much faster than they roll the wheels are turned that move ahead [-]

    Raises
    ------
    InputError
        For a stride or a period that is not above zero, or an overdrive below.
    """

    stride: float = 0.1
    period: float = 20.0
    overdrive: float = 0.0

    def __post_init__(self) -> None:
        for what, value, unit in (("stride", self.stride, "m"), ("period", self.period, "s")):
            if not (math.isfinite(value) and value > 0.0):
                rule = "must be finite and > 0"
                raise InputError(f"{what} of a gait", f"{value:g} {unit}", rule, "leave it out")
        if not (math.isfinite(self.overdrive) and self.overdrive >= 0.0):
            rule = "must be finite and >= 0"
            raise InputError("overdrive of a gait", f"{self.overdrive:g}", rule, "give e.g. 0.05, or leave it out")

    def ways(self, t: FloatArray, axles: int) -> tuple[FloatArray, FloatArray]:
        """Within the first cycle, how far the body (n,) and each axle's wheels (n, n_a) have gone ahead [m].

        Parameters
        ----------
        t : (n,) float, 0 to the period [s]
        axles : n_a, from the front to the rear
        """
        phase, half = self.period / (axles + 1), 0.5 * self.stride
        last = (axles + 0.5) * phase
        body = [Turn(end=half, lasts=0.5 * phase), Turn(end=half, begins=last, lasts=0.5 * phase)]
        moves = [Turn(end=self.stride, begins=(k + 0.5) * phase, lasts=phase) for k in range(axles)]
        wheels = np.array([[move.at(one)[0] for move in moves] for one in t.tolist()])
        return np.array([sum(move.at(one)[0] for move in body) for one in t.tolist()]), wheels

    def stands(self, t: FloatArray, axles: int) -> NDArray[np.bool_]:
        """Whether each axle's wheels stand, (n, n_a), at times t (n,) [s] of any cycle."""
        phase = np.mod(t, self.period)[:, None] / self.period * (axles + 1) - 0.5
        moves = np.arange(axles)
        return np.asarray((phase <= moves) | (phase >= moves + 1))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RepeatedLaw:
    """A motion law of one period, at rest at its ends, repeated; it holds before time zero and behind the last cycle.

    Attributes
    ----------
    pieces : coefficients of each of the period's equal parts, of the highest power first, by time since its start [s]
    part, cycles : length of a part [s]; number of periods
    ahead : how much further each period ends than it begins [rad]
    """

    pieces: tuple[tuple[float, ...], ...]
    part: float
    cycles: int
    ahead: float

    def at(self, t: float) -> tuple[float, float, float]:
        """See `rover_dynamics.multibody.motion_law.MotionLaw`."""
        parts = len(self.pieces)
        last = self.cycles * parts
        if t <= 0.0 or t >= last * self.part:
            return self.pieces[0][-1] + (self.cycles * self.ahead if t > 0.0 else 0.0), 0.0, 0.0
        k = min(int(t / self.part), last - 1)
        x, value, rate, half = t - k * self.part, 0.0, 0.0, 0.0
        for coefficient in self.pieces[k % parts]:
            value, rate, half = value * x + coefficient, rate * x + value, half * x + rate
        return value + (k // parts) * self.ahead, rate, 2.0 * half


def repeated(values: FloatArray, period: float, cycles: int) -> RepeatedLaw:
    """The law through values (n,) at equally spaced times of a period, both of its ends among them [rad]."""
    from scipy.interpolate import PPoly, make_interp_spline

    rests = [(1, 0.0), (2, 0.0)]
    times = np.linspace(0.0, period, len(values))
    spline = make_interp_spline(times, values, k=5, bc_type=(rests, rests))  # type: ignore[arg-type]  # its stub's gap
    found = PPoly.from_spline((spline.t, spline.c, spline.k))
    pieces = tuple(tuple(row) for row in found.c.T[np.diff(found.x) > 0.0].tolist())
    return RepeatedLaw(pieces=pieces, part=period / len(pieces), cycles=cycles, ahead=float(values[-1] - values[0]))


def walking_actuators(design: RoverDesign, gait: Gait, cycles: int) -> Actuators:
    """Laws of all deployment joints and drives, from time zero on.

    Raises
    ------
    InputError
        For a rover that cannot be planned to walk, or a stride that its legs do not reach.
    """
    view = side_view(design)
    axles = len(view.axles)
    times = np.linspace(0.0, gait.period, SAMPLES * (axles + 1) + 1)
    body, wheels = gait.ways(times, axles)
    pose = view.pose(wheels - body[:, None])
    turned = wheels * (1.0 + gait.overdrive) / design.wheel_radius - pose.arms
    laws: dict[str, MotionLaw] = {}
    for joint, angles in (("deploy", pose.deployment), ("drive", turned)):
        for axle, column in zip(view.axles, angles.T, strict=True):
            law = repeated(column, gait.period, cycles)
            laws |= {f"{joint}_{axle}_{side}": law for side in SIDES}
    return Actuators(laws=laws)
