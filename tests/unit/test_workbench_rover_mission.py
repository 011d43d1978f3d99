"""The mission on every kind of tire: tasks, what a run's result becomes, checks, what the section says."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ancf_reduced.tire.preset import thesis_preset
from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.execution.result_files import read_result, write_result
from workbench.execution.task import task_keys
from workbench.questions.kept import Kept
from workbench.questions.models.between import Between
from workbench.questions.rover.tires import DISSIPATION, AncfRide
from workbench.questions.rover_ancf.runs import fitted_run
from workbench.questions.rover_mission.graph import MISSION_TIRES, mission_task_name, mission_tasks
from workbench.questions.rover_mission.question import ROVER_MISSION, HeldMission
from workbench.questions.rover_mission.requirements import MISSION, plainly, tightest
from workbench.questions.rover_mission.results import WheelYield, found_of, mission_of, wheel_yield
from workbench.questions.rover_mission.task import SPARE, _records, drive_mission
from workbench.report.page import page_environment
from workbench.study.model_parameters import rover_on_brush
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())
SLIP = {"quantity": "slip and drift on 25 degrees", "value": 0.03, "unit": "-", "limit": 0.1, "at_least": False}


def run(tire: str, scenario: str, **values: Any) -> dict[str, Any]:
    """A result of a task, met unless said otherwise."""
    return {
        "scenario": scenario,
        "tire": tire,
        "title": scenario,
        "met": True,
        "stopped": None,
        "outcomes": [SLIP],
        "ends": None,
        **{"torque_Nm": 20.0, "power_W": 10.0, "energy_J": 100.0, "way_m": 0.3},
        "loads": [[0.0, 0.0, 200.0], [3.0, 0.05, 260.0], [6.0, 0.1, 310.0]],
        **values,
    }


def held(runs: list[dict[str, Any]], wheel: WheelYield | None = None, state: Any = "current") -> HeldMission:
    on_fe = runs[0]["tire"] == "fe"
    between = {"fe": Between(17.5, 0.005, -0.023)} if on_fe else {}
    rock = Between(15.0, 0.03, 0.032) if on_fe else None
    found = json.loads(json.dumps(found_of(runs, wheel, between, rock)))
    record = Kept(
        command="make mission", inputs="", sources="", date="2026-11-27T10:00", machine="", wall_s=60.0, found=found
    )
    return HeldMission(record=record, state=state, mission=mission_of(found))


def test_every_requirement_on_every_tire_behind_what_it_needs() -> None:
    tasks = mission_tasks(STUDY)
    names = [task.name for task in tasks]
    driven = [mission_task_name(tire, scenario) for tire in MISSION_TIRES for scenario in MISSION]
    assert [name for name in names if name.startswith("mission_")] == driven
    for k, task in enumerate(tasks):
        assert set(task.needs) <= set(names[:k])
    by_name = {task.name: task for task in tasks}
    assert sum(need.startswith("fe_deep_") for need in by_name["mission_fe_step"].needs) == 24
    assert by_name["mission_ancf_wheel_step"].inputs["confirms"] == "mission_fe_step"
    assert by_name["mission_brush_step"].needs == ()
    alone = {task.name: task for task in mission_tasks(STUDY, ["ancf_wheel"])}
    assert alone["mission_ancf_wheel_step"].inputs["confirms"] is None
    with pytest.raises(InputError, match="'wood': is not known; give of rigid, brush, fe, ancf_wheel, ancf"):
        mission_tasks(STUDY, ["wood"])
    amalia = read_study(built_in_study().parent / "amalia.toml")
    with pytest.raises(InputError, match=r"is not that of the rover's wheels|\[brush\]: is not in the study"):
        mission_tasks(amalia, ["brush"])


def test_the_ground_and_the_brush_reach_every_task() -> None:
    def keys(study: Any) -> dict[str, str]:
        return task_keys(mission_tasks(study, ["rigid", "brush"]))

    before = keys(STUDY)
    icy = keys(STUDY.model_copy(update={"ground": STUDY.ground.model_copy(update={"friction": 0.3})}))
    assert all(icy[name] != key for name, key in before.items())


def test_a_task_searches_and_tries_another_ones_torque(tmp_path: Path) -> None:
    """The turn on the spot, the shortest search; then with that torque, and with none found."""
    base: dict[str, Any] = {"wheel": None, "ancf": None, **rover_on_brush(STUDY), "scenario": "slope_across"}
    (tmp_path / "a").mkdir()
    searched = base | {"tire": "brush", "searched": True, "confirms": None}
    assert drive_mission(searched, {}, tmp_path / "a", lambda fraction: None) > 0
    found = read_result(tmp_path / "a")
    assert found["met"]
    least = found["smallest_torque"]
    assert least["torque_Nm"] < found["torque_Nm"]
    assert least["energy_J"] > 0.0
    assert found["smallest_friction"] == pytest.approx(0.466, abs=0.02)  # tan 25 degrees: it holds or slides down
    tried = base | {"tire": "rigid", "searched": False, "confirms": "other"}
    for other, told in (({"smallest_torque": {"torque_Nm": 5.0 / SPARE}}, True), ({}, None)):
        write_result(tmp_path, other)
        (tmp_path / "b").mkdir(exist_ok=True)
        drive_mission(tried, {"other": tmp_path}, tmp_path / "b", lambda fraction: None)
        assert read_result(tmp_path / "b")["confirmed"] is told


def test_a_run_beyond_the_wheels_yield_is_not_met() -> None:
    strong, weak = WheelYield(load=400.0, orientation_deg=15.0, part="tire"), replace_load(300.0)
    assert held([run("fe", "step")], strong).mission.cells["fe", "step"].decided == "met"
    cell = held([run("fe", "step")], weak).mission.cells["fe", "step"]
    assert (cell.decided, cell.cause, cell.time, cell.way) == ("not met", "strength", 6.0, 0.1)
    assert cell.words == "ended by the wheel's strength at 6 s, after 0.10 m: 310 N, beyond first yield (outer springs)"
    unknown = WheelYield(load=300.0, orientation_deg=0.0, part=None)
    assert held([run("fe", "step")], unknown).mission.cells["fe", "step"].decided == "met"


def test_only_the_studys_own_wheel_yields_as_it_does() -> None:
    """Other tires press on the ground otherwise; a run that stopped behind the first yield missed it before."""
    weak, ends = replace_load(300.0), {"cause": "wheel", "time": 9.0, "way": 0.2}
    runs = [run(tire, "step") for tire in ("rigid", "brush", "ancf", "ancf_wheel")]
    runs.append(run("fe", "step", met=False, outcomes=[], ends=ends, stopped="pressed deep at t = 9 s: its curves end"))
    cells = held(runs, weak).mission.cells
    decided = {tire: cells[tire, "step"].decided for tire in ("rigid", "brush", "ancf", "ancf_wheel", "fe")}
    assert decided == {"rigid": "met", "brush": "met", "ancf": "met", "ancf_wheel": "not met", "fe": "not met"}
    assert {cells[tire, "step"].cause for tire in ("ancf_wheel", "fe")} == {"strength"}
    assert held(runs[-1:], replace_load(400.0)).mission.cells["fe", "step"].decided == "undecided"


def test_the_heaviest_load_is_kept_to_its_digits() -> None:
    times, loads = np.arange(5.0), np.array([200.0, 201.0, 300.0, 302.0, 250.0])
    wanted = [[0.0, 0.0, 200.0], [2.0, 0.2, 300.0], [3.0, 0.3, 302.0]]
    np.testing.assert_allclose(_records(times, 0.1 * times, loads), wanted)


def test_a_friction_below_which_nothing_was_tried_is_at_most() -> None:
    for friction, told in ((0.02, "≤ 0.020"), (0.0229, "≤ 0.023"), (0.469, "0.469"), (None, "")):
        cell = held([run("brush", "point_turn", smallest_friction=friction)]).mission.cells["brush", "point_turn"]
        assert cell.least_friction == told


def replace_load(load: float) -> WheelYield:
    return WheelYield(load=load, orientation_deg=15.0, part="outer_springs")


def test_what_ends_a_run_is_told_with_time_and_place() -> None:
    ends = {"cause": "friction", "time": 8.25, "way": 0.125}
    missed = dict(SLIP, value=0.5)
    runs = [
        run("brush", "slope_up", met=False, outcomes=[missed], ends=ends),
        run("fe", "slope_up", met=False, outcomes=[], ends=dict(ends, cause="computation"), stopped="no step"),
        run("ancf", "slope_up", met=False, outcomes=[], stopped="a tire folds at t = -4.7 s"),
    ]
    cells = held(runs).mission.cells
    assert cells["brush", "slope_up"].words == "ended by friction at 8.25 s, after 0.12 m"
    assert [one.decided for one in cells.values()] == ["not met", "undecided", "undecided"]
    assert cells["ancf", "slope_up"].words == "stops before it sets out: a tire folds"
    folds = run("ancf", "step", met=False, outcomes=[], ends=dict(ends, cause="wheel"), stopped="it folds at t = 13 s")
    assert held([folds]).mission.cells["ancf", "step"].decided == "undecided"


def test_checks_count_requirements_and_a_stale_record_decides_nothing() -> None:
    runs = [run("fe", scenario) for scenario in MISSION]
    runs += [run("ancf_wheel", s, confirmed=s != "step") for s in MISSION]
    runs += [run("brush", s, met=False, ends={"cause": "friction", "time": 1.0, "way": 0.1}) for s in MISSION]
    runs += [run("ancf", s, met=s != "step") for s in MISSION]
    checks = {check.id: check for check in ROVER_MISSION.checks(STUDY, held(runs))}
    assert {id: check.status for id, check in checks.items()} == {
        "rover_mission.fe": "pass",
        "rover_mission.ancf_wheel": "pass",
        "rover_mission.brush": "fail",
        "rover_mission.ancf": "undecided",
        "rover_mission.torque": "fail",
        "rover_mission.between_fe": "fail",
        "rover_mission.rock": "pass",
    }
    assert checks["rover_mission.torque"].value == pytest.approx(5.0 / 6.0)
    assert {check.role for check in checks.values()} == {"finding"}
    stale = ROVER_MISSION.checks(STUDY, held(runs, state="stale"))
    assert {check.status for check in stale} == {"undecided"}


def test_the_wheels_yield_is_the_smallest_of_all_orientations() -> None:
    d = np.linspace(0.0, 0.05, 6)

    def curve(orientation: float, stress: float) -> StiffnessCurve:
        columns = {"max_von_mises_tire_Pa": stress * d / d[-1]}
        return StiffnessCurve(
            model="fe", orientation_deg=orientation, deflection=d, load=8e3 * d, source="made up", columns=columns
        )

    found = wheel_yield([curve(0.0, 5e8), curve(15.0, 2e9), curve(30.0, 1.5e9)], {"tire": 1e9})
    assert (found.load, found.orientation_deg, found.part) == (pytest.approx(200.0), 15.0, "tire")
    whole = wheel_yield([curve(0.0, 5e8), curve(15.0, 6e8)], {"tire": 1e9})
    assert (whole.load, whole.part) == (pytest.approx(400.0), None)


def test_the_section_tells_every_cell_and_the_searches() -> None:
    ends = {"cause": "friction", "time": 8.25, "way": 0.125}
    least = {"torque_Nm": 24.8, "power_W": 12.0, "energy_J": 727.0, "way_m": 2.5}
    runs = [run("brush", "step", smallest_torque=least, smallest_friction=0.576)]
    runs += [run("fe", "step", met=False, ends=ends, outcomes=[dict(SLIP, value=0.5)]), run("ancf_wheel", "step")]
    environment, results = page_environment(), held(runs, replace_load(280.0), state="older sources")
    values = {"results": results, "figures": {}, "series": {}}
    short, long = (
        environment.get_template(f"rover_mission/{n}.html.j2").render(values) for n in ("section", "evidence")
    )
    for words in (
        "24.8 N m",
        "727 J",
        "0.576",
        "ended by friction at 8.25 s",
        "older sources",
        "280 N",
        "make mission",
    ):
        assert words in short, words
    assert "beyond first yield (outer springs)" in long
    assert "333 J/m" in long


def test_a_fitted_run_has_the_fits_contact() -> None:
    fit = replace(thesis_preset(), contact_damping="hunt_crossley")
    scenario = fitted_run("rocks", fit, read_rover())
    assert isinstance(scenario.ride, AncfRide)
    law = scenario.ride.law
    assert (scenario.name, law.stiffness, law.damping, law.dissipation) == ("rocks_fitted", 1000.0, 0.0, DISSIPATION)
    assert "random rocks" in scenario.title
    assert (scenario.friction, scenario.ride.on_ground(scenario).friction) == (None, 0.6)
    icy = fitted_run("slope_down", thesis_preset(), read_rover(), friction=0.1)
    assert isinstance(icy.ride, AncfRide)
    assert icy.ride.on_ground(icy).friction == 0.1


@pytest.mark.parametrize(
    ("stopped", "told"),
    [
        (
            "a tire folds at t = 13 s: plate 6 (spoke, volume ratio -0.0027) of wheel rear right, which carries 266 N, "
            "is inverted; lower the load",
            "stops at 13 s: a spoke of the rear right wheel folds at 266 N",
        ),
        (
            "250 N: a tire folds at t = -4.67374 s, where no step converges: plate 5 (rim, volume ratio 4.3e-07) of "
            "wheel rear left, which carries 396 N, gives way; lower the load",
            "stops before it sets out: a rim of the rear left wheel folds at 396 N",
        ),
        (
            "the rover does not stand: no equilibrium: asked for a mean wheel load of 523 N, found up to 262 N "
            "(261 N on wheel front right, which carries most); beyond, a tire folds; least volume has plate 5 (spoke)",
            "does not stand: 523 N a wheel asked for, up to 262 N found",
        ),
        ("motion on flexible tires stopped at t = 3 s of 9 s: no step", "stops at 3 s: no step converges there"),
        ("explicit motion broke down at 0.34 s with a step of 3e-4 s: plates fold (x)", "stops at 0.34 s: plates fold"),
        ("no step converges; try another. No tire is near folding", "ended early: no step converges"),
    ],
)
def test_why_a_run_stopped_is_told_without_the_solvers_words(stopped: str, told: str) -> None:
    assert plainly(stopped) == told


def test_what_decides_is_what_is_not_met_or_nearest_to_its_limit() -> None:
    def one(value: float, limit: float, *, at_least: bool = True) -> Outcome:
        return Outcome(quantity=f"{value:g}", value=value, unit="-", limit=limit, at_least=at_least)

    counted, wide, near = one(6.0, 6.0), one(0.01, 0.1, at_least=False), one(9.0, 10.0, at_least=False)
    assert tightest([counted, wide, near]) is near
    assert tightest([counted, wide, one(3.0, 6.0), near]).value == 3.0
    assert tightest([counted]) is counted


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("wheel", "load_N"), "300"),
        (("wheel", "part"), 5),
        (("between",), {"wood": [1.0, 2.0, 3.0]}),
        (("between", "fe"), [1.0, 2.0]),
        (("rock",), [1.0, 2.0]),
        (("runs",), []),
        (("runs", 0, "tire"), "wood"),
        (("runs", 0, "tire"), None),
        (("runs", 0, "scenario"), "rocks"),
        (("runs", 0, "scenario"), "crevasse"),  # one tire is asked another requirement than the rest
        (("runs", 1, "tire"), "brush"),  # the same one twice
        (("runs", 0, "met"), "yes"),
        (("runs", 0, "outcomes", 0, "unit"), []),
        (("runs", 0, "outcomes", 0, "limit"), None),
        (("runs", 0, "outcomes", 0, "at_least"), 1),
        (("runs", 0, "way_m"), "far"),
        (("runs", 0, "energy_J"), 1e308),
        (("runs", 0, "loads", 0, 2), None),
        (("runs", 0, "smallest_friction"), "little"),
        (("runs", 0, "smallest_torque"), {"torque_Nm": 5.0}),
        (("runs", 1, "ends", "cause"), "weather"),
    ],
)
def test_a_record_that_no_mission_writes_is_not_understood(place: tuple[str | int, ...], value: Any) -> None:
    """Negative control: as it was written it is."""
    ends = {"cause": "friction", "time": 8.25, "way": 0.125}
    least = {"torque_Nm": 24.8, "power_W": 12.0, "energy_J": 727.0, "way_m": 2.5}
    runs = [
        run("brush", "step", smallest_torque=least, smallest_friction=0.6),
        run("fe", "step", met=False, ends=ends, outcomes=[]),
    ]
    apart = Between(17.5, 0.005, -0.023)
    found = json.loads(json.dumps(found_of(runs, replace_load(280.0), {"fe": apart}, apart)))
    assert mission_of(found).tires == ["brush", "fe"]
    inside = found
    for key in place[:-1]:
        inside = inside[key]
    inside[place[-1]] = value
    with pytest.raises((ValueError, TypeError, LookupError)):
        mission_of(found)


def test_without_a_rover_or_on_a_tire_of_another_size_nothing_is_driven() -> None:
    with pytest.raises(InputError, match=r"\[rover\]: is missing"):
        mission_tasks(STUDY.model_copy(update={"rover": None}), ["brush"])
    assert STUDY.ancf is not None
    larger = STUDY.ancf.model_copy(update={"outer_radius": 0.15, "thesis_preset": False})
    with pytest.raises(InputError, match=r"radius of \[ancf\] = .* mm: is not that of the rover's wheels"):
        mission_tasks(STUDY.model_copy(update={"ancf": larger}), ["ancf"])
