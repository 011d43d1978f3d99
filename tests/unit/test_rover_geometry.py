"""A rover that cannot be is refused when its file is read, one that is strange is told; the shipped one is neither."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError
from rover_dynamics.rover.rover_design import RoverDesign
from rover_dynamics.rover.rover_file import EXOMARS_ROVER, read_rover

SHIPPED = EXOMARS_ROVER.read_text(encoding="utf-8")
FRONT = "deployment = [0.6, 0.54, 0.28]\nsteering = [0.64, 0.6012, 0.2219]\ndrive = [0.64, 0.6012, 0.0]"
CENTRE = "deployment = [0.090, 0.540, 0.280]\nsteering = [0.0, 0.6012, 0.2219]\ndrive = [0.0, 0.6012, 0.0]"
BODY = "position = [-0.0202, 0.0, 0.43]"


def _read(folder: Path, old: str, new: str) -> RoverDesign:
    assert old in SHIPPED
    path = folder / "rover.toml"
    path.write_text(SHIPPED.replace(old, new, 1), encoding="utf-8")
    return read_rover(path)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            CENTRE,
            "deployment = [0.09, 0.54, 0.28]\nsteering = [0, 0, 0.2219]\ndrive = [0, 0, 0]",
            "wheels = center_left and center_right: overlap: of 0.285 m x 0.12 m, their centres are 0 m apart",
        ),
        (CENTRE, FRONT, "wheels = front_left and center_left: overlap"),
        ("drive = [0.0, 0.6012, 0.0]", "drive = [0.36, 0.6012, 0.0]", "0.28 m apart in plane and 0 m along y"),
        (
            BODY,
            "position = [-0.0202, 0.0, -3.4]",
            "height = -3.4 m: is the centre of mass of principal, below the ground",
        ),
        (BODY, "position = [-0.0202, 0.0, -0.15]", "which is 0.1425 m below the wheels' axles"),
        (BODY, "position = [-0.0202, 2.0, 0.43]", "x = -0.02664 m, y = 1.54 m: tips over on level ground"),
        (BODY, "position = [1.2, 0.0, 0.43]", "tips over on level ground: no loads that push"),
        (BODY, "position = [-1.2, 0.0, 0.43]", "tips over on level ground: no loads that push"),
        (BODY, "position = [-0.0202, 0.6, 0.43]", "tips over"),  # within the wheels' outline, but the rear bogie turns
        ("above_axle = 0.0", "above_axle = -0.1425", "lies outside the wheel, whose radius is 0.1425 m"),
        ("above_axle = 0.25", "above_axle = -1", "is the centre of mass of arm_front_left, below the ground"),
        ('name = "ExoMars rover, 23 bodies"', 'name = ""', "name = '': is empty"),
        ('name = "principal"', 'name = "  "', "is empty"),
    ],
)
def test_a_rover_that_cannot_be_is_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        _read(tmp_path, old, new)
    assert words in str(caught.value)
    assert str(tmp_path / "rover.toml") in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "drive = [0.0, 0.6012, 0.0]",
            "drive = [0.0, 0.6012, 0.5]",
            "wheel center_left is 0.5 m higher than wheel front_left",
        ),
        (
            "above_axle = 0.25",
            "above_axle = 1.0",
            "leg_bodies.arm.above_axle = 1 m lies 0.72 m beyond the leg's own hinges",
        ),
        ("position = [0.3200, 0.4705, 0.2160]", "position = [0.32, 0.0, 0.216]", "pivots bogie_left is on y = 0"),
        ("position = [0.32, 0.4705, 0.216]", "position = [0.32, -0.4705, 0.216]", "bodies pivot_left is on the right"),
    ],
)
def test_a_strange_rover_is_told(tmp_path: Path, old: str, new: str, words: str) -> None:
    (warning,) = _read(tmp_path, old, new).warnings
    assert warning.startswith(words)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (BODY, "position = [-0.0202, 0.35, 0.43]"),  # the left wheels carry most of it, all still push
        ("drive = [0.0, 0.6012, 0.0]", "drive = [0.35, 0.6012, 0.0]"),  # 5 mm apart
        ("drive = [0.0, 0.6012, 0.0]", "drive = [0.0, 0.6012, 0.014]"),
        ("above_axle = 0.0", "above_axle = 0.001"),
        (BODY, BODY),
    ],
)
def test_a_rover_that_can_be_is_read_without_a_word(tmp_path: Path, old: str, new: str) -> None:
    assert _read(tmp_path, old, new).warnings == ()
