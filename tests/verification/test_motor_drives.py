"""Claim: drives with limits give the torque their line and their current allow, and controllers do what they say.

Source: closed forms of a wheel that a motor spins up in the air: at full voltage 1 - exp(-t T_s / (I v_0)), half of the
electrical energy lost in the windings (both follow from the linear line); at the current limit a speed in proportion to
time; the weight's component for the torque that a rover needs on a slope. Tolerances: speeds to 1e-4 of the no-load
speed, energies to 1 %, the summed torque on a slope to 1 % (rolling resistance counted). Negative controls: a torque
below what the slope needs lets the rover roll back; without the controllers of slip and of shares the slip is three
times as large, and the torques differ by more than the loads.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import Plane
from rover_dynamics.multibody.body import GROUND, body
from rover_dynamics.multibody.joint import revolute
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion_law import MotionLaw, SpeedTrapezoid, UserLaw
from rover_dynamics.rover.rover_design import WheelDrive
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.level_ground import SPEED
from rover_dynamics.rover.scenarios.point_turn import PAUSES, STEERS
from rover_dynamics.rover.scenarios.readings import energy_of_drives
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario
from rover_dynamics.vehicle.drive_control import Controller, DriveControl
from rover_dynamics.vehicle.motor_kernels import add_motor_torques, motor_numbers
from rover_dynamics.vehicle.motors import (
    STANDS,
    JointMotor,
    Motor,
    electrical_power,
    motor_torque,
    used_of_limits,
)
from rover_dynamics.vehicle.vehicle import JointEffort, Vehicle, VehicleMotion, drive_vehicle

FloatArray = NDArray[np.float64]
INERTIA, STALL, NO_LOAD = 0.08, 2.0, 5.0
LIMITED = Motor(torque_limit=1.2, stall_torque=STALL, no_load_speed=NO_LOAD, efficiency=0.6)
DESIGN = read_rover()


def at_once(speed: float) -> MotionLaw:
    """A speed asked for from the start on."""
    return UserLaw(function=lambda t: (speed * t, speed, 0.0))


def spun_up(
    motor: Motor, law: MotionLaw, times: FloatArray, efforts: tuple[JointEffort, ...] = ()
) -> tuple[VehicleMotion, FloatArray, FloatArray]:
    """A wheel on a fixed axle in the air: its motion, speeds and torques of its motor."""
    wheel = body("wheel", 5.0, (0.05, INERTIA, 0.05), (0.0, 0.0, 1.0))
    axle = revolute("axle", GROUND, wheel, at=(0.0, 0.0, 1.0), axis=(0.0, 1.0, 0.0))
    model = MultibodyModel(bodies=(wheel,), joints=(axle,), gravity=(0.0, 0.0, 0.0))
    motors = (JointMotor(joint="axle", motor=motor, law=law),)
    vehicle = Vehicle(model=model, wheels=("wheel",), terrain=Plane(), motors=motors, efforts=efforts)
    motion = drive_vehicle(vehicle, times)
    return motion, motion.velocities[:, 0, 4], motion.efforts[:, 0]


def climbing(drive: WheelDrive | None) -> ScenarioRun:
    return run_scenario(SCENARIOS["slope_up"], replace(DESIGN, drive=drive))


@pytest.fixture(scope="module")
def unlimited() -> ScenarioRun:
    return climbing(WheelDrive())


def test_full_voltage_spins_up_along_the_line() -> None:
    motor, times = Motor(stall_torque=STALL, no_load_speed=NO_LOAD), np.linspace(0.0, 2.0, 401)
    _, speeds, torques = spun_up(motor, at_once(10.0 * NO_LOAD), times)
    expected = NO_LOAD * (1.0 - np.exp(-times * STALL / (INERTIA * NO_LOAD)))
    assert speeds == pytest.approx(expected, abs=1e-4 * NO_LOAD)
    assert torques == pytest.approx(STALL * (1.0 - expected / NO_LOAD), abs=2e-4 * STALL)
    taken = np.trapezoid(electrical_power(motor, torques, speeds), times)
    kinetic = 0.5 * INERTIA * speeds[-1] ** 2
    assert taken == pytest.approx(2.0 * kinetic, rel=0.01)


def test_the_current_limit_bounds_the_torque_in_both_directions() -> None:
    times = np.linspace(0.0, 0.5, 51)
    for sign in (1.0, -1.0):
        _, speeds, torques = spun_up(Motor(torque_limit=0.4), at_once(sign * 100.0), times)
        assert torques == pytest.approx(sign * 0.4)
        assert speeds == pytest.approx(sign * 0.4 / INERTIA * times, abs=1e-6)


def test_within_its_limits_a_motor_follows_its_law() -> None:
    law = SpeedTrapezoid(speed=2.0, accelerates=0.5)
    _, speeds, torques = spun_up(Motor(torque_limit=5.0), law, np.linspace(0.0, 1.0, 101))
    assert speeds[-1] == pytest.approx(2.0, rel=1e-4)
    assert torques.max() == pytest.approx(INERTIA * 2.0 * 1.5 / 0.5, rel=0.01)  # steepest slope of its ramp


def test_a_gear_loses_in_both_directions() -> None:
    motor = Motor(efficiency=0.5, stall_torque=8.0, no_load_speed=2.0)
    power = electrical_power(motor, np.array([1.0, -1.0]), np.array([1.0, 1.0]))
    loss = 2.0 / 8.0
    assert power == pytest.approx([2.0 * (1.0 + loss * 2.0), -0.5 * (1.0 - loss * 0.5)])


@pytest.mark.parametrize(
    ("push", "held"),
    [(0.0, 0.2), (-0.5, 0.5), (-1.0, 0.8)],
    ids=["drives", "stands by the gear's friction", "is pushed back"],
)
def test_a_gear_brakes_with_the_motor_what_it_takes_from_it(push: float, held: float) -> None:
    """At the current limit 0.4 N m reach the wheel as eta T = 0.2, and hold one pushed back with T / eta = 0.8."""
    motor, times = Motor(torque_limit=0.4, efficiency=0.5), np.linspace(0.0, 0.5, 51)
    effort = JointEffort(joint="axle", effort=lambda t: push)
    _, speeds, sums = spun_up(motor, at_once(100.0), times, (effort,))
    torques = sums - push
    assert torques[5:] == pytest.approx(held, rel=1e-3)
    assert speeds[-1] - speeds[5] == pytest.approx((held + push) / INERTIA * (times[-1] - times[5]), abs=1e-3)
    turned = np.abs(speeds) > 5.0 * STANDS
    assert motor_torque(motor, torques[turned], speeds[turned]) == pytest.approx(0.4, rel=1e-3)


def test_slopes_are_those_of_the_torques() -> None:
    """All the way from before the line's end through standing still, at the current limit and along the line."""
    motors = motor_numbers(np.array([0]), (JointMotor(joint="a", motor=LIMITED, law=at_once(1.0)),))
    step, slopes, lower, higher = 1e-7, np.zeros(1), np.zeros(1), np.zeros(1)
    for speed in (-7.0, -5.2, -2.5, -1e-3, -1e-4, 3e-4, 2e-3, 1.0, 4.0, 5.2, 9.0):
        for asked in (-1e3, 1e3):
            told = np.array([[asked, 1e4, 0.0]])
            lower[:] = higher[:] = 0.0
            for at, torque in ((-step, lower), (step, higher)):
                add_motor_torques(motors, told, np.array([speed + at]), torque, slopes)
            add_motor_torques(motors, told, np.array([speed]), np.zeros(1), slopes)
            assert slopes[0] == pytest.approx((lower[0] - higher[0]) / (2.0 * step), rel=1e-5, abs=1e-6)
            if abs(speed) < NO_LOAD:
                assert used_of_limits(LIMITED, higher, np.array([speed + step])) == pytest.approx(1.0)


