"""The way back as its task leaves it: set, energy of the loop, and no input of a task that does not ask for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, write_curve
from tests.end_to_end.small_study import tiny_study
from workbench.questions.fe.graph import fe_inputs, without_end, without_fields
from workbench.questions.fe.task import load_case
from workbench.questions.fe.unloading import UNLOADING, loop_energy, unloadings
from workbench.questions.study_graph import report_tasks
from workbench.study.model import Study
from workbench.study.reading import read_study

SET = 2e-3


def curve(deflection: list[float], load: list[float], *, partial: bool = False) -> StiffnessCurve:
    return StiffnessCurve(
        model="fe", orientation_deg=0.0, deflection=np.array(deflection), load=np.array(load), partial=partial
    )


THERE = curve([0.0, 5e-3, 10e-3], [0.0, 50.0, 100.0])


@pytest.fixture
def study(tmp_path: Path) -> Study:
    path = tmp_path / "tiny.toml"
    path.write_text(tiny_study().replace("[fe]\n", "[fe]\nunload = true\n"), encoding="utf-8")
    return read_study(path)


def test_the_loop_is_work_there_less_work_back() -> None:
    assert loop_energy(THERE, curve([SET, 10e-3], [0.0, 100.0])) == pytest.approx(0.5 - 0.4)
    assert loop_energy(THERE, THERE) == 0.0


def test_the_set_is_where_the_way_back_has_no_load(tmp_path: Path) -> None:
    write_curve(curve([SET, 10e-3], [0.0, 100.0]), tmp_path / UNLOADING)
    found = unloadings({0.0: THERE}, {"fe_phi000": tmp_path})[0.0]
    assert found.permanent_set == SET
    assert found.lost == pytest.approx(0.1)
    assert found.work == pytest.approx(0.5)
    assert found.curve.model == "fe_unloading"


def test_a_way_back_that_ended_early_has_no_set(tmp_path: Path) -> None:
    write_curve(curve([5e-3, 10e-3], [30.0, 100.0], partial=True), tmp_path / UNLOADING)
    found = unloadings({0.0: THERE}, {"fe_phi000": tmp_path})[0.0]
    assert found.permanent_set is None
    assert found.lost is None


def test_curves_without_a_way_back_have_none(tmp_path: Path) -> None:
    assert unloadings({0.0: THERE}, {"fe_phi000": tmp_path}) == {}


def test_only_the_curves_of_the_study_go_back(study: Study) -> None:
    inputs = fe_inputs(study, 0.0, [1e-3])
    assert load_case(inputs).unload
    for other in (without_fields(inputs), without_end(inputs)):
        assert "unload" not in other
        assert not load_case(other).unload
    asked = {task.name for task in report_tasks(study) if task.inputs.get("unload")}
    assert asked == {"fe_phi000"}
    plain = study.model_copy(update={"fe": study.fe.model_copy(update={"unload": False})})
    assert all("unload" not in task.inputs for task in report_tasks(plain))
