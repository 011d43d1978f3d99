"""A path of the hub as a user writes it, its tasks, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.hub_travel import HubPlace, Way
from contracts.path_curve import PathCurve
from contracts.travel_curve import WRENCH
from workbench.commands.hub_path import off_the_ground
from workbench.commands.travel import check_ways
from workbench.questions.travel_start import APPROACH, asked_steps, hub_travel
from workbench.questions.travels import FRICTION, path_tasks
from workbench.study.hub_path import hub_path
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())
TEXT = "radial 10 mm, lateral 5 mm + leaning 2 deg, radial 8 mm, lateral 0 mm"


def test_its_places_are_absolute() -> None:
    leant = {Way.LATERAL: 0.005, Way.LEANING: math.radians(2.0)}
    assert hub_path(TEXT, 0.04) == ({Way.RADIAL: 0.01}, leant, {Way.RADIAL: 0.008}, {Way.LATERAL: 0.0})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("lateral 5 mm, radial 10 mm", "must begin with the radial way alone"),
        ("radial 10 mm + lateral 5 mm, lateral 0 mm", "must begin with the radial way alone"),
        ("radial 10 mm", "must begin with the radial way alone, and go on"),
        ("", "names no way"),
        ("radial 10 mm, sideways 5 mm", "'sideways 5 mm': names no way; give fore_aft"),
        ("radial 10 mm, lateral 5 mm + lateral 6 mm", "names lateral twice"),
        ("radial 10 mm, lateral 5 kg", "path: lateral = '5 kg': must be a length"),
        ("radial 10 mm, turning 0.1", "path: turning = '0.1':"),
        ("radial 10 mm, radial 50 mm", "within fe.max_deflection, 40 mm"),
        ("radial 10 mm, radial 0 mm", "must lie above zero"),
        ("radial 10 mm, lateral 5 m", "must not exceed 500 mm"),
        ("radial 10 mm, lateral nan mm", "path: lateral = 'nan mm'"),
        ("radial 10 mm, turning 91 deg", "must not exceed 90 deg"),
        ("radial 10 mm, lateral 400 mm, lateral -400 mm", "takes 1200 steps of 1 mm, more than 500"),
        ("radial 10 mm, lateral 5 mm, lateral 5 mm", "ends where it begins"),
    ],
)
def test_what_is_no_path_is_refused(text: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        hub_path(text, 0.04)
    assert message in str(error.value)


@pytest.mark.parametrize("model", ["fe", "ancf_wheel"])
def test_its_task_needs_no_curve_and_half_a_wheel_forwards(model: str) -> None:
    askew = {task.name: task for task in path_tasks(STUDY, model, hub_path(TEXT, 0.04), (15.0,))}
    along = {t.name: t for t in path_tasks(STUDY, model, hub_path("radial 9 mm, wind_up 5 deg", 0.04), (15.0,))}
    whole, half = askew[f"{model}_path_phi015"], along[f"{model}_path_phi015"]
    if model == "fe":
        assert (whole.needs, half.needs) == (("mesh_full",), ("mesh",))
        assert (askew.keys(), along.keys()) == ({"mesh_full", whole.name}, {"mesh", half.name})
        assert whole.cost > half.cost > 10.0
    else:
        assert (whole.needs, half.needs, len(askew)) == ((), (), 1)
        assert (whole.inputs["options"]["half_width"], half.inputs["options"]["half_width"]) == (False, True)
    assert whole.inputs["travel"]["friction"] == FRICTION
    travel = hub_travel(whole.inputs, {})
    assert travel.start == 0.01
    assert asked_steps(whole.inputs["travel"]) == len(travel.controls) > APPROACH
    assert travel.place(travel.controls[-1])[:3] == pytest.approx((0.0, 0.0, 0.008), abs=1e-15)


def test_a_path_is_asked_of_models_with_a_hub() -> None:
    with pytest.raises(InputError, match="has no hub"):
        path_tasks(STUDY, "brush", hub_path(TEXT, 0.04))


def test_several_ways_are_a_curve_each() -> None:
    assert check_ways(["lateral", "fore_aft", "lateral"]) == (Way.LATERAL, Way.FORE_AFT)
    assert check_ways(["lateral", "all"]) == tuple(Way)
    with pytest.raises(InputError, match="'up': is not known"):
        check_ways(["lateral", "up"])


@pytest.mark.parametrize(
    ("load", "told"),
    [
        ([0.0, 30.0, 80.0, 40.0], []),
        (
            [0.0, 30.0, 0.0, 0.0],
            ["fe 15 deg: the wheel is off the ground at 2 of its steps, first at radial 2 mm, leaning"],
        ),
    ],
    ids=["pressed", "leaves"],
)
def test_a_wheel_that_leaves_the_ground_is_told(load: list[float], told: list[str]) -> None:
    places = [
        HubPlace(),
        HubPlace(radial=2e-3),
        HubPlace(radial=2e-3, leaning=-0.86),
        HubPlace(radial=2e-3, leaning=-1.0),
    ]
    columns = dict.fromkeys(WRENCH, np.zeros(4)) | {"load_N": np.array(load)}
    curve = PathCurve(model="fe", orientation_deg=15.0, places=np.array(places), columns=columns, source="made up")
    found = off_the_ground(curve)
    assert len(found) == len(told)
    for one, start in zip(found, told, strict=True):
        assert one == f"{start} -49.3 deg"
