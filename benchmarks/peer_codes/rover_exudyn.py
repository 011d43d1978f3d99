"""The rover on level ground in EXUDYN: the same bodies, hinges, masses and speed law, with its own rolling discs.

Held actuators are welds and drives are stiff dampers to the law's speed, both EXUDYN's own compiled objects; only the
speed itself is set from Python, once a step. Its build without range checks is taken, and of its linear solvers the one
that is fastest here. Its disc on a plane has Table II's radial spring and damper, and friction in proportion to the
sliding speed up to a threshold, where our tire has bristles. The threshold is that at which both are equally stiff
against slip at the law's speed: mu N / v_0 = C_s / V. A tire without rolling resistance and with one coefficient of
friction (`alike`) then drives as the disc does.

The disc keeps its gap from the last step, and begins with none: left so, it carries nothing during the whole first
step, and the rover falls by half g dt^2, with a velocity that its dampers need seconds to undo. It is given the gap.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.motion_law import MotionLaw
from rover_dynamics.tires.brush_tire import BrushTireParameters
from rover_dynamics.vehicle.vehicle import Vehicle

__all__ = ["SAMPLED", "PeerRun", "alike", "run_exudyn"]

FloatArray = NDArray[np.float64]
DRIVE_DAMPING = 1e4
"""Of the drives to their speed [N m s]."""
SAMPLED = 0.1
"""Time between places [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerRun:
    """Processor time [s], and the principal body's places every `SAMPLED` seconds, (n, 3) [m]."""

    seconds: float
    places: FloatArray


def alike(vehicle: Vehicle) -> Vehicle:
    """The vehicle on tires that a rolling disc equals in steady driving."""
    tire = replace(vehicle.tire, rolling_resistance=0.0, friction_min=vehicle.tire.friction_max)
    return replace(vehicle, tire=tire)


def run_exudyn(vehicle: Vehicle, law: MotionLaw, speed: float, end: float, step: float) -> PeerRun:
    """Integrate from 0 to ``end`` with fixed steps [s], one thread; ``speed`` [m/s] is that of equal slip stiffness."""
    sys.exudynFast = True  # type: ignore[attr-defined]
    import exudyn as exu
    from exudyn.utilities import SensorBody

    container = exu.SystemContainer()
    system = container.AddSystem()
    ground, bodies = system.CreateGround(), _bodies(system, vehicle)
    motors = _joints(system, vehicle, bodies)
    for wheel in vehicle.wheels:
        disc = _disc(system, ground, bodies[wheel], vehicle, speed)
        gap = vehicle.model.bodies[vehicle.model.number(wheel)].position[2] - vehicle.settings.wheel_radius
        node = system.GetObjectParameter(disc, "nodeNumber")
        system.SetNodeParameter(node, "initialCoordinates", [0.0, 0.0, float(gap)])

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


def _disc(system: Any, ground: Any, wheel: Any, vehicle: Vehicle, speed: float) -> Any:
    tire: BrushTireParameters = vehicle.tire
    weight = -sum(part.mass for part in vehicle.model.bodies) * vehicle.model.gravity[2]
    full = tire.friction_max * weight / len(vehicle.wheels)
    return system.CreateRollingDiscPenalty(
        bodyNumbers=[ground, wheel],
        axisPosition=[0.0, 0.0, 0.0],
        axisVector=[0.0, 1.0, 0.0],
        discRadius=vehicle.settings.wheel_radius,
        planeNormal=[0.0, 0.0, 1.0],
        contactStiffness=tire.radial_stiffness,
        contactDamping=tire.radial_damping,
        dryFriction=[tire.friction_max, tire.friction_max],
        dryFrictionProportionalZone=full * speed / tire.longitudinal_slip_stiffness,
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
