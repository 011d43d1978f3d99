"""Stiffnesses against the hub's travel in the fit of the ANCF tire: its tasks, what it reads, what it says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.fit.travel_fit import TravelData, travel_stiffness
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_tire
from contracts.curves import write_curve
from contracts.errors import InputError, StudyError
from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, TravelCurve, write_travel
from workbench.commands.calibrate_ancf import _print_travels
from workbench.questions.ancf_fit.fit import FittedTire, read_fit
from workbench.questions.ancf_fit.graph import fit_tasks
from workbench.questions.ancf_fit.records import Fitted, Held
from workbench.questions.ancf_fit.task import evaluate, fit
from workbench.questions.ancf_fit.travels import fe_travels
from workbench.questions.model_curves import CURVE
from workbench.questions.study_graph import report_tasks
from workbench.questions.travel_files import travel_name
from workbench.questions.travel_start import TRAVEL
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

SMALL = replace(thesis_preset(), quadrature=(3, 3, 2), contact_points=(6, 3))
TRUTH = replace(SMALL, young_modulus=1.2 * SMALL.young_modulus, hub_radius=0.045)
WAYS, ORIENTATIONS, LOAD = (Way.LATERAL, Way.TURNING), (0.0, 30.0), 100.0
MARK = "[ancf_fit.bounds]\n"
ASKED = f'[ancf_fit.travel]\nways = ["lateral", "turning"]\nload = "200 N"\nweight = 2\n\n{MARK}'
INPUTS = {
    "preset": asdict(SMALL) | {"contact_points": [6, 3], "quadrature": [3, 3, 2]},
    "orientations_deg": list(ORIENTATIONS),
    "load_range": [30.0, 150.0],
    "points": 4,
    "average_weight": 1.0,
    "phase_starts": 1,
    "mirrored": False,
    "around": {"period": 60.0, "mirrored": True},
    "free": [["young_modulus", 1e4, 1e7], ["hub_radius", 0.02, 0.08]],
    "travel": {"ways": [way.value for way in WAYS], "load": LOAD, "weight": 2.0},
}


def study_with(folder: Path, text: str) -> Study:
    whole = built_in_study().read_text(encoding="utf-8")
    assert MARK in whole
    (folder / "study.toml").write_text(whole.replace(MARK, text, 1), encoding="utf-8")
    return read_study(folder / "study.toml")


def stiffness_of(preset: object) -> np.ndarray:
    tire = build_tire(preset)  # type: ignore[arg-type]
    states = [solve_tire(tire, np.radians(o), np.linspace(0.004, 0.024, 11)) for o in ORIENTATIONS]
    return travel_stiffness(tire, states, TravelData(ways=WAYS, load=LOAD, stiffness=np.ones((2, 2))))


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    """Results as the FE tasks leave them, of a tire with another modulus and hub; the hub pulls in a straight line."""
    root, found, stiffness = tmp_path_factory.mktemp("fe"), dict[str, Path](), stiffness_of(TRUTH)
    for o, row in zip(ORIENTATIONS, stiffness.tolist(), strict=True):
        found[f"fe_phi{o:03.0f}"] = root / f"curve{o:g}"
        grid = np.linspace(0.0, 0.025, 51)
        write_curve(solve_tire(build_tire(TRUTH), np.radians(o), grid).curve("test"), root / f"curve{o:g}" / CURVE)
        for way, S in zip(WAYS, row, strict=True):
            travel = np.array([0.0, 1e-3, 2e-3])
            columns = {name: np.full(3, 7.0) for name in WRENCH}
            columns["force_left_N" if way is Way.LATERAL else "moment_up_Nm"] = 3.0 - S * travel
            curve = TravelCurve(model="fe", way=way, orientation_deg=o, deflection=0.01, travel=travel,
                                columns=columns, source="test")  # fmt: skip
            found[travel_name("fe", way, o)] = root / f"{way}{o:g}"
            write_travel(curve, root / f"{way}{o:g}" / TRAVEL)
    return found


def test_a_study_that_does_not_ask_solves_none() -> None:
    study = read_study(built_in_study())
    assert not [task.name for task in report_tasks(study) if "lateral" in task.name or "turning" in task.name]
    assert all("travel" not in task.inputs for task in fit_tasks(study))


def test_a_study_that_asks_solves_each_way_at_each_orientation_once(tmp_path: Path) -> None:
    study = study_with(tmp_path, ASKED)
    names = [task.name for task in report_tasks(study)]
    assert sum(name.startswith(("fe_lateral_phi", "fe_turning_phi")) for name in names) == 2 * 8
    assert len(set(names)) == len(names)
    for task in fit_tasks(study)[-3:]:
        assert task.inputs["travel"] == {"ways": ["lateral", "turning"], "load": 200.0, "weight": 2.0}
        assert {"fe_lateral_phi000", "fe_turning_phi105", "fe_phi000"} <= set(task.needs)
        assert all(names.index(need) < names.index(task.name) for need in task.needs)
    by_name = {task.name: task for task in report_tasks(study)}
    plain = {task.name: task for task in report_tasks(study_with(tmp_path, MARK))}
    solved = [name for name in plain if name.startswith(("fe_phi", "mesh"))]
    assert all(by_name[name].inputs == plain[name].inputs for name in solved)  # nothing of the FE curves changes


def test_both_parameters_are_found_and_the_record_says_each_stiffness(
    folders: Mapping[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """2 %, as in test_workbench_ancf_fit.py: curves are joined linearly between points; stiffnesses are exact."""
    fit(INPUTS, folders, tmp_path, lambda fraction: None)
    found = read_fit("test", tmp_path, Fitted)
    values = [p.value for p in found.numbers.parameters]
    assert values == pytest.approx([TRUTH.young_modulus, TRUTH.hub_radius], rel=0.02)
    rows = found.numbers.travels
    assert [(row.way, row.orientation_deg) for row in rows] == [(w.value, o) for o in ORIENTATIONS for w in WAYS]
    assert [row.fe for row in rows] == pytest.approx(stiffness_of(TRUTH).ravel().tolist(), rel=1e-9)
    assert [row.tire for row in rows] == pytest.approx(stiffness_of(found.numbers.preset).ravel().tolist(), rel=1e-6)
    assert all(abs(row.difference) < 0.02 for row in rows)
    assert found.numbers.travel_load_N == LOAD
    evaluate(INPUTS, folders, tmp_path, lambda fraction: None)
    own = read_fit("own", tmp_path, Held)
    assert min(abs(row.difference) for row in own.numbers.travels) > 0.02  # negative control: another tire
    _print_travels([own, found])
    told = capsys.readouterr().out
    assert "under 100 N" in told
    assert all(word in told for word in ("lateral", "turning", "30 deg"))
    for row in (*own.numbers.travels, *rows):
        scale = 1.0 if row.way == "turning" else 1e-3
        assert f"{scale * row.fe:.4g}" in told
        assert f"{scale * row.tire:.4g} ({100.0 * row.difference:+.0f} %)" in told


def test_a_heavy_weight_draws_the_tire_to_the_stiffnesses(folders: Mapping[str, Path], tmp_path: Path) -> None:
    """Of FE stiffnesses half as large again the modulus alone meets more, the more they weigh."""
    worst = []
    for weight in (0.1, 10.0):
        out = tmp_path / f"{weight:g}"
        out.mkdir()
        inputs = INPUTS | {"free": [["young_modulus", 1e4, 1e7]], "preset": INPUTS["preset"] | {"hub_radius": 0.03}}
        fit(inputs | {"travel": INPUTS["travel"] | {"weight": weight}}, folders, out, lambda fraction: None)
        rows = read_fit("test", out, Fitted).numbers.travels
        worst.append(np.linalg.norm([row.difference for row in rows]))
    assert worst[1] < 0.7 * worst[0]


def test_without_the_section_the_record_has_none(folders: Mapping[str, Path], tmp_path: Path) -> None:
    evaluate({k: v for k, v in INPUTS.items() if k != "travel"}, folders, tmp_path, lambda fraction: None)
    own: FittedTire[Held] = read_fit("own", tmp_path, Held)
    assert (own.numbers.travels, own.numbers.travel_load_N) == ((), None)
    _print_travels([own])


def test_a_tire_that_does_not_come_to_the_load_has_no_number(folders: Mapping[str, Path], tmp_path: Path) -> None:
    soft = INPUTS["preset"] | {"young_modulus": 5e3}
    evaluate(INPUTS | {"preset": soft}, folders, tmp_path, lambda fraction: None)
    rows = read_fit("own", tmp_path, Held).numbers.travels
    assert [row.tire for row in rows] == [row.difference for row in rows] == [None] * 4


def test_a_run_that_ended_early_is_named(folders: Mapping[str, Path], tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    without = {**folders, travel_name("fe", Way.TURNING, 30.0): tmp_path / "empty"}
    with pytest.raises(InputError, match="turning at 30 deg: ended before the hub's first step"):
        fe_travels(INPUTS, without, ORIENTATIONS)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"turning"', '"sideways"', "ancf_fit.travel.ways"),
        ('"lateral", "turning"', '"lateral", "lateral"', "must name nothing twice"),
        ('"lateral", "turning"', "", "ancf_fit.travel.ways"),
        ('load = "200 N"', 'load = "290 N"', r"ancf_fit.travel.load = 290 N: must lie within"),
        ('load = "200 N"', 'load = "10 N"', r"ancf_fit.travel.load = 10 N: must lie within"),
        ("weight = 2", "weight = 0", "ancf_fit.travel.weight"),
        ("weight = 2", "weight = -1", "ancf_fit.travel.weight"),
        ("weight = 2", "wait = 2", "not a known key"),
    ],
)
def test_bad_sections_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in ASKED
    with pytest.raises(StudyError, match=message):
        study_with(tmp_path, ASKED.replace(old, new, 1))
