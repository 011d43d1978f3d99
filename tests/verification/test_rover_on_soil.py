"""The rover's wheels on cells of soil against the steady wheel of the bench, and the rover on soil.

Claims: a wheel driven over cells has pull, torque and sinkage of the steady wheel's integrals, rigid and flexible; the
rover's wheels carry its weight, leave ruts of their width, and the rear ones run in those of the front ones; on a slope
the rover slips as the bench says a wheel must that pulls as much; what the drives give is spent. References:
`soil.steady_wheel` (Wong and Reece's integrals, verified apart) and the balance of forces. Negative control: soil
without cohesion and friction does not carry the rover up.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.on_soil import on_soil
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario
from rover_dynamics.soil.field import SoilBed
from rover_dynamics.tires.brush_force import BESIDE
from soil.carcass import RIGID, Carcass
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil, steady_wheel
from tests.wheel_on_cells import driven

DING = soil_named("ding2011")
SOFT = Carcass(compliance=(0.0, 75e-6, 41e-6, 8e-6), load=198.0)
WHEEL = WheelOnSoil(radius=0.1425, width=0.12)
LOAD, GRAVITY = 198.0, 3.721


@pytest.fixture(scope="module")
def design() -> RoverDesign:
    return read_rover()


@pytest.mark.parametrize("slip", [0.05, 0.2, 0.4])
@pytest.mark.parametrize("carcass", [RIGID, SOFT], ids=["rigid", "flexible"])
def test_a_wheel_on_cells_is_the_steady_wheel(carcass: Carcass, slip: float) -> None:
    wheel = replace(WHEEL, carcass=carcass)
    bed = SoilBed(soil=DING, wheel=wheel, load=LOAD, gravity=GRAVITY, low=(-0.3, -0.2), high=(0.7, 0.2), lag=0.0)
    drive, steady = driven(bed, slip, way=0.45), steady_wheel(wheel, DING, LOAD, slip, GRAVITY)
    late = drive.way > 0.25
    assert drive.pull[late].mean() == pytest.approx(steady.drawbar_pull, abs=0.01 * LOAD)
    assert drive.torque[late].mean() == pytest.approx(steady.torque, rel=0.04)
    assert drive.height[late].mean() == pytest.approx(steady.hub_height, abs=5e-4)


def test_smaller_cells_shake_a_wheel_less() -> None:
    noise = []
    for cell in (0.02, 0.01, 0.005):
        bed = SoilBed(
            soil=DING, wheel=WHEEL, load=LOAD, gravity=GRAVITY, low=(-0.3, -0.2), high=(0.6, 0.2), cell=cell, lag=0.0
        )
        drive = driven(bed, 0.2)
        noise.append(float(drive.pull[drive.way > 0.25].std()))
    assert noise[0] > 2.0 * noise[1] > 4.0 * noise[2]


@pytest.fixture(scope="module")
def straight(design: RoverDesign) -> ScenarioRun:
    scenario = replace(SCENARIOS["straight"], lasts=20.0)
    return run_scenario(on_soil(scenario, DING, replace(WHEEL, carcass=SOFT)), design)


def test_the_wheels_carry_the_weight_and_leave_ruts(design: RoverDesign, straight: ScenarioRun) -> None:
    total = straight.loads.sum(axis=1)
    late = straight.motion.times > 5.0
    assert total[late].mean() == pytest.approx(design.mass * design.gravity, rel=2e-3)
    assert np.abs(straight.tractive[late].sum(axis=1).mean()) < 0.02 * design.mass * design.gravity
    ruts = straight.motion.ruts
    assert ruts is not None
    widths = (ruts.depth > 0.002).any(axis=0).sum() * 0.01
    assert widths == pytest.approx(2.0 * design.wheel_width, abs=0.045)
    spans = [float(np.ptp(straight.wheels[:, k, 0])) for k in range(6)]
    assert min(spans) > 0.3
    front, rear = straight.wheels[0, 0, 0], straight.wheels[-1, 4, 0]
    assert rear < front  # the rear wheels have not left the ruts that the middle ones drew
    assert straight.sinkages.max() < 0.025


def test_the_drives_give_what_the_bench_says(design: RoverDesign, straight: ScenarioRun) -> None:
    """Energy a metre of six wheels that pull nothing, less what the four in ruts are spared."""
    times = straight.motion.times
    late = times > 8.0
    given = np.trapezoid((straight.torques("drive") * straight.drive_speeds).sum(axis=1)[late], times[late])
    wheel = replace(WHEEL, carcass=SOFT)

    def pull(s: float) -> float:
        return steady_wheel(wheel, DING, LOAD, s, GRAVITY).drawbar_pull

    slip = brentq(pull, -0.05, 0.2)
    alone = 6.0 * steady_wheel(wheel, DING, LOAD, slip, GRAVITY).torque / (design.wheel_radius * (1.0 - slip))
    assert 0.75 * alone < given / float(np.ptp(straight.place[late, 0])) < alone


def test_on_a_slope_the_rover_slips_as_the_bench_says(design: RoverDesign) -> None:
    angle = math.radians(7.0)
    scenario = SCENARIOS["slope_up"]
    scenario = replace(scenario, tilt=replace(scenario.tilt, angle=angle), lasts=35.0)
    run = run_scenario(on_soil(scenario, DING, WHEEL), design)
    late = run.motion.times > 20.0
    pace = float(np.polyfit(run.motion.times[late], run.place[late, 0], 1)[0])
    slip = 1.0 - pace / float(run.spins[late].mean() * design.wheel_radius)
    load, wanted = design.static_load * math.cos(angle), design.static_load * math.sin(angle)

    def lacks(s: float) -> float:
        return steady_wheel(WHEEL, DING, load, s, design.gravity).drawbar_pull - wanted

    alone = brentq(lacks, 0.01, 0.5)
    assert 0.4 * alone < slip < 1.1 * alone  # four of six wheels run in ruts, which resist less
    slick = replace(DING, cohesion=0.0, friction_angle=math.radians(6.0))
    assert run_scenario(on_soil(replace(scenario, lasts=15.0), slick, WHEEL), design).place[-1, 0] < run.place[0, 0]


def test_a_wheel_up_to_its_axle_in_soil_or_beside_it_ends_the_motion(
    design: RoverDesign, straight: ScenarioRun
) -> None:
    motion, scenario = straight.motion, straight.scenario
    sunk, tires = motion.positions.copy(), motion.tires.copy()
    sunk[-2:, :, 2] -= 0.13
    tires[-3:, 1, 9] = BESIDE  # the mark of a wheel
    ends = {"front_left lies in the soil up to its axle": (2, {"positions": sunk})}
    ends["front_right slides off the field of soil"] = 3, {"tires": tires}
    for told, (rows, changed) in ends.items():
        moved = replace(motion, **changed)
        run = run_scenario(replace(scenario, ride=lambda asked, rover, moved=moved: moved), design)
        assert run.stopped is not None
        assert told in run.stopped
        assert f"at t = {motion.times[-rows]:.4g} s" in run.stopped
        assert len(run.motion.times) == len(motion.times) - rows
    assert run_scenario(replace(scenario, ride=lambda asked, rover: motion), design).stopped is None
