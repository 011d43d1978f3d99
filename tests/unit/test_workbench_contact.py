"""Contact in a study: what it may say, what the tasks get of it, and what the penalty study's loads mean."""

from __future__ import annotations

import math
import tomllib
from typing import Any

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from reference_fe.contact.obstacle import ContactMethod
from reference_fe.contact.obstacles import HalfRoundRock, Plane, StepEdge
from workbench.questions.contact.question import CONTACT, ContactRun, PenaltyStudy
from workbench.questions.fe.graph import fe_inputs
from workbench.questions.fe.ground import obstacle_of
from workbench.questions.fe.task import load_case
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def changed(**fe: Any) -> Study:
    whole = tomllib.loads(built_in_study().read_text(encoding="utf-8"))
    return Study.model_validate(whole | {"fe": whole["fe"] | fe})


def test_the_load_case_gets_what_the_study_says(study: Study) -> None:
    plain = load_case(fe_inputs(study, 15.0, [0.01]))
    assert (plain.obstacle, plain.friction, plain.camber_deg, plain.contact_stiffness) == (Plane(), 0.0, 0.0, 1e11)
    step = {"shape": "step", "height": "20 mm", "edge_radius": "3 mm", "position": "10 mm"}
    other = changed(obstacle=step, friction=0.4, contact_stiffness="auto", contact_method="augmented_lagrangian")
    case = load_case(fe_inputs(other, 15.0, [0.01]))
    assert case.obstacle == StepEdge(height=0.02, edge_radius=0.003, position=0.01)
    assert (case.friction, case.contact_stiffness) == (0.4, None)
    assert case.contact_method is ContactMethod.AUGMENTED_LAGRANGIAN


def test_yaw_is_turned_into_degrees() -> None:
    rock = obstacle_of({"shape": "half_round_rock", "radius": 0.03, "position": 0.0, "yaw": math.radians(30.0)})
    assert isinstance(rock, HalfRoundRock)
    assert (rock.radius, rock.yaw_deg) == (0.03, pytest.approx(30.0))


@pytest.mark.parametrize(
    "wrong",
    [
        {"obstacle": {"shape": "hole"}},
        {"obstacle": {"shape": "step", "height": "20 mm"}},
        {"friction": -0.1},
        {"contact_stiffness": "some"},
        {"contact_method": "magic"},
    ],
)
def test_impossible_contacts_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        changed(**wrong)


def test_the_penalty_study_differs_in_the_contact_only(study: Study) -> None:
    mesh, *runs = CONTACT.tasks(study)
    assert [run.needs for run in runs] == [(mesh.name,)] * 4
    assert [run.inputs["contact_stiffness"] for run in runs] == pytest.approx([1e10, 1e11, 1e12, 1e11])
    assert [run.inputs["inner_contact_stiffness"] for run in runs] == pytest.approx([1e10, 1e11, 1e12, 1e11])
    assert load_case(runs[0].inputs).inner_contact_stiffness == pytest.approx(1e10)
    assert [run.inputs["contact_method"] for run in runs] == [*["penalty"] * 3, "augmented_lagrangian"]
    assert not CONTACT.applies(study.model_copy(update={"penalty_study": None}))
    assert not CONTACT.applies(changed(contact_stiffness="auto"))


@pytest.mark.parametrize(
    ("loads", "end", "status"),
    [
        ((95.0, 99.8, 99.9, 100.0), 0.01, "pass"),
        ((99.0, 99.0, 99.9, 100.0), 0.01, "fail"),
        ((99.0,) * 4, 0.009, "error"),
    ],
)
@pytest.mark.parametrize("depth", [0.9e-6, 1.1e-6])
def test_the_check_holds_the_loads_against_the_augmented_lagrangian(
    study: Study, loads: tuple[float, ...], end: float, status: str, depth: float
) -> None:
    runs = []
    for name, load in zip(("0.1", "1", "10", "augmented_lagrangian"), loads, strict=True):
        curve = StiffnessCurve(
            model="fe",
            orientation_deg=15.0,
            deflection=np.array([0.0, end]),
            load=np.array([0.0, load]),
            columns={"penetration_m": np.array([0.0, depth])},
        )
        runs.append(ContactRun(name=name, stiffness=1e11, curve=curve))
    found = PenaltyStudy(orientation_deg=15.0, deflection=0.01, runs=tuple(runs))
    (check,) = CONTACT.checks(study, found)
    assert (check.id, check.role, check.status) == ("fe.penalty_study", "gate", status)
