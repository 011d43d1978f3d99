"""The rover on level ground in EXUDYN: the same bodies, hinges, masses and speed law, with its own rolling discs.

Held actuators are welds and drives are stiff dampers to the law's speed, both EXUDYN's own compiled objects; only the
speed itself is set from Python, once a step. Its disc on a plane has Table II's radial spring and damper, without the
build-up of the damper, and the larger friction coefficient, proportional to the sliding speed below a threshold where
our tire has bristles: masses and stiffnesses are the same, the slip law is simpler.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.brush_tire import BrushTireParameters
from rover_dynamics.multibody.motion_law import MotionLaw
from rover_dynamics.vehicle.vehicle import Vehicle

__all__ = ["SAMPLED", "PeerRun", "run_exudyn"]

FloatArray = NDArray[np.float64]
DRIVE_DAMPING = 1e4
"""Of the drives to their speed [N m s]."""
SLIDING = 1e-2
"""Sliding speed at which friction is full [m/s]."""
SAMPLED = 0.1
"""Time between places [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerRun:
    """Processor time [s], and the principal body's places every `SAMPLED` seconds, (n, 3) [m]."""

    seconds: float
    places: FloatArray


def run_exudyn(vehicle: Vehicle, law: MotionLaw, end: float, step: float) -> PeerRun:
    """Integrate from 0 to ``end`` with fixed steps [s], one thread."""
    import exudyn as exu
    from exudyn.utilities import SensorBody

    container = exu.SystemContainer()
    system = container.AddSystem()
    ground, bodies = system.CreateGround(), _bodies(system, vehicle)
    motors = _joints(system, vehicle, bodies)
    for wheel in vehicle.wheels:
        _disc(system, ground, bodies[wheel], vehicle.model.bodies[vehicle.model.number(wheel)].position, vehicle)

    def set_speed(own: Any, t: float) -> bool:
        for motor in motors:
            own.SetObjectParameter(motor, "velocityOffset", law.at(t)[1])
        return True

    system.SetPreStepUserFunction(set_speed)
    place = exu.OutputVariableType.Position
    sensor = system.AddSensor(SensorBody(bodyNumber=bodies["principal"], storeInternal=True, outputVariableType=place))
    system.Assemble()
    settings = _settings(exu, end, step)
    begun = time.process_time()
    system.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    spent = time.process_time() - begun
    return PeerRun(seconds=spent, places=np.asarray(system.GetSensorStoredData(sensor))[:, 1:])


def _bodies(system: Any, vehicle: Vehicle) -> dict[str, Any]:
    from exudyn.utilities import RigidBodyInertia

    return {
        part.name: system.CreateRigidBody(
            name=part.name,
            referencePosition=list(part.position),
            inertia=RigidBodyInertia(mass=part.mass, inertiaTensor=part.inertia),
            gravity=list(vehicle.model.gravity),
        )
        for part in vehicle.model.bodies
    }


def _joints(system: Any, vehicle: Vehicle, bodies: dict[str, Any]) -> list[Any]:
    """Welds for held joints, hinges for the others; the drives' dampers are returned."""
    motors, driven = [], {drive.joint for drive in vehicle.model.drives}
    for joint in vehicle.model.joints:
        first = vehicle.model.bodies[vehicle.model.number(joint.first)]
        at = list(first.position + first.rotation @ joint.first_frame.position)
        axis = list(first.rotation @ joint.first_frame.rotation[:, 2])
        ends = [bodies[joint.first], bodies[joint.second]]
        moved = joint.name.startswith("drive_")
        if joint.name in driven and not moved:
            system.CreateGenericJoint(bodyNumbers=ends, position=at, constrainedAxes=[1] * 6)
            continue
        system.CreateRevoluteJoint(bodyNumbers=ends, position=at, axis=axis)
        if moved:
            motors.append(
                system.CreateTorsionalSpringDamper(bodyNumbers=ends, position=at, axis=axis, damping=DRIVE_DAMPING)
            )
    return motors


def _disc(system: Any, ground: Any, wheel: Any, at: FloatArray, vehicle: Vehicle) -> None:
    tire: BrushTireParameters = vehicle.tire
    system.CreateRollingDiscPenalty(
        bodyNumbers=[ground, wheel],
        axisPosition=[0.0, 0.0, 0.0],
        axisVector=[0.0, 1.0, 0.0],
        discRadius=vehicle.settings.wheel_radius,
        planeNormal=[0.0, 0.0, 1.0],
        contactStiffness=tire.radial_stiffness,
        contactDamping=tire.radial_damping,
        dryFriction=[tire.friction_max, tire.friction_max],
        dryFrictionProportionalZone=SLIDING,
        useLinearProportionalZone=True,
    )


def _settings(exu: Any, end: float, step: float) -> Any:
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = end
    settings.timeIntegration.numberOfSteps = round(end / step)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = SAMPLED
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    settings.displayStatistics = False
    return settings
