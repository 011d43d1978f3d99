"""Claim: implicit steps of a vehicle solve its equations of motion, tires included, with order two.

Source: the same equations by explicit Runge-Kutta of order 8 (SciPy's DOP853), for one dropped wheel by a rig of its
own (tests/brush_rig.py), for trees without tires by `multibody.motion.integrate`; laws of conservation; the order two
of the generalised-alpha method also where steps change (Bruels and Arnold 2008). Tolerances: a wheel dropped from 10
mm, first touch included, with 1e-8 a step to 1e-6 m; trees with 1e-9 a step to 2e-5 m in 2 s; orders within 0.2 of
two; driven joints to rounding; efforts against the rate of angular momentum to 1e-5 of the largest, the error of its
central differences. Negative controls: the method's accelerations left at the time of the last step lose the order;
the other damper law, and half the inertia, are seen.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import rover_dynamics.vehicle.vehicle as vehicle_module
from contracts.terrain import Plane
from rover_dynamics.multibody.body import GROUND, body
from rover_dynamics.multibody.implicit_steps import ImplicitSteps
from rover_dynamics.multibody.joint import revolute, spherical
from rover_dynamics.multibody.model import Drive, MultibodyModel
from rover_dynamics.multibody.motion import StepControl, integrate
from rover_dynamics.multibody.motion_law import Hold, Turn
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.rover.rover import Actuators, build_rover
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw
from rover_dynamics.vehicle.implicit_method import Moment
from rover_dynamics.vehicle.vehicle import Vehicle, VehicleMotion, drive_vehicle
from tests.brush_rig import RADIUS, Rig

FloatArray = NDArray[np.float64]
GRAVITY = (0.0, 0.0, -3.711)
MASS, INERTIA = 320.0 / 6.0, 0.08571


def one_wheel(height: float, velocity: tuple[float, float, float], spin: float, settings: BrushSettings) -> Vehicle:
    wheel = body(
        "wheel",
        MASS,
        (0.06, INERTIA, 0.06),
        (0.0, 0.0, RADIUS + height),
        velocity=velocity,
        angular_velocity=(0.0, spin, 0.0),
    )
    model = MultibodyModel(bodies=(wheel,), joints=(), gravity=GRAVITY)
    return Vehicle(model=model, wheels=("wheel",), terrain=Plane(), settings=settings)


def explicit(vehicle: Vehicle, times: FloatArray, inertia: float = INERTIA) -> FloatArray:
    """Position, velocity and spin of the same wheel by DOP853, (n, 7)."""
    wheel = vehicle.model.bodies[0]
    rig = Rig(settings=vehicle.settings, inertia=inertia, torque=lambda t, spin: 0.0 * t * spin)  # spins by its inertia
    start = np.concatenate([wheel.position, wheel.velocity, [wheel.angular_velocity[1]], np.zeros(rig.wheels.n_state)])
    found = solve_ivp(rig.rate, times[[0, -1]], start, "DOP853", t_eval=times, rtol=1e-10, atol=1e-12, max_step=1e-3)
    return np.asarray(found.y.T[:, :7])


def swinging(gravity: tuple[float, float, float] = GRAVITY) -> Vehicle:
    """A pendulum on a turning arm, hung on a ball joint: joints of both kinds on a carrier that turns."""
    arm = body("arm", 2.0, (0.02, 0.05, 0.06), (0.5, 0.0, 0.0), angular_velocity=(0.0, 0.0, 3.0), velocity=(0, 1.5, 0))
    bob = body("bob", 1.0, (0.01, 0.03, 0.025), (1.0, 0.0, -0.3), angular_velocity=(0, 0, 3.0), velocity=(0, 3.0, 0))
    flap = body(
        "flap", 0.5, (0.004, 0.01, 0.012), (1.0, 0.2, -0.6), velocity=(-0.6, 3.0, 0), angular_velocity=(0, 0, 3.0)
    )
    joints = (
        revolute("mast", GROUND, arm, at=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0)),
        spherical("ball", arm, bob, at=(1.0, 0.0, 0.0)),
        revolute("hinge", bob, flap, at=(1.0, 0.0, -0.6), axis=(1.0, 0.0, 0.0)),
    )
    model = MultibodyModel(bodies=(arm, bob, flap), joints=joints, gravity=gravity)
    return Vehicle(model=model, wheels=(), terrain=Plane())


def energy(model: MultibodyModel, motion: VehicleMotion) -> FloatArray:
    """Kinetic and potential energy [J]."""
    total = np.zeros(len(motion.times))
    for k, part in enumerate(model.bodies):
        v, w, R = motion.velocities[:, k, :3], motion.velocities[:, k, 3:], motion.rotations[:, k]
        spin = np.einsum("nij,jk,nlk,nl->ni", R, part.inertia, R, w)
        total += 0.5 * part.mass * np.sum(v * v, axis=1) + 0.5 * np.sum(w * spin, axis=1)
        total -= part.mass * motion.positions[:, k] @ np.array(model.gravity)
    return total


def order(errors: list[float]) -> float:
    """Mean order of errors at steps that halve."""
    return float(np.log2(errors[0] / errors[-1]) / (len(errors) - 1))


@pytest.mark.parametrize("law", list(DamperLaw))
def test_a_dropped_rolling_wheel_moves_as_by_explicit_integration(law: DamperLaw) -> None:
    times = np.linspace(0.0, 0.6, 61)
    vehicle = one_wheel(0.01, (0.2, 0.0, 0.0), 0.5, BrushSettings(damper_law=law))
    found = drive_vehicle(vehicle, times, ImplicitSteps(tolerance=1e-8))
    expected = explicit(vehicle, times)
    np.testing.assert_allclose(found.positions[:, 0, 2], expected[:, 2], rtol=0, atol=1e-6)
    np.testing.assert_allclose(found.positions[:, 0, 0], expected[:, 0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(found.velocities[:, 0, 0], expected[:, 3], rtol=0, atol=2e-5)
    other = BrushSettings(damper_law=DamperLaw(1 - law))
    control = drive_vehicle(replace(vehicle, settings=other), times, ImplicitSteps(tolerance=1e-8))
    assert np.abs(control.positions[:, 0, 2] - expected[:, 2]).max() > 2e-4
    assert np.abs(explicit(vehicle, times, 0.5 * INERTIA)[:, 3] - expected[:, 3]).max() > 1e-3


def test_order_on_a_tire() -> None:
    times = np.array([0.0, 0.02])
    vehicle = one_wheel(-0.02, (0.2, 0.0, -0.02), 0.5, BrushSettings())
    expected = explicit(vehicle, times)[-1]
    errors = []
    for fixed in (4e-4, 2e-4, 1e-4):
        found = drive_vehicle(vehicle, times, ImplicitSteps(tolerance=1e-10, fixed=fixed))
        errors.append(float(np.abs(found.velocities[-1, 0, :3] - expected[3:6]).max()))
    assert order(errors) == pytest.approx(2.0, abs=0.2)


def reference(vehicle: Vehicle, times: FloatArray) -> FloatArray:
    """Positions of the bodies by DOP853, (n, n_b, 3)."""
    control = StepControl(relative=1e-11, absolute=1e-12)
    states = integrate(TreeCoordinates(vehicle.model), times, control).states
    return np.array([state.positions for state in states])


def test_a_swinging_tree_moves_as_by_explicit_integration() -> None:
    times, vehicle = np.linspace(0.0, 2.0, 41), swinging()
    found = drive_vehicle(vehicle, times, ImplicitSteps(tolerance=1e-9))
    np.testing.assert_allclose(found.positions, reference(vehicle, times), rtol=0, atol=2e-5)


def errors_with_changing_steps(vehicle: Vehicle) -> list[float]:
    """At 0.6 s, with steps that are in turn h and h / 4."""
    errors, expected = [], reference(vehicle, np.array([0.0, 0.6]))[-1]
    for n in (60, 120, 240):
        h = 0.6 / n / 1.25
        times = np.concatenate([[0.0], np.cumsum(np.tile([h, 0.25 * h], n))])
        found = drive_vehicle(vehicle, times, ImplicitSteps(tolerance=1e-10, fixed=1.0))
        assert found.steps == 2 * n
        errors.append(float(np.abs(found.positions[-1] - expected).max()))
    return errors


def test_order_where_steps_change() -> None:
    assert order(errors_with_changing_steps(swinging())) == pytest.approx(2.0, abs=0.2)


def test_negative_control_accelerations_of_the_last_steps_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Left at the time that belongs to the last step, the method's accelerations cost the order."""

    def as_it_was(moment: Moment, ratio: float) -> Moment:
        return moment

    monkeypatch.setattr(vehicle_module, "rescaled", as_it_was)
    assert order(errors_with_changing_steps(swinging())) < 1.5