def test_a_brake_takes_no_current(unlimited: ScenarioRun) -> None:
    """Before time zero's speed law begins, and where a turn on the spot waits for its steering."""
    motor = Motor(stall_torque=50.0, no_load_speed=1.0)
    run = run_scenario(replace(SCENARIOS["point_turn"], lasts=14.0), replace(DESIGN, drive=WheelDrive(motor=motor)))
    waits = run.motion.times <= STEERS + PAUSES
    assert np.abs(run.torques("drive")[waits]).max() > 1e-3
    assert np.all(run.drive_power[waits] == 0.0)
    assert run.drive_power[~waits].max() > 0.0


def test_a_slope_asks_for_the_weights_component(unlimited: ScenarioRun) -> None:
    """Sum of torques / R (loaded) = M g sin a + f N: the tractive force is the tire's, the lever its radius."""
    run = unlimited
    total, angle = float(run.torques("drive")[-1].sum()), run.scenario.tilt.angle
    lever = DESIGN.wheel_radius
    resistance = run.scenario.tire.rolling_resistance * (run.loads[-1] @ (DESIGN.wheel_radius - run.deflections[-1]))
    weight = DESIGN.mass * DESIGN.gravity * math.sin(angle)
    assert total == pytest.approx(weight * lever + resistance, rel=0.01)
    assert run.met


