"""From a study and its solid model's curves to the potential of its wheel."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, write_curve
from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, TravelCurve, write_travel
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.tires.wheel_potential import AHEAD, MOMENT, load_and_slope, raise_and_slope
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.model_curves import CURVE
from workbench.questions.models.wheel_brush import carcass_of
from workbench.questions.models.wheel_curves import curves_around, largest_between, on_solved_tires
from workbench.questions.models.wheel_tasks import (
    ROCK_RADIUS,
    between_steps,
    deep_tasks,
    orientations_to_solve,
    rock_name,
    rock_tasks,
    solved_tire,
    where_it_moves,
)
from workbench.questions.travel_start import TRAVEL
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.reading import built_in_study, read_study

STUDIES = built_in_study().parent


def curve(orientation: float) -> StiffnessCurve:
    """Stiffer by a tenth where a mirrored wheel stands on its position 0."""
    d = np.linspace(0.0, 40e-3, 9)
    load = 8000.0 * d * (1.0 + 0.1 * math.cos(math.radians(3.0 * orientation)))
    moment = 1200.0 * d * d * math.sin(math.radians(3.0 * orientation))
    columns = {MOMENT: moment, AHEAD: 0.0 * d}
    source = "made up"
    return StiffnessCurve(
        model="fe", orientation_deg=orientation, deflection=d, load=load, columns=columns, source=source
    )


def solved(study: Study, folder: Path) -> dict[str, Path]:
    folders = {}
    for one in orientations_to_solve(study):
        name = orientation_name("fe_deep", one)
        (folder / name).mkdir()
        write_curve(curve(one), folder / name / CURVE)
        folders[name] = folder / name
    return folders


@pytest.mark.parametrize(("name", "count"), [("exomars", 24), ("exomars_hoops", 13)])
def test_a_mirrored_wheel_is_solved_over_half_of_its_period(name: str, count: int, tmp_path: Path) -> None:
    study = read_study(STUDIES / f"{name}.toml")
    assert len(orientations_to_solve(study)) == count
    found = curves_around(solved_tire(study, "fe")[0], solved(study, tmp_path))
    assert [one.orientation_deg for one in found] == [5.0 * k for k in range(24)]
    for one in found:
        wanted = curve(one.orientation_deg or 0.0)
        np.testing.assert_allclose(one.load, wanted.load)
        np.testing.assert_allclose(one.columns[MOMENT], wanted.columns[MOMENT], atol=1e-9)
    own = {round(one): name for one, name in solved_tire(study, "fe")[0]["curves"]}
    assert own[65] == ("fe_deep_phi065" if count == 24 else "fe_deep_phi055")


def test_the_potential_knows_the_studys_grousers(tmp_path: Path) -> None:
    """Twelve, 3 mm high, the first at 0.97 degrees, 1 mm thick: sin of the tip's half angle is 0.5 / 145.5."""
    study = read_study(built_in_study())
    values, tasks = solved_tire(study, "fe")
    folders = solved(study, tmp_path)
    for way, one, name in values["travels"]:
        (tmp_path / name).mkdir()
        write_travel(travel(Way(way), one, 3e3 if way == "fore_aft" else 12e3), tmp_path / name / TRAVEL)
        folders[name] = tmp_path / name
    assert {name for _, name in values["curves"]} | {name for *_, name in values["travels"]} <= {t.name for t in tasks}
    driven = on_solved_tires(SCENARIOS["straight"], json.loads(json.dumps(values)), folders)
    wheel, settings = driven.settings.potential, driven.settings
    assert wheel is not None
    assert (driven.tire_model, driven.has_closed_forms, settings.lateral_ratio) == ("fe", False, pytest.approx(4.0))
    assert wheel.tips.half == pytest.approx(math.asin(0.5 / 145.5))
    assert raise_and_slope(wheel.tips, math.radians(30.97))[0] == pytest.approx(3e-3)
    assert raise_and_slope(wheel.tips, math.radians(15.0))[0] == 0.0
    assert load_and_slope(wheel, 20e-3, math.radians(15.0))[1] == pytest.approx(curve(15.0).load_at(20e-3), rel=1e-3)
    assert wheel.last == pytest.approx(37e-3, rel=1e-3)


