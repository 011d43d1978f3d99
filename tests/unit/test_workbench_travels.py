"""Tasks of a hub that is moved over the ground: which mesh, from which curve, with what friction; what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, write_curve
from contracts.errors import InputError
from contracts.hub_travel import Way
from workbench.execution.task import needed_for
from workbench.questions.model_curves import CURVE
from workbench.questions.travel_files import travel_curves
from workbench.questions.travel_start import APPROACH, approach, hub_travel
from workbench.questions.travels import FRICTION, STEPS, travel_tasks
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())
ORIENTATION = (15.0,)


@pytest.mark.parametrize("model", ["fe", "ancf_wheel"])
def test_forwards_half_a_wheel_will_do(model: str) -> None:
    tasks = {task.name: task for task in travel_tasks(STUDY, model, tuple(Way), 200.0, ORIENTATION)}
    for way in Way:
        task = tasks[f"{model}_{way}_phi015"]
        assert task.inputs["curve"] == f"{model}_phi015" in task.needs
        whole = way not in (Way.FORE_AFT, Way.RADIAL, Way.WIND_UP)
        if model == "fe":
            assert task.inputs["mesh"] == ("mesh_full" if whole else "mesh") == task.needs[0]
        else:
            assert task.inputs["options"]["half_width"] is not whole
    assert tasks[f"{model}_fore_aft_phi015"].inputs["travel"] == {
        "way": "fore_aft",
        "load": 200.0,
        "steps": list(STEPS[Way.FORE_AFT]),
        "friction": FRICTION,
    }


def test_a_whole_wheels_mesh_is_made_only_where_it_is_needed() -> None:
    names = [task.name for task in travel_tasks(STUDY, "fe", (Way.FORE_AFT,), 200.0, ORIENTATION)]
    assert names == ["mesh", "fe_phi015", "fe_fore_aft_phi015"]


def test_time_and_memory_are_foreseen() -> None:
    tasks = {task.name: task for task in travel_tasks(STUDY, "fe", tuple(Way), 200.0, ORIENTATION)}
    half, whole = tasks["fe_fore_aft_phi015"], tasks["fe_lateral_phi015"]
    assert 1.8 < whole.unknowns / half.unknowns < 2.0
    assert whole.cost > half.cost > 10.0
    assert half.memory > 1.3 * tasks["fe_phi015"].memory


@pytest.mark.parametrize("fe", [0.0, 0.4])
def test_friction_is_that_of_the_static_runs_then_of_the_ground(fe: float) -> None:
    ground = STUDY.ground.model_copy(update={"friction": 0.5})
    study = STUDY.model_copy(update={"ground": ground, "fe": STUDY.fe.model_copy(update={"friction": fe})})
    task = travel_tasks(study, "fe", (Way.FORE_AFT,), 200.0, ORIENTATION)[-1]
    assert task.inputs["travel"]["friction"] == (fe or 0.5)


def test_the_travel_starts_where_the_curve_bears_the_load(tmp_path: Path) -> None:
    d = np.linspace(0.0, 30e-3, 7)
    write_curve(StiffnessCurve(model="fe", orientation_deg=0.0, deflection=d, load=8e3 * d), tmp_path / CURVE)
    inputs = {"curve": "c", "travel": {"way": "turning", "load": 200.0, "steps": [0.01]}}
    found = hub_travel(inputs, {"c": tmp_path})
    assert (found.ways, found.start, found.legs[0].steps) == ((Way.TURNING,), pytest.approx(25e-3), (0.01,))
    assert approach(found.start)[-1] == found.start
    np.testing.assert_allclose(np.diff([0.0, *approach(found.start)]), found.start / APPROACH)
    with pytest.raises(InputError, match="lies outside the curve"):
        hub_travel({**inputs, "travel": inputs["travel"] | {"load": 300.0}}, {"c": tmp_path})


def test_a_run_that_ended_before_its_first_step_has_no_curve(tmp_path: Path) -> None:
    assert travel_curves("fe", (Way.LATERAL,), ORIENTATION, {"fe_lateral_phi015": tmp_path}) == []


@pytest.mark.parametrize(
    ("model", "load", "message"),
    [
        ("brush", 200.0, "has no hub"),
        *(("fe", load, "must lie between 0.1 N and fe.max_load, 320 N") for load in (0.0, -1.0, 1e-300, 321.0, 1e300)),
        ("ancf_wheel", float("nan"), "load = nan N: must lie between"),
        ("ancf_wheel", float("inf"), "load = inf N: must lie between"),
    ],
)
def test_what_cannot_be_moved_is_refused(model: str, load: float, message: str) -> None:
    with pytest.raises(InputError, match=message):
        travel_tasks(STUDY, model, (Way.LATERAL,), load, ORIENTATION)


def test_on_a_slope_it_is_not_moved() -> None:
    study = STUDY.model_copy(update={"fe": STUDY.fe.model_copy(update={"camber": 0.1})})
    with pytest.raises(InputError, match="level plane"):
        travel_tasks(study, "fe", (Way.LATERAL,), 200.0, ORIENTATION)


def test_only_what_a_task_needs_is_taken_of_a_graph() -> None:
    tasks = travel_tasks(STUDY, "fe", tuple(Way), 200.0, (0.0, 15.0))
    names = [task.name for task in needed_for("fe_lateral_phi015", tasks)]
    assert names == ["mesh", "mesh_full", "fe_phi015", "fe_lateral_phi015"]