def test_energy_of_the_swinging_tree_stays() -> None:
    vehicle = swinging()
    found = drive_vehicle(vehicle, np.linspace(0.0, 2.0, 41), ImplicitSteps(tolerance=1e-9, spectral_radius=1.0))
    total = energy(vehicle.model, found)
    swing = float(np.ptp(energy(replace(vehicle.model, gravity=(0.0, 0.0, 0.0)), found)))
    assert swing > 1.0
    assert np.abs(total - total[0]).max() < 1e-4 * swing


def test_equilibrium_is_the_same_from_different_starts() -> None:
    times = np.array([0.0, 10.0, 20.0])
    loads = [drive_vehicle(build_rover(read_rover(), height=h), times).tires[-1, :, 1] for h in (-0.024, 0.01, 0.05)]
    np.testing.assert_allclose(loads[1:], [loads[0]] * 2, rtol=0, atol=1e-3)


def test_driven_joints_follow_their_laws() -> None:
    law = Turn(end=0.4, begins=0.5, lasts=1.0)
    rover = build_rover(read_rover(), height=-0.024, actuators=Actuators(laws={"steer_front_left": law}))
    times = np.linspace(0.0, 2.0, 21)
    found = drive_vehicle(rover, times)
    arm, spindle = (found.rotations[:, rover.model.number(f"{name}_front_left")] for name in ("arm", "spindle"))
    relative = np.einsum("nji,njk->nik", arm, spindle)
    angle = np.arctan2(relative[:, 1, 0], relative[:, 0, 0])
    np.testing.assert_allclose(angle, [law.at(t)[0] for t in times], rtol=0, atol=1e-12)


