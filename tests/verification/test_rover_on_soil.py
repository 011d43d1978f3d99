"""The rover's wheels on cells of soil against the steady wheel of the bench, and the rover on soil.

Claims: a wheel driven over cells has pull, torque and sinkage of the steady wheel's integrals, rigid and flexible; the
rover's wheels carry its weight and leave ruts of their width; those behind are spared most of the work once they run in
the ruts of those before, after a metre; on a slope, all on fresh soil, the rover slips as the bench says a wheel must
that pulls as much, and as on ground that rises so; what the drives give is spent. References: `soil.steady_wheel` (Wong
and Reece's integrals, verified apart) and the balance of forces. Negative control: soil without cohesion and friction
does not carry the rover up.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from contracts.terrain import inclined_plane
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_terrain
from rover_dynamics.rover.scenarios.level_ground import drive_forward, straight_ahead
from rover_dynamics.rover.scenarios.on_soil import on_soil
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, Tilt, run_scenario
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
CONTACT = 0.09
"""To each side of a hub, at which a flexible wheel presses the soil [m]."""


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
    assert straight.sinkages.max() < 0.025


def test_the_drives_give_what_the_bench_says(design: RoverDesign, straight: ScenarioRun) -> None:
    """Energy a metre of six wheels that pull nothing, each on fresh soil."""
    ends = straight.wheels[:, ::2, 0]  # front, middle, rear of one side
    assert (ends[-1, 1:] + CONTACT < ends[0, :-1] - CONTACT).all()  # none has come to where another pressed the soil
    times = straight.motion.times
    late = times > 12.0
    given = np.trapezoid((straight.torques("drive") * straight.drive_speeds).sum(axis=1)[late], times[late])
    wheel = replace(WHEEL, carcass=SOFT)

    def pull(s: float) -> float:
        return steady_wheel(wheel, DING, LOAD, s, GRAVITY).drawbar_pull

    slip = brentq(pull, -0.05, 0.2)
    alone = 6.0 * steady_wheel(wheel, DING, LOAD, slip, GRAVITY).torque / (design.wheel_radius * (1.0 - slip))
    assert 0.85 * alone < given / float(np.ptp(straight.place[late, 0])) < alone


@pytest.mark.slow
def test_wheels_in_ruts_are_spared(design: RoverDesign) -> None:
    """Middle and rear wheels beside themselves on fresh soil, and the whole rover beside its first 0.4 m."""
    scenario = replace(SCENARIOS["straight"], lasts=55.0, actuators=drive_forward, path=straight_ahead(1.1))
    run = run_scenario(on_soil(scenario, DING, replace(WHEEL, carcass=SOFT)), design)
    times, torques = run.motion.times, run.torques("drive")
    fresh, ruts = (times > 15.0) & (times < 25.0), times > 45.0
    ends = run.wheels[:, ::2, 0]
    assert (ends[-1, 1:] - CONTACT > ends[0, :-1]).all()  # all of their contact is in ruts
    before, after = (torques[one, ::2].mean(axis=0) for one in (fresh, ruts))
    assert (after[1:] < 0.35 * before[1:]).all()
    assert after[0] > 0.7 * before[0]  # the front wheels press fresh soil all the way

    def a_metre(one: NDArray[np.bool_]) -> float:
        power = (torques * run.drive_speeds).sum(axis=1)[one]
        return float(np.trapezoid(power, times[one]) / np.ptp(run.place[one, 0]))

    assert 0.25 < a_metre(ruts) / a_metre(fresh) < 0.5


def slip_late(run: ScenarioRun, way: np.ndarray) -> float:
    """Over the last 15 s, of a way [m]."""
    late = run.motion.times > run.motion.times[-1] - 15.0
    pace = float(np.polyfit(run.motion.times[late], way[late], 1)[0])
    return 1.0 - pace / float(run.spins[late].mean() * run.design.wheel_radius)


def test_a_slope_of_the_ground_is_a_tilt_of_gravity(design: RoverDesign) -> None:
    angle = math.radians(7.0)
    scenario = replace(SCENARIOS["slope_up"], lasts=20.0)
    tilted = replace(scenario, tilt=replace(scenario.tilt, angle=angle))
    rising = on_terrain(replace(scenario, tilt=Tilt()), design, inclined_plane(angle), "a slope")
    soft = replace(WHEEL, carcass=SOFT)  # rigid wheels rock on this slope, sooner or later
    one, other = (run_scenario(on_soil(each, DING, soft), design) for each in (tilted, rising))
    along = np.hypot(other.place[:, 0] - other.place[0, 0], other.place[:, 2] - other.place[0, 2])
    assert slip_late(other, along) == pytest.approx(slip_late(one, one.place[:, 0]), abs=0.01)
    for name, within in (("loads", 2.0), ("tractive", 2.0), ("sinkages", 1e-3)):
        a, b = (getattr(run, name)[run.motion.times > 10.0].mean(axis=0) for run in (one, other))
        assert a == pytest.approx(b, abs=within), name


def test_on_a_slope_the_rover_slips_as_the_bench_says(design: RoverDesign) -> None:
    angle = math.radians(7.0)
    scenario = SCENARIOS["slope_up"]
    scenario = replace(scenario, tilt=replace(scenario.tilt, angle=angle), lasts=35.0)
    run = run_scenario(on_soil(scenario, DING, WHEEL), design)
    slip = slip_late(run, run.place[:, 0])
    load, wanted = design.static_load * math.cos(angle), design.static_load * math.sin(angle)

    def lacks(s: float) -> float:
        return steady_wheel(WHEEL, DING, load, s, design.gravity).drawbar_pull - wanted

    alone = brentq(lacks, 0.01, 0.5)
    ends = run.wheels[:, ::2, 0]
    assert (ends[-1, 1:] < ends[0, :-1] - 0.1).all()  # none runs in another's rut
    assert 0.7 * alone < slip < 1.1 * alone
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
