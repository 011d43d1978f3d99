"""The rover's model: 23 bodies with the ground, 21 hinges, 27 degrees of freedom; actuators; bad descriptions."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from rover_dynamics.multibody.joint import JointKind
from rover_dynamics.multibody.motion_law import Hold, SpeedTrapezoid
from rover_dynamics.rover.rover import Actuators, build_rover, degrees_of_freedom, wheel_names
from rover_dynamics.rover.rover_file import read_rover

TABLES = tomllib.loads(Path("tests/data/thesis_tables.toml").read_text(encoding="utf-8"))
DESIGN = read_rover()


def test_counts_are_those_of_the_thesis() -> None:
    model = build_rover(DESIGN).model
    assert len(model.bodies) + 1 == 23  # with the ground
    assert len(model.joints) == 21
    assert all(joint.kind is JointKind.REVOLUTE for joint in model.joints)
    assert degrees_of_freedom(model) == 27
    assert sum(body.mass for body in model.bodies) == pytest.approx(320.0, abs=1e-9)


def test_masses_are_those_of_table_1() -> None:
    printed = sorted(row["mass"] for row in TABLES["bodies"] for _ in row["number"] if row["mass"] > 0)
    assert sorted(body.mass for body in build_rover(DESIGN).model.bodies) == pytest.approx(printed)


def test_wheels_stand_on_the_ground_under_their_legs() -> None:
    vehicle = build_rover(DESIGN, height=0.01)
    for leg, wheel in zip(DESIGN.legs, wheel_names(DESIGN), strict=True):
        body = vehicle.model.bodies[vehicle.model.number(wheel)]
        assert body.position == pytest.approx(np.add(leg.drive, [0.0, 0.0, DESIGN.wheel_radius + 0.01]))
    assert (vehicle.settings.wheel_radius, vehicle.settings.wheel_width) == (0.1425, 0.12)


def test_actuators_hold_move_and_load() -> None:
    idle = build_rover(DESIGN)
    assert len(idle.model.drives) == 12
    spin = {f"drive_{leg.name}": SpeedTrapezoid(speed=1.0, accelerates=1.0) for leg in DESIGN.legs}
    assert len(build_rover(DESIGN, actuators=Actuators(laws=spin)).model.drives) == 18
    loaded = build_rover(DESIGN, actuators=Actuators(torques={"steer_front_left": lambda t: t}))
    assert "steer_front_left" not in {drive.joint for drive in loaded.model.drives}
    assert [effort.joint for effort in loaded.efforts] == ["steer_front_left"]
    free = build_rover(DESIGN, actuators=Actuators(free=frozenset({"deploy_rear_left"})))
    assert len(free.model.drives) == 11


@pytest.mark.parametrize(
    ("actuators", "words"),
    [
        (Actuators(laws={"drive_middle": Hold()}), "'drive_middle': is not in the rover; it has: bogie_left"),
        (Actuators(laws={"drive_front_left": Hold()}, torques={"drive_front_left": lambda t: t}), "choose one of them"),
        (Actuators(laws={"steer_front_left": Hold()}, free=frozenset({"steer_front_left"})), "choose one of them"),
    ],
)
def test_bad_actuators_are_refused(actuators: Actuators, words: str) -> None:
    with pytest.raises(InputError) as caught:
        build_rover(DESIGN, actuators=actuators)
    assert words in str(caught.value)


def test_joints_need_their_bodies() -> None:
    legs = (replace(DESIGN.legs[0], carrier="pivot_front"), *DESIGN.legs[1:])
    with pytest.raises(InputError, match="joint 'deploy_front_left' = 'pivot_front': is not in the rover"):
        build_rover(replace(DESIGN, legs=legs))


def test_two_bodies_of_one_name_are_refused() -> None:
    with pytest.raises(InputError, match="'principal': is in the rover twice"):
        build_rover(replace(DESIGN, bodies=(*DESIGN.bodies, DESIGN.bodies[0])))


def test_a_body_without_mass_is_refused() -> None:
    weightless = (replace(DESIGN.bodies[0], mass=0.0), *DESIGN.bodies[1:])
    with pytest.raises(InputError, match="mass"):
        build_rover(replace(DESIGN, bodies=weightless))


def test_a_body_that_hangs_on_no_other_is_refused() -> None:
    design = read_rover()
    with pytest.raises(InputError, match="'pivot_rear': hangs on no other"):
        build_rover(replace(design, pivots=design.pivots[:-1]))
