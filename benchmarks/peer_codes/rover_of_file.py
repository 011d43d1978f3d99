"""The rover in EXUDYN, written from the rover's file as it stands: nothing of `rover_dynamics` is asked.

Bodies, hinges and mirrored sides are read from the TOML file here once more, tires are `plain_tire`, and EXUDYN has the
rest: redundant coordinates (Euler parameters), constraints by Lagrange multipliers, implicit steps of its own, where
our rover is a tree in joint coordinates. Held actuators are welds; drives follow a speed law by a spring so stiff that
they lag by microradians. Bristles are integrated with the steps, by the trapezoidal rule.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.peer_codes.plain_tire import Bristles, PlainTire, Touch

__all__ = ["Law", "PeerMotion", "PeerRover", "peer_motion", "rover_content"]

FloatArray = NDArray[np.float64]
FILE = Path(__file__).resolve().parents[2] / "rover_dynamics" / "rover" / "exomars_rover.toml"
SPECTRAL_RADIUS = 0.6
DRIVE_STIFFNESS, DRIVE_DAMPING = 1e7, 1e4
"""Of the drives to their law [N m/rad, N m s/rad]."""
type Three = Sequence[float]
type Law = Callable[[float], tuple[float, float]]
"""Angle [rad] and speed [rad/s] of the drives at a time [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerRover:
    """What is driven where.

    Attributes
    ----------
    file : content of the rover's file
    gravity : of the ground's frame, z its normal [m/s^2]
    height : of the wheels' lowest points over the ground at the start [m]; None for the mean static deflection below
    drives : "held", "free", or the law of all of them
    tire : numbers of all wheels; its radius and width are the file's
    """

    file: Mapping[str, Any]
    gravity: tuple[float, float, float]
    height: float | None
    drives: str | Law = "held"
    tire: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerMotion:
    """Times (n,) [s]; places of the first body (n, 3) and of the wheels (n, 6, 3) [m]; loads, tractive and lateral
    forces of the wheels (n, 6) [N]. Wheels in the order of the file's legs, left before right.
    """

    times: FloatArray
    place: FloatArray
    wheels: FloatArray
    loads: FloatArray
    tractive: FloatArray
    lateral: FloatArray


def rover_content() -> dict[str, Any]:
    """Of the rover's file that ships."""
    return tomllib.loads(FILE.read_text(encoding="utf-8"))


def peer_motion(rover: PeerRover, steps: Sequence[tuple[float, float]]) -> PeerMotion:
    """Integrate from rest; ``steps`` are the ends and lengths of the parts with equal steps, in turn [s]."""
    return _Run(rover).to_its_end(steps)


def _sides(row: Mapping[str, Any]) -> list[tuple[str, float]]:
    return [("_left", 1.0), ("_right", -1.0)] if row.get("mirrored") else [("", 1.0)]


class _Run:
    """One model of EXUDYN and what its user functions keep."""

    def __init__(self, rover: PeerRover) -> None:
        import exudyn

        self.rover, self.exu = rover, exudyn
        self.system = exudyn.SystemContainer().AddSystem()
        self.ground = self.system.CreateGround()
        self.bodies: dict[str, Any] = {}
        self.tire = PlainTire(R=rover.file["wheel"]["radius"], b=rover.file["wheel"]["width"], **rover.tire)
        self.wheels: list[Any] = []
        self.bristles: list[Bristles] = []
        self.dt = self.next_dt = 0.0
        self.rows: list[Any] = []
        height = self._pressed_in() if rover.height is None else rover.height
        self.lift = self.tire.R + height
        self._build()
        self.first = next(iter(self.bodies.values()))

    def _pressed_in(self) -> float:
        """A wheel's share of the weight along the ground's normal over the radial stiffness, downwards [m]."""
        file, wheels = self.rover.file, 2 * len(self.rover.file["legs"])
        mass = sum(row["mass"] * len(_sides(row)) for row in file["bodies"])
        mass += wheels * sum(row["mass"] for row in file["leg_bodies"].values())
        return float(mass * self.rover.gravity[2] / (wheels * self.tire.k))

    def _raised(self, point: Three, sign: float = 1.0) -> list[float]:
        return [point[0], sign * point[1], point[2] + self.lift]

    def _body(self, name: str, row: Mapping[str, Any], place: Three) -> None:
        from exudyn.utilities import RigidBodyInertia

        self.bodies[name] = self.system.CreateRigidBody(
            referencePosition=place,
            inertia=RigidBodyInertia(mass=row["mass"], inertiaTensor=np.diag(row["inertia"])),
            gravity=list(self.rover.gravity),
        )

    def _build(self) -> None:
        file = self.rover.file
        for row in file["bodies"]:
            for side, sign in _sides(row):
                self._body(row["name"] + side, row, self._raised(row["position"], sign))
        for row in file.get("pivots", []):
            for side, sign in _sides(row):
                ends = [self.bodies[row["first"]], self.bodies[row["second"] + side]]
                place = self._raised(row["position"], sign)
                self.system.CreateRevoluteJoint(itemNumbers=ends, position=place, axis=row["axis"])
        mirrored = {row["name"] for row in file["bodies"] if row.get("mirrored")}
        for leg in file["legs"]:
            for side, sign in _sides({"mirrored": True}):
                self._leg(leg, leg["carrier"] + side * (leg["carrier"] in mirrored), sign)

    def _leg(self, leg: Mapping[str, Any], carrier: str, sign: float) -> None:
        """Arm, spindle and wheel on their three axes; deployment and steering are held."""
        last = self.bodies[carrier]
        for part, axis in (("arm", "deployment"), ("spindle", "steering"), ("wheel", "drive")):
            row = self.rover.file["leg_bodies"][part]
            x, y, z = leg["drive"]
            self._body(part, row, self._raised([x, y, z + row["above_axle"]], sign))
            ends, at = [last, self.bodies[part]], self._raised(leg[axis], sign)
            last = self.bodies[part]
            if part == "wheel" and self.rover.drives != "held":
                self._drive(ends, at)
            else:
                self.system.CreateGenericJoint(itemNumbers=ends, position=at, constrainedAxes=[1] * 6)
        self._tire(last)

    def _drive(self, ends: list[Any], at: list[float]) -> None:
        law, y = self.rover.drives, [0.0, 1.0, 0.0]
        self.system.CreateRevoluteJoint(itemNumbers=ends, position=at, axis=y)
        if isinstance(law, str):
            return

        def torque(_: Any, t: float, __: int, angle: float, speed: float, *___: float) -> float:
            wanted = law(t)
            return DRIVE_STIFFNESS * (angle - wanted[0]) + DRIVE_DAMPING * (speed - wanted[1])

        self.system.CreateTorsionalSpringDamper(itemNumbers=ends, position=at, axis=y, springTorqueUserFunction=torque)

    def _tire(self, wheel: Any) -> None:
        """Its wrench on the hub as a connector's, which EXUDYN derives by differences itself."""
        from exudyn.itemInterface import MarkerBodyRigid, ObjectConnectorRigidBodySpringDamper

        k = len(self.wheels)
        self.wheels.append(wheel)
        self.bristles.append(Bristles())

        def action(_: Any, __: float, ___: int, p: Three, ____: Three, v: Three, w: Three, *_____: Any) -> list[float]:
            e = self._axle(wheel)
            touch = self.tire.touch(p, e, v, w)
            now = self.tire.moved(self.bristles[k], touch, self.dt)
            force, moment, _ = self.tire.wrench(touch, now.u, e)
            return [-x for x in (*force, *moment)]

        markers = [self.system.AddMarker(MarkerBodyRigid(bodyNumber=one)) for one in (self.ground, wheel)]
        self.system.AddObject(
            ObjectConnectorRigidBodySpringDamper(markerNumbers=markers, springForceTorqueUserFunction=action)
        )

    def _output(self, body: Any, what: str) -> list[float]:
        kind = getattr(self.exu.OutputVariableType, what)
        return self.system.GetObjectOutputBody(body, kind, [0.0, 0.0, 0.0]).tolist()  # type: ignore[no-any-return]

    def _touch(self, wheel: Any) -> tuple[Touch | None, list[float]]:
        """How a wheel touches now, and its axle."""
        e, at = self._axle(wheel), self._output(wheel, "Position")
        return self.tire.touch(at, e, self._output(wheel, "Velocity"), self._output(wheel, "AngularVelocity")), e

    def _axle(self, wheel: Any) -> list[float]:
        return self._output(wheel, "RotationMatrix")[1::3]

    def _begins(self, _: Any, __: float) -> bool:
        self.dt = self.next_dt
        return True

    def _ended(self, _: Any, t: float) -> bool:
        """End of a step: bristles moved on, a row kept."""
        found = []
        for k, wheel in enumerate(self.wheels):
            touch, e = self._touch(wheel)
            self.bristles[k] = self.tire.moved(self.bristles[k], touch, self.dt)
            along = self.tire.wrench(touch, self.bristles[k].u, e)[2]
            found.append((*self._output(wheel, "Position"), 0.0 if touch is None else touch.load, *along))
        self.rows.append((t, self._output(self.first, "Position"), found))
        return True

    def to_its_end(self, steps: Sequence[tuple[float, float]]) -> PeerMotion:
        """Part by part; bristles keep still while EXUDYN asks for the accelerations at a part's begin."""
        self.system.SetPreStepUserFunction(self._begins)
        self.system.SetPostStepUserFunction(self._ended)
        self.system.Assemble()
        begin = 0.0
        self._ended(self.system, begin)
        for end, dt in steps:
            self.dt, self.next_dt = 0.0, dt
            settings = self._settings(begin, end, dt)
            kind = self.exu.DynamicSolverType.GeneralizedAlpha
            self.system.SolveDynamic(settings, solverType=kind, updateInitialValues=True)
            begin = end
        times, place, wheels = (np.array(column) for column in zip(*self.rows, strict=True))
        x, load, tractive, lateral = wheels[..., :3], wheels[..., 3], wheels[..., 4], wheels[..., 5]
        return PeerMotion(times=times, place=place, wheels=x, loads=load, tractive=tractive, lateral=lateral)

    def _settings(self, begin: float, end: float, dt: float) -> Any:
        settings = self.exu.SimulationSettings()
        time = settings.timeIntegration
        time.startTime, time.endTime, time.numberOfSteps = begin, end, round((end - begin) / dt)
        time.adaptiveStep, time.verboseMode = False, 0
        time.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
        settings.solution.file.write = False
        settings.linearSolver.solverType = self.exu.LinearSolverType.EigenSparse
        settings.parallel.numberOfThreads = 1
        return settings
