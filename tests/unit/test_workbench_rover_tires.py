"""The rover on ANCF tires: what the wiring hands on, what it refuses, and a fold that ends a motion."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.errors import ConvergenceError, InputError
from contracts.terrain import Plane
from rover_dynamics.flexible.flexible_system import FlexibleSystem, Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, on_flexible_tires
from rover_dynamics.rover.rover_design import WheelDrive
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_terrain, touching_height
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.scenario_series import scenario_series
from rover_dynamics.vehicle.drive_control import Controller, DriveControl
from rover_dynamics.vehicle.motors import Motor
from workbench.questions.rover.tire_shapes import TireShapes
from workbench.questions.rover.tires import on_ancf_tires

DESIGN = read_rover()


@pytest.fixture(scope="module")
def held() -> ScenarioRun:
    """The rover at rest on its spokes, drives held."""
    short = replace(SCENARIOS["straight"], settles=4.0, lasts=0.1, every=0.05)
    return run_scenario(on_ancf_tires(short), DESIGN)


def test_six_tires_carry_the_rover(held: ScenarioRun) -> None:
    """Statics: the mean load is a sixth of the weight; the thesis' tire is 22.9 mm deep under it on a spoke."""
    assert held.stopped is None
    assert held.loads[-1].mean() == pytest.approx(DESIGN.static_load, rel=2e-3)
    assert held.deflections[-1].mean() == pytest.approx(22.9e-3, abs=0.5e-3)
    motion = held.motion
    assert isinstance(motion, FlexibleMotion)
    assert len(motion.vectors) == len(motion.rates) == len(motion.times) == 3  # the settling is left out of all
    series = scenario_series(held)
    assert (series.scenario, series.tire) == ("straight", "ancf")


def test_tires_turned_by_half_a_spoke_are_softer(held: ScenarioRun) -> None:
    short = replace(SCENARIOS["straight"], settles=4.0, lasts=0.1)
    between = run_scenario(on_ancf_tires(short, turned=np.pi / 4), DESIGN)
    assert between.deflections[-1].mean() > held.deflections[-1].mean() + 2e-3


def test_motors_turn_flexible_tires_as_laws_do() -> None:
    """Gain enough: as fast as by law; motors too weak to hold a wheel on its spoke keep their limit and let it roll."""
    short, speeds = replace(SCENARIOS["straight"], settles=4.0, lasts=3.0, every=0.25), {}
    for name, drive in (
        ("law", None),
        ("motor", WheelDrive()),
        ("weak", WheelDrive(motor=Motor(torque_limit=0.02))),
        ("shared", WheelDrive(control=DriveControl(controller=Controller.SHARED))),
    ):
        run = run_scenario(on_ancf_tires(short), replace(DESIGN, drive=drive))
        assert run.stopped is None
        speeds[name] = float(run.motion.velocities[-1, 0, 0])
        torques = run.torques("drive")
        assert torques.shape == (len(run.motion.times), 6)
        if name == "weak":
            assert np.abs(torques[run.motion.times > 0.0]).max() == pytest.approx(0.02, rel=1e-9)
    assert speeds["motor"] == pytest.approx(speeds["law"], rel=0.02)
    assert abs(speeds["weak"] / speeds["law"] - 1.0) > 0.5
    assert speeds["shared"] == pytest.approx(speeds["law"], rel=0.3)  # it lags while the speed still grows


def test_what_is_handed_on_and_what_is_left() -> None:
    drop = on_ancf_tires(SCENARIOS["drop"])
    assert (drop.height, drop.tire_model, drop.has_closed_forms) == (0.010, "ancf", False)
    assert on_ancf_tires(SCENARIOS["static"]).height == 0.0


def test_a_rover_with_other_wheels_is_refused() -> None:
    with pytest.raises(InputError, match="150 mm: is not that of the ANCF tire"):
        run_scenario(on_ancf_tires(SCENARIOS["straight"]), replace(DESIGN, wheel_radius=0.15))


def _shapes(held: ScenarioRun, squeeze: float, wheel: int = 3) -> tuple[TireShapes, Instant]:
    """The rover at rest, one tire squeezed flat along its axle in proportion."""
    scenario = on_ancf_tires(SCENARIOS["static"])
    vehicle = scenario.vehicle(DESIGN)
    tires = wheel_set(build_tire(thesis_preset()), Plane(), 6)
    flexible = on_flexible_tires(vehicle, tires)
    system = FlexibleSystem(flexible)
    now = system.at_rest(0.0)
    z = now.z.copy()
    z[wheel, :, 1] = squeeze * (z[wheel, :, 1] - now.hub.z[wheel, 0, 1]) + now.hub.z[wheel, 0, 1]
    return TireShapes(system, tires, vehicle.wheels), replace(now, z=z)


def test_a_folded_tire_ends_the_motion_and_is_named(held: ScenarioRun) -> None:
    """Negative control: the undeformed tires pass; a tire turned inside out is refused, with wheel, plate and load."""
    shapes, whole = _shapes(held, 1.0)
    for _ in range(5):
        shapes.watch(0.1, whole)
    shapes, inverted = _shapes(held, -1.0)
    shapes.steps = 4  # the plates are looked at every fifth step
    with pytest.raises(ConvergenceError, match=r"folds at t = 0\.1 s: plate \d+ \((rim|spoke), volume") as caught:
        shapes.watch(0.1, inverted)
    assert DESIGN.legs[3].name.replace("_", " ") in str(caught.value)
    assert "is inverted; lower the load" in str(caught.value)
    assert re.search(r"volume ratio -\S+, at (\d+) deg of the wheel\)", str(caught.value))


def test_a_stop_is_explained_by_a_tire_only_if_one_gives_way(held: ScenarioRun) -> None:
    stopped = ConvergenceError("no step converges", [])
    shapes, whole = _shapes(held, 1.0)
    shapes.watch(0.1, whole)
    said = str(shapes.explained(stopped))
    assert said.startswith("no step converges. No tire is near folding: least volume has plate")
    assert "folds" not in said
    shapes, thin = _shapes(held, 0.01)
    shapes.watch(0.1, thin)
    assert "a tire folds at t = 0.1 s, where no step converges" in str(shapes.explained(stopped))


def test_on_another_ground_the_first_tire_touches_as_on_level_ground() -> None:
    scenario = on_ancf_tires(SCENARIOS["straight"])
    raised = on_terrain(scenario, DESIGN, Plane(), "the same")
    assert raised.height == pytest.approx(touching_height(Plane(), DESIGN))