def test_between_its_curves_a_tire_is_held_against_curves_solved_apart(tmp_path: Path) -> None:
    """Half a step off, eight of them; a curve 3 % off is found, one outside the loads is not looked at."""
    study = read_study(built_in_study())
    halves = between_steps(study)
    assert halves == [2.5, 17.5, 32.5, 47.5, 62.5, 77.5, 92.5, 107.5]
    values, folders = solved_tire(study, "fe")[0], solved(study, tmp_path)
    values["tips"]["height"] = 0.0  # the curves made up know no grousers
    apart = [curve(one) for one in halves]
    assert abs(largest_between(values, folders, apart, (20.0, 250.0)).difference) < 2e-3
    apart[1] = replace(apart[1], load=1.03 * apart[1].load)
    found = largest_between(values, folders, apart, (20.0, 250.0))
    assert (found.orientation_deg, found.difference) == (17.5, pytest.approx(1.0 / 1.03 - 1.0, abs=2e-3))
    assert largest_between(values, folders, apart, (900.0, 999.0)).difference == 0.0


def test_on_a_half_round_the_same_wheel_is_solved_under_names_of_its_own() -> None:
    study = read_study(built_in_study())
    plane = {task.name: task for task in solved_tire(study, "fe")[1]}
    mesh, *curves = rock_tasks(study, 250.0)
    assert mesh == plane["mesh"]
    assert [task.name for task in curves] == [rock_name(one) for one in where_it_moves(study)[::2]]
    assert not {task.name for task in curves} & set(plane)
    for task in curves:
        flat = plane[task.name.replace("rock", "deep")].inputs
        assert task.inputs["obstacle"] == {
            "shape": "half_round_rock",
            "radius": ROCK_RADIUS,
            "position": 0.0,
            "yaw": 0.0,
        }
        assert {name for name in flat if flat[name] != task.inputs[name]} == {"obstacle", "deflections", "max_load"}


def test_curves_of_other_ground_are_refused() -> None:
    study = read_study(built_in_study())
    leaning = study.model_copy(update={"fe": study.fe.model_copy(update={"camber": math.radians(5.0)})})
    with pytest.raises(InputError, match=r"ground of \[fe\] = plane, camber 5 deg: is not the level plane"):
        orientations_to_solve(leaning)


def travel(way: Way, orientation: float, stiffness: float) -> TravelCurve:
    held = np.array([-1.0, -1.0 - 1e-3 * stiffness])
    return TravelCurve(
        model="fe",
        way=way,
        orientation_deg=orientation,
        deflection=0.02,
        travel=np.array([0.0, 1e-3]),
        columns=dict.fromkeys(WRENCH, held),
        source="made up",
    )


def test_the_carcass_is_the_mean_over_orientations() -> None:
    stiffness = {Way.FORE_AFT: (2e3, 4e3), Way.LATERAL: (12e3, 14e3)}
    travels = [travel(way, 30.0 * k, s) for way, both in stiffness.items() for k, s in enumerate(both)]
    assert carcass_of(travels) == pytest.approx((3e3, 13e3))
    with pytest.raises(InputError, match="stiffness lateral of the wheel"):
        carcass_of(travels[:2])
    with pytest.raises(InputError, match="must be found at one orientation at least, and be > 0"):
        carcass_of([*travels, travel(Way.LATERAL, 60.0, -1.0)])


@pytest.mark.parametrize(("name", "at"), [("exomars", [0.0, 35.0, 70.0, 105.0]), ("exomars_hoops", [0, 20, 40, 60])])
def test_the_hub_is_moved_at_four_of_the_orientations_solved(name: str, at: list[float]) -> None:
    assert where_it_moves(read_study(STUDIES / f"{name}.toml")) == pytest.approx(at)


@pytest.mark.parametrize("model", ["fe", "ancf_wheel"])
def test_tires_curves_go_on_beyond_the_studys(model: str) -> None:
    """Up to 1.6 times 40 mm, which is less than 0.6 times the 111 mm between rim and hub; no load ends them."""
    study = read_study(built_in_study())
    tasks = {task.name: task for task in deep_tasks(study, model)}
    (own,) = (task for task in stiffness_tasks(study, model, (15.0,)) if task.name == f"{model}_phi015")
    deep = tasks[f"{model}_deep_phi015"].inputs
    asked = own.inputs["deflections"]
    assert deep["deflections"] == pytest.approx([*asked, 0.045, 0.05, 0.055])
    assert (deep["max_load"], deep["keep_points"]) == (1e6, False)
    assert len(tasks) == 24 + (model == "fe")


def test_a_hub_that_is_near_ends_them() -> None:
    study = read_study(STUDIES / "exomars_hoops.toml")
    fe = study.fe.model_copy(update={"max_deflection": 0.09})
    (deep,) = {
        tuple(t.inputs["deflections"])[-1] for t in deep_tasks(study.model_copy(update={"fe": fe}), "ancf_wheel")
    }
    assert deep == pytest.approx(0.09)
