"""Hub compliance: which runs, and what their loads say."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from workbench.questions.hub.question import HUB, HubRun, HubStudy, held_parts
from workbench.questions.study_graph import report_tasks
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

HERE = built_in_study().parent


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def test_parts_become_elastic_from_outside_to_inside(study: Study) -> None:
    assert held_parts(study) == (
        ("outer_hub", "cone", "impact_springs", "inner_hub"),
        ("cone", "impact_springs", "inner_hub"),
        ("impact_springs", "inner_hub"),
        ("inner_hub",),
        (),
    )
    mesh, *runs = HUB.tasks(study)
    assert mesh.inputs["options"]["parts"] == "all"
    assert [len(run.inputs["rigid_parts"]) for run in runs] == [4, 3, 2, 1, 0]
    assert len({run.key({"mesh_hub": "m"}) for run in runs}) == 5


def test_a_wheel_without_these_parts_has_no_such_topic(study: Study) -> None:
    bare = study.wheel.model_copy(update={"cone": None, "impact_springs": None, "inner_hub": None})
    assert HUB.applies(study)
    assert not HUB.applies(study.model_copy(update={"wheel": bare}))
    assert not HUB.applies(study.model_copy(update={"hub_study": None}))


def test_the_switch_takes_all_parts_into_the_mesh_and_holds_the_bore_only(study: Study) -> None:
    elastic = study.model_copy(update={"fe": study.fe.model_copy(update={"hub": "elastic"})})
    for chosen, parts, rigid in ((study, "flexible", 4), (elastic, "all", 0)):
        tasks = {task.name: task for task in report_tasks(chosen)}
        assert tasks["mesh"].inputs["options"]["parts"] == parts
        assert len(tasks["fe_phi000"].inputs["rigid_parts"]) == rigid
        assert len(tasks["fe_x2_phi015"].inputs["rigid_parts"]) == rigid


def _hub_study(loads: tuple[float, float]) -> HubStudy:
    runs = []
    for elastic, load in zip(((), ("outer_hub",)), loads, strict=True):
        curve = StiffnessCurve(
            model="fe", orientation_deg=15.0, deflection=np.array([0.0, 0.02]), load=np.array([0.0, load])
        )
        runs.append(HubRun(elastic=elastic, curve=curve, dofs=1))
    return HubStudy(orientation_deg=15.0, deflections=(0.02,), runs=tuple(runs))


def test_the_change_is_relative_to_the_rigid_hub(study: Study) -> None:
    for loads, change, status in (((160.0, 159.6), -0.0025, "pass"), ((160.0, 156.0), -0.025, "fail")):
        found = _hub_study(loads)
        assert found.change(found.runs[1], 0.02) == pytest.approx(change)
        (check,) = HUB.checks(study, found)
        assert (check.id, check.role, check.status) == ("fe.hub_compliance", "finding", status)
        assert check.value == pytest.approx(-change)
