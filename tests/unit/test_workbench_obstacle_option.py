"""``--obstacle``: the same study, tasks and results as [fe.obstacle] in the file, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from tests.end_to_end.small_study import said, tiny_study
from workbench.commands.obstacle import ObstacleChoice, obstacle_choice
from workbench.questions.curve_graph import stiffness_tasks
from workbench.study.reading import read_study, read_study_table, study_of


def written(folder: Path, ground: str = "") -> Path:
    path = folder / "study.toml"
    path.write_text(f"{tiny_study()}\n{ground}", encoding="utf-8")
    return path


@pytest.mark.parametrize("model", ["fe", "section", "ancf_wheel"])
@pytest.mark.parametrize(
    ("choice", "ground"),
    [
        (
            ObstacleChoice(shape="step", height="20 mm", edge_radius="4 mm", offset="-5 mm"),
            'shape = "step"\nheight = "20 mm"\nedge_radius = "4 mm"\nposition = "-5 mm"\n',
        ),
        (
            ObstacleChoice(shape="cleat", height="20 mm", width="10 mm"),
            'shape = "cleat"\nheight = "20 mm"\nwidth = "10 mm"\nedge_radius = "5 mm"\n',
        ),
        (
            ObstacleChoice(shape="half_round", height="20 mm"),
            'shape = "half_round_rock"\nradius = "20 mm"\n',
        ),
    ],
    ids=["step", "cleat", "half_round"],
)
def test_it_asks_for_the_tasks_of_the_studys_own_key(
    tmp_path: Path, model: str, choice: ObstacleChoice, ground: str
) -> None:
    plain = written(tmp_path)
    chosen = study_of(plain, choice.put_in(read_study_table(plain), model))
    tasks = stiffness_tasks(chosen, model, (0.0, 15.0))
    assert tasks != stiffness_tasks(read_study(plain), model, (0.0, 15.0))
    assert tasks == stiffness_tasks(read_study(written(tmp_path, f"[fe.obstacle]\n{ground}")), model, (0.0, 15.0))


def test_it_stands_in_place_of_the_studys_ground(tmp_path: Path) -> None:
    table = read_study_table(written(tmp_path, '[fe.obstacle]\nshape = "half_round_rock"\nradius = "9 mm"\n'))
    put = ObstacleChoice(shape="step", height="20 mm").put_in(table, "fe")
    assert put["fe"]["obstacle"] == {"shape": "step", "height": "20 mm", "edge_radius": "5 mm"}
    assert table["fe"]["obstacle"]["shape"] == "half_round_rock"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"shape": "wall"}, "'wall': is not known; give step, cleat, half_round"),
        ({"shape": "step"}, "--height: is missing: a step has it"),
        ({"shape": "cleat", "height": "20 mm"}, "--width: is missing"),
        ({"shape": "step", "height": "20 mm", "width": "9 mm"}, "--width = '9 mm': is not a size of a step"),
        ({"shape": "half_round", "height": "9 mm", "edge_radius": "9 mm"}, "--edge-radius = '9 mm': is not a size"),
        ({"shape": None, "height": "20 mm"}, "--height = '20 mm': is that of an obstacle; give --obstacle"),
    ],
)
def test_choices_without_sense_are_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as error:
        obstacle_choice(**given)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--height", "20 kg"], "fe.obstacle.height = '20 kg': must be a length"),
        (["--height", "1 mm"], "fe.obstacle.edge_radius = 5 mm: must not exceed the height"),
        (["--height", "20 mm", "--model", "brush"], "does not stand on what --obstacle says"),
        (["--height", "20 mm", "--travel", "lateral"], "is pressed on, not moved over"),
        (["--height", "20 mm", "--matrix"], "is pressed on, not moved over"),
    ],
)
def test_an_obstacle_that_cannot_be_ends_with_one_message(tmp_path: Path, arguments: list[str], message: str) -> None:
    written(tmp_path)
    ended = said("stiffness", "study.toml", "--obstacle", "step", *arguments, folder=tmp_path)
    assert (ended.returncode, message in " ".join(ended.stderr.split())) == (2, True), ended.stderr