def test_drive_efforts_hold_the_rover_up() -> None:
    """A held deployment joint carries the moment of weights and tire about it, by the free leg's balance."""
    rover = build_rover(read_rover(), height=-0.024, actuators=Actuators(laws={}))
    found = drive_vehicle(rover, np.array([0.0, 10.0, 20.0]))
    deploy = [drive.joint for drive in rover.model.drives].index("deploy_front_left")
    arm = rover.model.bodies[rover.model.number("arm_front_left")]
    hinge = np.array([0.600, 0.540, 0.280 + RADIUS])
    row = rover.model.number(arm.name)
    point = found.positions[-1, row] + found.rotations[-1, row] @ (hinge - arm.position)
    moment = np.zeros(3)
    for name in ("arm_front_left", "spindle_front_left", "wheel_front_left"):
        k = rover.model.number(name)
        weight = rover.model.bodies[k].mass * np.array(GRAVITY)
        moment += np.cross(found.positions[-1, k] - point, weight)
    wheel = rover.model.number("wheel_front_left")
    force = found.wrenches[-1, 0]
    moment += np.cross(found.positions[-1, wheel] - point, force[:3]) + force[3:]
    axis = found.rotations[-1, row, :, 1]
    assert abs(moment @ axis) > 5.0
    assert found.efforts[-1, deploy] == pytest.approx(-float(moment @ axis), abs=1e-4)


def moved_pendulum() -> Vehicle:
    """An arm turned by a law, a pendulum swinging at its end."""
    arm = body("arm", 2.0, (0.02, 0.05, 0.06), (0.5, 0.0, 0.0))
    bob = body("bob", 1.0, (0.01, 0.03, 0.025), (1.0, 0.0, -0.3))
    joints = (
        revolute("motor", GROUND, arm, at=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0)),
        revolute("hinge", arm, bob, at=(1.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0)),
    )
    drive = Drive(joint="motor", law=Turn(end=1.0, lasts=1.0))
    model = MultibodyModel(bodies=(arm, bob), joints=joints, drives=(drive,), gravity=GRAVITY)
    return Vehicle(model=model, wheels=(), terrain=Plane())


def test_drive_efforts_are_those_of_inverse_dynamics() -> None:
    """The motor's torque is the rate of all angular momentum about its axis, less the moment of the weights."""
    vehicle, times = moved_pendulum(), np.linspace(0.0, 1.0, 2001)
    found = drive_vehicle(vehicle, times, ImplicitSteps(tolerance=1e-9))
    momentum, weights = np.zeros(len(times)), np.zeros(len(times))
    for k, part in enumerate(vehicle.model.bodies):
        r, v, w = found.positions[:, k], found.velocities[:, k, :3], found.velocities[:, k, 4]
        momentum += part.mass * np.cross(r, v)[:, 1] + part.inertia[1, 1] * w
        weights += part.mass * np.cross(r, np.array(GRAVITY))[:, 1]
    rate = (momentum[2:] - momentum[:-2]) / (times[2:] - times[:-2])
    expected = rate - weights[1:-1]
    np.testing.assert_allclose(found.efforts[1:-1, 0], expected, rtol=0, atol=1e-5 * np.abs(expected).max())


def test_holding_still_needs_no_steps_of_its_own() -> None:
    """At rest the error vanishes and steps grow to the longest."""
    model = replace(moved_pendulum().model, drives=(Drive(joint="motor", law=Hold()),))
    found = drive_vehicle(replace(moved_pendulum(), model=model), np.linspace(0.0, 2.0, 3))
    assert found.steps < 120
    assert np.ptp(found.positions[:, 0], axis=0).max() == 0.0
