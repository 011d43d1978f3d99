"""What a wheel stands on in the viewer: at the place where it touches, in its shape; and the file that says what.

Claim: a ring pressed on a cleat, a step, a half-round or leant ground is drawn touching it, nowhere in it. Negative
control: the same ring on level ground reaches a cleat's height deeper.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError
from tests.small_report_folder import write_small_report
from workbench.questions.fe.ground_file import GROUND_FILE, ground_text, read_ground
from workbench.study.obstacle_words import ground_words
from workbench.study.reading import built_in_study, read_study
from workbench.viewer.folder import read_folder
from workbench.viewer.ground import Ground
from workbench.viewer.results import Results
from workbench.viewer.stages import WheelStage

CLEAT = {"shape": "cleat", "height": 0.02, "width": 0.006, "edge_radius": 0.002, "position": 0.004, "yaw": 0.0}
STEP = {"shape": "step", "height": 0.02, "edge_radius": 0.005, "position": 0.03, "yaw": 0.0}
ROCK = {"shape": "half_round_rock", "radius": 0.02, "position": 0.0, "yaw": 0.3}
PLANE = {"shape": "plane"}


def stage_on(folder: Path, obstacle: dict[str, Any], camber: float = 0.0) -> WheelStage:
    """The small report's wheel, 0.14 m in radius, on something."""
    write_small_report(folder)
    (folder / "fields" / GROUND_FILE).write_text(ground_text(obstacle, camber), encoding="utf-8")
    return Results(read_folder(folder)).wheels["fe", 0.0]


def heights(stage: WheelStage, along: float) -> float:
    """Of the ground as drawn, at a place ahead of the hub in the middle plane [m]."""
    corners, _ = stage.ground(0)
    middle = corners.reshape(-1, 2, 3).mean(axis=1)
    return float(np.interp(along, middle[:, 0], middle[:, 2]))


@pytest.mark.parametrize("obstacle", [CLEAT, STEP], ids=["cleat", "step"])
def test_an_obstacle_is_drawn_where_the_wheel_touches_it(tmp_path: Path, obstacle: dict[str, Any]) -> None:
    """The ring has 48 flat sides, 18 mm long: the cleat, 6 mm wide, lies between the nodes."""
    stage = stage_on(tmp_path, obstacle)
    cleat = obstacle is CLEAT
    rim = math.sqrt(0.14**2 - 0.03**2) if not cleat else 0.14
    top = heights(stage, 0.004 if cleat else 0.06)
    assert heights(stage, -0.08) == pytest.approx(top - 0.02, abs=1e-6)
    if cleat:
        assert top == pytest.approx(-rim * math.cos(math.pi / 48), abs=1.5e-3)
    else:  # the face stands 30 mm ahead, and its edge is round: the wheel rests on the level ground behind it
        assert top > -rim
    assert stage.stands_on.words == f"on a {obstacle['shape']}"


def test_a_rock_lies_askew_and_a_leant_ground_is_level(tmp_path: Path) -> None:
    stage = stage_on(tmp_path / "rock", ROCK)
    corners, quads = stage.ground(0)
    assert quads.max() == len(corners) - 1
    highest = corners[corners[:, 2] > corners[:, 2].max() - 1e-5]
    np.testing.assert_allclose(highest @ np.array([math.cos(0.3), math.sin(0.3), 0.0]), 0.0, atol=1e-3)
    leant = stage_on(tmp_path / "leant", PLANE, camber=0.2)
    places = leant.places(0, leant.body)
    corners, _ = leant.ground(0)
    assert corners[:, 2] == pytest.approx(places[:, 2].min(), abs=1e-3)
    lowest = leant.body.places[np.argmin(places[:, 2])]
    assert lowest[1] == pytest.approx(0.05)  # the left side, which the ground is lifted to
    assert leant.stands_on.words == "camber 11.5°"


def test_level_ground_has_no_file_and_no_words(tmp_path: Path) -> None:
    write_small_report(tmp_path)
    stage = Results(read_folder(tmp_path)).wheels["fe", 0.0]
    assert stage.stands_on == Ground()
    corners, quads = stage.ground(0)
    assert (corners.shape, quads.shape, stage.stands_on.words) == ((4, 3), (1, 4), "")


def test_the_ground_of_a_study_in_words() -> None:
    fe = read_study(built_in_study()).fe
    assert ground_words(fe) == ""
    assert ground_words(fe.model_copy(update={"camber": 0.1})) == "plane: camber 5.72958 deg"


@pytest.mark.parametrize(
    "content",
    [
        *("{", "[]", "{}", '{"obstacle": 3, "camber_rad": 0}', '{"obstacle": {}, "camber_rad": 0}'),
        '{"obstacle": {"shape": "hole"}, "camber_rad": 0}',
        '{"obstacle": {"shape": "plane"}, "camber_rad": "x"}',
        '{"obstacle": {"shape": "plane"}, "camber_rad": 1e999}',
        json.dumps({"obstacle": CLEAT | {"height": -1.0}, "camber_rad": 0.0}),
        json.dumps({"obstacle": CLEAT | {"height": 1e300}, "camber_rad": 0.0}),
        json.dumps({"obstacle": {"shape": "step", "height": 0.02}, "camber_rad": 0.0}),
        json.dumps({"obstacle": {"shape": ["step"]}, "camber_rad": 0.0}),
    ],
)
def test_a_bad_ground_file_is_one_message(tmp_path: Path, content: str) -> None:
    path = tmp_path / GROUND_FILE
    path.write_text(ground_text(CLEAT, 0.1), encoding="utf-8")
    assert read_ground(path)[::2] == ("cleat", 0.1)
    path.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=r"ground file = .*ground\.json"):
        read_ground(path)
