"""The rover's file: what ships is Table I; a bad file gives one clear message."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import EXOMARS_ROVER, read_rover

SHIPPED = EXOMARS_ROVER.read_text(encoding="utf-8")


def test_the_rover_that_ships_weighs_320_kg() -> None:
    assert read_rover().mass == pytest.approx(320.0, abs=1e-9)


def test_the_rover_that_ships_stands_as_any_other_must(tmp_path: Path) -> None:
    """It is not asked each time it is read; as a user's file it is."""
    (tmp_path / "rover.toml").write_text(SHIPPED, encoding="utf-8")
    assert read_rover(tmp_path / "rover.toml") == read_rover()


def test_mirrored_rows_stand_on_both_sides() -> None:
    design = read_rover()
    left, right = (next(body for body in design.bodies if body.name == f"pivot_{side}") for side in ("left", "right"))
    assert left.position[1] == -right.position[1] == 0.4705
    assert left.position[::2] == right.position[::2]
    legs = {leg.name: leg for leg in design.legs}
    assert sorted(legs) == ["center_left", "center_right", "front_left", "front_right", "rear_left", "rear_right"]
    assert (legs["front_left"].carrier, legs["front_right"].carrier) == ("pivot_left", "pivot_right")
    assert legs["rear_left"].carrier == legs["rear_right"].carrier == "pivot_rear"
    assert legs["rear_right"].drive == (-0.72, -0.6012, 0.0)


def with_drive(text: str) -> str:
    return SHIPPED.replace('[[bodies]]\nname = "principal"', f'[drive]\n{text}\n\n[[bodies]]\nname = "principal"')


def test_motors_are_given_before_their_gear(tmp_path: Path) -> None:
    path = tmp_path / "rover.toml"
    text = "gear = 1000\nefficiency = 0.6\ntorque_limit = 0.04\nstall_torque = 0.08\nno_load_speed = 400\n"
    path.write_text(with_drive(text + 'controller = "slip"\nallowed_slip = 0.1'), encoding="utf-8")
    drive = read_rover(path).drive
    assert drive is not None
    motor = drive.motor
    assert (motor.torque_limit, motor.stall_torque, motor.efficiency) == pytest.approx((40.0, 80.0, 0.6))
    assert motor.no_load_speed == pytest.approx(0.4)
    assert (drive.control.controller.value, drive.control.allowed_slip) == ("slip", 0.1)
    assert read_rover().drive is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("controller = 'cruise'", "drive: controller = 'cruise': is not known; give one of speed, slip, shared"),
        ("allowed_slip = 0.1", "counts with controller = 'slip' only"),
        ("share_gain = 50", "counts with controller = 'shared' only"),
        ("torque_limit = 0", "drive.torque_limit"),
        ("stall_torque = 2", "drive: no_load_speed: is missing; stall_torque and no_load_speed are the two ends"),
        ("gear = 1000\ntorque_limit = -2", "drive: torque_limit = -2 N m: must be > 0"),
        ("efficiency = -0.5", "drive: efficiency = -0.5: must be > 0"),
        ("efficiency = 1.2", "drive.efficiency = 1.2: must lie between 0.001 and 1"),
        ("controller = 'slip'\nallowed_slip = 1", "drive.allowed_slip = 1: must lie between 0.001 and 0.999"),
        ("controller = 'shared'\ngain = 50", "gain = 50: counts with controller = 'speed' or 'slip' only"),
        ("power = 3", "drive: power = 3: is not a known key"),
        ("gear = 0", "drive.gear"),
        ("gear = true", "must be a number"),
    ],
)
def test_a_bad_drive_gives_one_clear_message(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "rover.toml"
    path.write_text(with_drive(text), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_rover(path)
    assert str(caught.value).startswith(str(path))
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("gravity = 3.711", "", "gravity: is missing"),
        ("gravity = 3.711", "gravity = 'Moon'", "gravity = 'Moon': is not known; give mars or earth"),
        ("gravity = 3.711", "gravity = nan", "must be finite"),
        ("gravity = 3.711", "gravity = true", "must be a number"),
        ("gravity = 3.711", "gravity = 3.711\ngravitation = 1", "gravitation = 1: is not a known key"),
        ("radius = 0.1425", "radius = 0.1425\ndiameter = 0.285", "wheel: diameter = 0.285: is not a known key"),
        ("inertia = [51.0, 65.0, 98.0]", "inertia = [51.0, 65.0]", "must be three finite numbers"),
        ("inertia = [51.0, 65.0, 98.0]", "inertia = 51.0", "must be three numbers"),
        ("inertia = [51.0, 65.0, 98.0]", "inertia = [51.0, 65.0, -98.0]", "must be greater than zero"),
        ("inertia = [51.0, 65.0, 98.0]", "inertia = [51.0, 65.0, 120.0]", "greater than the sum of the others"),
        ("axis = [0.0, 1.0, 0.0]", "axis = [0.0, 0.0, 0.0]", "axis = [0.0, 0.0, 0.0]: is no direction"),
        ("mirrored = true", "mirrored = 1", "must be true or false"),
        ("inertia = [51.0, 65.0, 98.0]", "inertia = [true, 65.0, 98.0]", "must be three finite numbers"),
        ("[leg_bodies.arm]", "[leg_bodies.elbow]", "leg_bodies: arm: is missing"),
        ("name =", "name", "is not valid TOML"),
        ("name =", "a." * 1000 + "a =", "has tables within tables, more than 20 deep"),
    ],
)
def test_a_bad_file_gives_one_clear_message(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in SHIPPED
    path = tmp_path / "rover.toml"
    path.write_text(SHIPPED.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_rover(path)
    assert words in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_rows_must_be_tables(tmp_path: Path) -> None:
    path = tmp_path / "rover.toml"
    path.write_text("legs = [1]\nname = 'x'\ngravity = 1.0\n[wheel]\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"legs\[0\] = 1: must be a table"):
        read_rover(path)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        read_rover(tmp_path / "none.toml")


def test_gravity_may_be_a_planet(tmp_path: Path) -> None:
    text = EXOMARS_ROVER.read_text(encoding="utf-8")
    for value, gravity in (('"earth"', 9.81), ('"mars"', 3.711), ("1.62", 1.62)):
        (tmp_path / "rover.toml").write_text(text.replace("gravity = 3.711", f"gravity = {value}"), encoding="utf-8")
        assert read_rover(tmp_path / "rover.toml").gravity == gravity
    for value, words in (('"moon"', "give mars or earth"), ("0.0", "must lie between"), ("-3.7", "must be > 0")):
        (tmp_path / "rover.toml").write_text(text.replace("gravity = 3.711", f"gravity = {value}"), encoding="utf-8")
        with pytest.raises(InputError, match=words):
            read_rover(tmp_path / "rover.toml")


def test_a_rover_needs_bodies_and_legs(tmp_path: Path) -> None:
    legs = SHIPPED[SHIPPED.index("[[legs]]") : SHIPPED.index("[leg_bodies.arm]")]
    (tmp_path / "rover.toml").write_text("legs = []\n" + SHIPPED.replace(legs, ""), encoding="utf-8")
    with pytest.raises(InputError, match="legs: must be one or more"):
        read_rover(tmp_path / "rover.toml")
