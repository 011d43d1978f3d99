"""``--obstacle``: the same study, tasks and results as [fe.obstacle] in the file, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError
from tests.end_to_end.small_study import said, tiny_study
from workbench.commands.obstacle import chosen_obstacle, on_obstacle
from workbench.questions.curve_graph import stiffness_tasks
from workbench.study.obstacle_words import obstacle_words
from workbench.study.reading import read_study, read_study_table, study_of


def written(folder: Path, ground: str = "") -> Path:
    path = folder / "study.toml"
    path.write_text(f"{tiny_study()}\n{ground}", encoding="utf-8")
    return path


@pytest.mark.parametrize("model", ["fe", "section", "ancf_wheel"])
@pytest.mark.parametrize(
    ("word", "sizes", "ground"),
    [
        (
            "step",
            {"height": "20 mm", "edge_radius": "4 mm", "offset": "-5 mm"},
            'shape = "step"\nheight = "20 mm"\nedge_radius = "4 mm"\nposition = "-5 mm"\n',
        ),
        (
            "cleat",
            {"height": "20 mm", "width": "10 mm"},
            'shape = "cleat"\nheight = "20 mm"\nwidth = "10 mm"\nedge_radius = "5 mm"\n',
        ),
        ("half_round", {"height": "20 mm"}, 'shape = "half_round_rock"\nradius = "20 mm"\n'),
    ],
    ids=["step", "cleat", "half_round"],
)
def test_it_asks_for_the_tasks_of_the_studys_own_key(
    tmp_path: Path, model: str, word: str, sizes: dict[str, str], ground: str
) -> None:
    plain, obstacle = written(tmp_path), chosen_obstacle(word, **sizes)
    assert obstacle is not None
    chosen = study_of(plain, on_obstacle(read_study_table(plain), obstacle, model))
    tasks = stiffness_tasks(chosen, model, (0.0, 15.0))
    assert tasks != stiffness_tasks(read_study(plain), model, (0.0, 15.0))
    assert tasks == stiffness_tasks(read_study(written(tmp_path, f"[fe.obstacle]\n{ground}")), model, (0.0, 15.0))


def test_it_stands_in_place_of_the_studys_ground(tmp_path: Path) -> None:
    table = read_study_table(written(tmp_path, '[fe.obstacle]\nshape = "half_round_rock"\nradius = "9 mm"\n'))
    step = {"shape": "step", "height": "20 mm", "edge_radius": "5 mm"}
    assert on_obstacle(table, step, "fe")["fe"]["obstacle"] == step == chosen_obstacle("step", height="20 mm")
    assert table["fe"]["obstacle"]["shape"] == "half_round_rock"
    assert chosen_obstacle(None, height=None) is None


@pytest.mark.parametrize(
    ("word", "sizes", "message"),
    [
        ("wall", {}, "'wall': is not known; give step, cleat, half_round"),
        ("step", {}, "height: is missing: a step has it"),
        ("cleat", {"height": "20 mm"}, "width: is missing"),
        ("step", {"height": "20 mm", "width": "9 mm"}, "width = '9 mm': is not a size of a step"),
        ("half_round", {"height": "9 mm", "edge_radius": "9 mm"}, "edge radius = '9 mm': is not a size"),
        (None, {"height": "20 mm"}, "height = '20 mm': is that of an obstacle; give --obstacle"),
    ],
)
def test_choices_without_sense_are_refused(word: str | None, sizes: dict[str, str], message: str) -> None:
    with pytest.raises(InputError) as error:
        chosen_obstacle(word, **sizes)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("text", "table"),
    [
        ("plane", {"shape": "plane"}),
        ("step 20 mm", {"shape": "step", "height": "20 mm", "edge_radius": "5 mm"}),
        ("cleat 20 mm x 12 mm", {"shape": "cleat", "height": "20 mm", "width": "12 mm", "edge_radius": "5 mm"}),
        ("half_round 20 mm", {"shape": "half_round_rock", "radius": "20 mm"}),
    ],
)
def test_a_ground_in_a_few_words(text: str, table: dict[str, str]) -> None:
    assert obstacle_words(text) == table


@pytest.mark.parametrize(
    "text", ["", "plane 2 mm", "step", "cleat 20 mm", "half_round 9 mm x 2 mm", "cleat 1 x 2 x 3", 7]
)
def test_words_that_are_no_ground_are_refused(text: object) -> None:
    with pytest.raises(InputError):
        obstacle_words(text)


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
