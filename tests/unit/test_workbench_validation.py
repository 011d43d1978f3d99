"""Validation uncertainty: its formulas by hand, what is asked of others' wheels, what a stale record decides."""

from __future__ import annotations

import math
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from contracts.published import published_table
from workbench.questions.kept import keep, kept
from workbench.questions.validation import cases
from workbench.questions.validation.cases import COMMAND, NAME, PublishedWheel, published_wheels, wheel_tasks
from workbench.questions.validation.question import VALIDATION, Validation
from workbench.questions.validation.uncertainty import Comparison, comparisons, input_effects
from workbench.report.page import page_environment
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study, read_study_table

STUDIES = built_in_study().parent
E3 = next(wheel for wheel in published_wheels() if wheel.name == "E3")


def found(wheel: PublishedWheel, solid: float = 0.0139, moved: float = 1.02) -> dict[str, Any]:
    """A record of meshes that converge with order 2 to ``solid`` at the last load, each input moving S by a factor."""
    loads = len(wheel.points)
    meshes = [[solid * (1.0 - 0.01 / f**2)] * loads for f in (1.0, 2.0, 3.0)]
    inputs = [[[solid * moved] * loads for _ in one.values] for one in wheel.inputs]
    return {
        "factors": [1.0, 2.0, 3.0],
        "unknowns": [10, 20, 30],
        "solid_m": meshes,
        "inputs_nominal_m": [solid] * loads,
        "inputs_m": inputs,
    }


@pytest.fixture
def studies(tmp_path: Path) -> Path:
    """The built-in study and the published wheels' in a folder of their own, without records."""
    for name in ("exomars.toml", "e3.toml", "amalia.toml", "amalia_fe.csv"):
        shutil.copy(STUDIES / name, tmp_path / name)
    return tmp_path


def study_with(studies: Path, wheel: PublishedWheel, numbers: dict[str, Any]) -> Study:
    path = studies / wheel.study
    keep(read_study(path), NAME, COMMAND, wheel_tasks(wheel, path), 60.0, numbers)
    return read_study(studies / "exomars.toml")


def answered(study: Study) -> Validation:
    results = VALIDATION.read(study, {})
    assert isinstance(results, Validation)
    return results


def test_the_uncertainty_is_the_root_of_the_squares() -> None:
    (c,) = comparisons(E3, found(E3))
    mesh = 1.25 * 0.01 / 9.0 * 0.0139  # order 2: the error of the finest mesh, times the factor of safety
    assert c.u_num == pytest.approx(0.5 * mesh, rel=1e-6)
    one = 0.5 * 0.02 / math.sqrt(3.0)
    assert c.u_input == pytest.approx(c.simulated * one * math.sqrt(len(E3.inputs)), rel=1e-9)
    assert c.u_data == pytest.approx(0.5 * 0.00016 / math.sqrt(3.0))
    assert c.u_val == pytest.approx(math.sqrt(c.u_num**2 + c.u_input**2 + c.u_data**2))
    assert c.error == pytest.approx(c.simulated - 0.01391)


def test_an_input_counts_the_nominal_value_among_its_ends() -> None:
    numbers = found(E3)
    numbers["inputs_m"][1] = [[0.0139 * 0.97], [0.0139 * 1.01]]
    effect = input_effects(E3, numbers)[1]
    assert list(effect.moves.values()) == pytest.approx([-0.03, 0.01])
    assert effect.standard == pytest.approx(0.02 / math.sqrt(3.0))
    assert input_effects(E3, numbers)[0].standard == pytest.approx(0.01 / math.sqrt(3.0))


@pytest.mark.parametrize(("solid", "verdict"), [(0.0139, "within"), (0.01455, "beyond one"), (0.0152, "beyond two")])
def test_the_verdict_weighs_the_error(solid: float, verdict: str) -> None:
    (c,) = comparisons(E3, found(E3, solid, moved=1.03 * 1.03))
    assert c.verdict == verdict


