"""The rover as a vehicle: bodies, hinges and actuators of a `RoverDesign`, standing on a terrain.

Verified by tests/unit/test_rover_model.py and tests/verification/test_rover_loads.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from contracts.errors import InputError
from contracts.terrain import Plane, Terrain
from rover_dynamics.multibody.body import RigidBody, body
from rover_dynamics.multibody.joint import Joint, revolute
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion_law import Hold, MotionLaw
from rover_dynamics.rover.rover_file import Leg, RoverDesign
from rover_dynamics.tires.brush_settings import BrushSettings
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters
from rover_dynamics.vehicle.drive_control import DriveControl
from rover_dynamics.vehicle.joint_actions import JointEffort
from rover_dynamics.vehicle.motors import JointMotor
from rover_dynamics.vehicle.vehicle import Vehicle

__all__ = ["Actuators", "build_rover", "degrees_of_freedom", "wheel_names"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Actuators:
    """What the 18 actuators do, by joint name; deployment and steering hold, drives are free, unless said otherwise.

    Names are ``deploy_LEG``, ``steer_LEG`` and ``drive_LEG`` with LEG such as ``front_left``; a law may also be given
    to a passive pivot, which locks or moves it.

    Attributes
    ----------
    laws : joint -> angle in time; a positive drive angle rolls forward
    torques : joint -> torque in time [N m]
    free : joints that nothing holds
    """

    laws: Mapping[str, MotionLaw] = field(default_factory=dict)
    torques: Mapping[str, Callable[[float], float]] = field(default_factory=dict)
    free: frozenset[str] = frozenset()


def wheel_names(design: RoverDesign) -> tuple[str, ...]:
    """Bodies of the wheels, in the order of the legs."""
    return tuple(f"wheel_{leg.name}" for leg in design.legs)


def build_rover(
    design: RoverDesign,
    *,
    terrain: Terrain | None = None,
    actuators: Actuators | None = None,
    height: float = 0.0,
    tire: BrushTireParameters = THESIS_BRUSH,
    settings: BrushSettings | None = None,
) -> Vehicle:
    """The rover standing level over the origin, lowest points of its wheels ``height`` [m] above z = 0.

    Parameters
    ----------
    design : see `rover_file.read_rover`
    terrain : the ground; level without it
    actuators : what they do
    height : [m]
    tire, settings : of all wheels; radius and width are the design's

    Raises
    ------
    InputError
        For two bodies of one name, a body that hangs on no other, joints of bodies the design does not have, actuators
        the rover does not have, or one that is both moved and loaded by a torque.
    """
    actuators = actuators or Actuators()
    lift = design.wheel_radius + height
    bodies = _bodies(design, lift)
    joints = _joints(design, bodies, lift)
    _check(actuators, [joint.name for joint in joints])
    held = [j.name for j in joints if j.name.startswith(("deploy_", "steer_"))]
    laws: dict[str, MotionLaw] = {n: Hold() for n in held if n not in actuators.free and n not in actuators.torques}
    laws |= actuators.laws
    motors = _motors(design, laws)
    powered = {motor.joint for motor in motors}
    drives = tuple(Drive(joint=name, law=law) for name, law in laws.items() if name not in powered)
    model = MultibodyModel(
        bodies=tuple(bodies.values()), joints=tuple(joints), drives=drives, gravity=(0.0, 0.0, -design.gravity)
    )
    sized = replace(settings or BrushSettings(), wheel_radius=design.wheel_radius, wheel_width=design.wheel_width)
    return Vehicle(
        model=model,
        wheels=wheel_names(design),
        terrain=terrain or Plane(),
        tire=tire,
        settings=sized,
        efforts=tuple(JointEffort(joint=name, effort=torque) for name, torque in actuators.torques.items()),
        motors=motors,
        control=DriveControl() if design.drive is None else design.drive.control,
    )


def _motors(design: RoverDesign, laws: Mapping[str, MotionLaw]) -> tuple[JointMotor, ...]:
    """Of a rover whose drives have limits and all move; held ones are braked, and a drive without limits is a law."""
    names = [f"drive_{leg.name}" for leg in design.legs]
    if design.drive is None or any(isinstance(laws.get(name, Hold()), Hold) for name in names):
        return ()
    return tuple(JointMotor(joint=name, motor=design.drive.motor, law=laws[name]) for name in names)


def degrees_of_freedom(model: MultibodyModel) -> int:
    """Six for each body, less five for each hinge; actuators are not counted."""
    return 6 * len(model.bodies) - 5 * len(model.joints)


def _raised(point: tuple[float, float, float], lift: float) -> tuple[float, float, float]:
    return point[0], point[1], point[2] + lift


def _bodies(design: RoverDesign, lift: float) -> dict[str, RigidBody]:
    """All bodies by name, where they stand at the start."""
    rows = list(design.bodies)
    for leg in design.legs:
        for row in design.leg_bodies:
            x, y, z = (a + b for a, b in zip(leg.drive, row.position, strict=True))
            rows.append(replace(row, name=f"{row.name}_{leg.name}", position=(x, y, z)))
    names = [row.name for row in rows]
    for name in names:
        if names.count(name) > 1:
            raise InputError("body", repr(name), "is in the rover twice", "rename one")
    return {row.name: body(row.name, row.mass, row.inertia, _raised(row.position, lift)) for row in rows}


def _joints(design: RoverDesign, bodies: Mapping[str, RigidBody], lift: float) -> list[Joint]:
    joints = [
        _hinge(pivot.name, (pivot.first, pivot.second), pivot.position, pivot.axis, bodies, lift)
        for pivot in design.pivots
    ]
    joints += [joint for leg in design.legs for joint in _leg_joints(leg, bodies, lift)]
    hanging = {joint.second for joint in joints}
    for name in list(bodies)[1:]:
        if name not in hanging:
            raise InputError("body", repr(name), "hangs on no other", "give it a pivot, as its second body")
    return joints


def _leg_joints(leg: Leg, bodies: Mapping[str, RigidBody], lift: float) -> list[Joint]:
    arm, spindle, wheel = (f"{part}_{leg.name}" for part in ("arm", "spindle", "wheel"))
    along, up = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    return [
        _hinge(f"deploy_{leg.name}", (leg.carrier, arm), leg.deployment, along, bodies, lift),
        _hinge(f"steer_{leg.name}", (arm, spindle), leg.steering, up, bodies, lift),
        _hinge(f"drive_{leg.name}", (spindle, wheel), leg.drive, along, bodies, lift),
    ]


def _hinge(
    name: str,
    ends: tuple[str, str],
    position: tuple[float, float, float],
    axis: tuple[float, float, float],
    bodies: Mapping[str, RigidBody],
    lift: float,
) -> Joint:
    for end in ends:
        if end not in bodies:
            raise InputError(
                f"body of joint '{name}'", repr(end), "is not in the rover", f"it has: {', '.join(bodies)}"
            )
    return revolute(name, bodies[ends[0]], bodies[ends[1]], at=_raised(position, lift), axis=axis)


def _check(actuators: Actuators, joints: list[str]) -> None:
    for name in {*actuators.laws, *actuators.torques, *actuators.free}:
        if name not in joints:
            raise InputError("actuator", repr(name), "is not in the rover", f"it has: {', '.join(joints)}")
    both = sorted(set(actuators.laws) & (set(actuators.torques) | actuators.free))
    if both:
        raise InputError("actuator", repr(both[0]), "cannot follow a law and be free or loaded", "choose one of them")