def test_too_little_torque_rolls_back_and_enough_climbs(unlimited: ScenarioRun) -> None:
    need = float(unlimited.torques("drive")[-1].sum()) / len(DESIGN.legs)
    assert not climbing(WheelDrive(motor=Motor(torque_limit=0.95 * need))).met
    assert climbing(WheelDrive(motor=Motor(torque_limit=1.4 * need))).met


def test_motors_without_limits_drive_as_laws_do() -> None:
    by_law, by_motor = (run_scenario(SCENARIOS["straight"], replace(DESIGN, drive=d)) for d in (None, WheelDrive()))
    assert by_motor.place[-1, 0] == pytest.approx(by_law.place[-1, 0], rel=1e-3)
    assert energy_of_drives(by_motor) == pytest.approx(energy_of_drives(by_law), rel=0.02)
    held = run_scenario(replace(SCENARIOS["drop"], lasts=0.1), replace(DESIGN, drive=WheelDrive()))
    assert held.torques("drive").shape[1] == 6  # brakes


def lead(run: ScenarioRun) -> FloatArray:
    """By how much each wheel runs ahead of the ground, over the speed asked for (n, n_w) [-]."""
    axles = run.motion.rotations[:, run.wheel_bodies, :, 1]
    hubs = run.motion.velocities[:, run.wheel_bodies, :3]
    in_plane = hubs - np.sum(hubs * axles, axis=-1, keepdims=True) * axles
    return np.asarray((run.drive_speeds * DESIGN.wheel_radius - np.linalg.norm(in_plane, axis=-1)) / SPEED)


def test_the_slip_controller_bounds_slip() -> None:
    """At the step, where wheels at the speed asked for spin."""
    step = replace(SCENARIOS["step"], lasts=60.0)
    free, bounded = (
        run_scenario(step, replace(DESIGN, drive=WheelDrive(control=control)))
        for control in (DriveControl(), DriveControl(controller=Controller.SLIP, allowed_slip=0.1))
    )
    assert lead(bounded).max() < 0.15
    assert lead(free).max() > 0.5
    assert energy_of_drives(bounded) < energy_of_drives(free)


def test_shared_torque_follows_the_loads(unlimited: ScenarioRun) -> None:
    shared = climbing(WheelDrive(control=DriveControl(controller=Controller.SHARED)))

    def spread(run: ScenarioRun) -> float:
        ratio = run.torques("drive")[-1] / run.loads[-1]
        return float(np.ptp(ratio) / ratio.mean())

    assert shared.met
    assert spread(shared) < 0.05
    assert spread(unlimited) > 4.0 * spread(shared)
    speed = shared.motion.velocities[-1, 0, 0]
    assert speed == pytest.approx(SPEED, rel=0.03)  # the droop is made up for


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"torque_limit": 0.0}, "torque limit of the drives = 0 N m: must be > 0"),
        ({"efficiency": 1.5}, "must be <= 1"),
        ({"stall_torque": 2.0}, "are the two ends of one line"),
        ({"gain": math.nan}, "must be > 0"),
    ],
)
def test_bad_numbers_are_refused(numbers: dict[str, float], words: str) -> None:
    with pytest.raises(InputError) as caught:
        Motor(**numbers)
    assert words in str(caught.value)


def test_bad_controllers_are_refused() -> None:
    with pytest.raises(InputError, match="must lie between 0 and 1"):
        DriveControl(allowed_slip=1.0)
    with pytest.raises(InputError, match="must be > 0"):
        DriveControl(share_gain=-1.0)
    wheel = body("wheel", 5.0, (0.05, INERTIA, 0.05), (0.0, 0.0, 1.0))
    model = MultibodyModel(bodies=(wheel,), joints=(), gravity=(0.0, 0.0, 0.0))
    motors = (JointMotor(joint="axle", motor=Motor(), law=at_once(1.0)),)
    with pytest.raises(InputError, match="must be a hinge or a slider"):
        Vehicle(model=model, wheels=("wheel",), terrain=Plane(), motors=motors).joint_actions()
    with pytest.raises(InputError, match="must be one for each"):
        Vehicle(model=model, wheels=(), terrain=Plane(), motors=motors)