def test_without_a_stated_uncertainty_of_the_data_it_is_a_lower_bound() -> None:
    amalia = published_wheels()[0]
    assert all(c.u_data is None for c in comparisons(amalia, found(amalia)))
    c = Comparison(
        load=1.0, simulated=1.2, published=1.0, u_num=0.03, u_input=0.04, u_data=None,
        convergence=comparisons(E3, found(E3))[0].convergence,
    )  # fmt: skip
    assert c.u_val == pytest.approx(0.05)


def test_it_is_asked_where_a_record_lies_beside_the_study(studies: Path) -> None:
    alone = read_study(studies / "exomars.toml")
    assert not VALIDATION.applies(alone)
    study = study_with(studies, E3, found(E3))
    assert VALIDATION.applies(study)
    assert not VALIDATION.applies(read_study(studies / "amalia.toml"))
    (one,) = answered(study).wheels
    assert (one.wheel.name, one.state) == ("E3", "current")


@pytest.mark.parametrize("text", ["", "{}", '{"found": {}}'])
def test_a_damaged_record_is_told_before_anything_is_computed(studies: Path, text: str) -> None:
    study = study_with(studies, E3, found(E3))
    assert VALIDATION.applies(study)
    (studies / "e3.kept" / "validation.json").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="kept record"):
        VALIDATION.applies(study)


def test_a_difference_beyond_what_is_unknown_fails(studies: Path) -> None:
    study = study_with(studies, E3, found(E3, 0.0146))  # 3.6 times
    (check,) = VALIDATION.checks(study, answered(study))
    assert (check.id, check.status, check.role) == ("validation.e3", "fail", "finding")
    study = study_with(studies, E3, found(E3))
    assert VALIDATION.checks(study, answered(study))[0].status == "pass"


def test_a_record_of_another_study_decides_nothing(studies: Path) -> None:
    study = study_with(studies, E3, found(E3))
    path = studies / "e3.toml"
    path.write_text(path.read_text(encoding="utf-8").replace('"0.3 mm"', '"0.31 mm"'), encoding="utf-8")
    results = answered(study)
    assert results.wheels[0].state == "stale"
    assert VALIDATION.checks(study, results)[0].status == "undecided"


def test_the_page_says_it_in_words(studies: Path) -> None:
    study = study_with(studies, E3, found(E3))
    template = page_environment().get_template("validation/evidence.html.j2")
    text = template.render(results=answered(study), study=study, figures={})
    for words in (
        "cannot be told apart",
        "half a pitch apart: +2.0 %",
        "13.910 mm",
        "The record is current",
        "rolling",
    ):
        assert words in text, words
    results = answered(study)
    far = replace(results.wheels[0], comparisons=comparisons(E3, found(E3, 0.016)), state="stale")
    text = template.render(results=Validation(wheels=(far,)), study=study, figures={})
    assert "the model is wrong by about that much" in text
    assert "record is stale" in text


def test_every_wheel_has_points_and_inputs_that_its_study_has() -> None:
    assert {wheel.name for wheel in published_wheels()} == set(published_table("flexible_wheels").text("wheel"))
    for wheel in published_wheels():
        tasks = wheel_tasks(wheel, STUDIES / wheel.study)
        names = [task.name for task in tasks]
        assert len(names) == len(set(names))
        by_value: dict[str, str] = {}
        for task in tasks:
            name = task.name.removeprefix("mesh_")
            by_value[name] = by_value.get(name, "") + str(task.inputs)
        assert len(set(by_value.values())) == len(by_value)  # each value of an input is another wheel
        assert wheel.deflections[0] < wheel.points[0][1] <= wheel.points[-1][1] < wheel.deflections[-1]
        assert wheel.open


def test_an_input_that_the_study_does_not_have_is_told() -> None:
    table = read_study_table(STUDIES / "e3.toml")
    with pytest.raises(InputError, match="name a key that it has"):
        cases._changed(table, ["wheel", "tire", "colour"], "red")


def test_the_shipped_records_are_whole() -> None:
    for wheel in published_wheels():
        record = kept(read_study(STUDIES / wheel.study), NAME)
        assert record is not None
        assert len(comparisons(wheel, record.found)) == len(wheel.points)
        assert len(input_effects(wheel, record.found)) == len(wheel.inputs)
