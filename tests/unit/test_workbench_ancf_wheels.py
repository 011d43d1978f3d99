"""Records of the ANCF wheel beside the solid one: their numbers by hand, what a stale or damaged one decides."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from contracts.hub_travel import OVER_GROUND
from workbench.questions.ancf_wheels.cases import COMMAND, ComparedWheel, compared_wheels, wheel_tasks
from workbench.questions.ancf_wheels.question import ANCF_WHEELS
from workbench.questions.ancf_wheels.results import agreement
from workbench.questions.kept import keep
from workbench.report.page import page_environment
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

STUDIES = built_in_study().parent
AMALIA = next(wheel for wheel in compared_wheels() if wheel.name == "amalia")


def found(wheel: ComparedWheel, off: float = 1.01) -> dict[str, Any]:
    """Plates are ``off`` at the last orientation's second point, else equal; finer meshes take 1 and 3 %."""
    solid, deflection = [20.0, 40.0], [0.001, 0.002]
    curves = [
        {
            "orientation_deg": o,
            "deflection_m": deflection,
            "fe_N": solid,
            "plates_N": list(solid),
            "stress_apart": 0.01,
            "partial": False,
        }
        for o in wheel.orientations
    ]
    curves[-1] |= {"plates_N": [20.0, 40.0 * off], "stress_apart": -0.03}
    counts = {name: [k] * len(curves) for name, k in (("plates", 900), ("fe", 5000))}
    fine = {"deflection_m": [0.001, 0.002], "fe_N": [19.8, 39.6], "plates_N": [19.4, 38.8 * off]}
    fine |= {"stress_apart": 0.02, "partial": False}
    return {"curves": curves, "fine": fine, "unknowns": counts, "solve_s": counts}


@pytest.fixture
def studies(tmp_path: Path) -> Path:
    """The built-in study and the compared wheels' in a folder of their own, without records."""
    for name in {wheel.study for wheel in compared_wheels()} | {"amalia_fe.csv"}:
        shutil.copy(STUDIES / name, tmp_path / name)
    return tmp_path


def study_with(studies: Path, wheel: ComparedWheel, numbers: dict[str, Any]) -> Study:
    study = wheel.read(studies / wheel.study)
    keep(study, wheel.record, COMMAND, wheel_tasks(wheel, study), 60.0, numbers)
    return read_study(studies / "exomars.toml")


def test_the_numbers_of_a_record() -> None:
    says = agreement(AMALIA, found(AMALIA))
    assert (says.largest, says.at_deg, says.at_m) == (pytest.approx(0.01), AMALIA.orientations[-1], 0.002)
    assert says.mean == pytest.approx(0.01 / (2 * len(AMALIA.orientations)))
    assert (says.plates_mesh, says.solid_mesh) == (pytest.approx(-0.03), pytest.approx(-0.01))
    assert says.finer == pytest.approx(19.4 / 19.8 - 1.0)
    assert says.unknowns == (900.0, 5000.0)
    assert (says.stress, says.stress_finer) == (-0.03, 0.02)


def test_curves_that_end_early_are_told_and_decide_nothing(studies: Path) -> None:
    numbers = found(AMALIA)
    numbers["curves"][0] |= {"deflection_m": [0.001], "fe_N": [20.0], "plates_N": [20.0]}
    assert agreement(AMALIA, numbers).ends == (0.001, 0.002)
    assert not agreement(AMALIA, numbers).partial
    numbers["curves"][0]["partial"] = True
    study = study_with(studies, AMALIA, numbers)
    (check,) = ANCF_WHEELS.checks(study, ANCF_WHEELS.read(study, {}))
    assert check.status == "undecided"
    assert check.tolerance.endswith("; a run ended early")


def test_springs_that_touch_at_once_have_no_stress_to_compare(studies: Path) -> None:
    numbers = found(AMALIA)
    numbers["fine"]["stress_apart"] = None
    says = agreement(AMALIA, numbers)
    assert (says.stress, says.stress_finer) == (-0.03, None)
    (one,) = ANCF_WHEELS.read(study_with(studies, AMALIA, numbers), {})
    assert one.agreement == says


@pytest.mark.parametrize("wheel", compared_wheels(), ids=lambda wheel: wheel.name)
def test_every_wheel_is_computed_by_both_models_and_finer(wheel: ComparedWheel) -> None:
    tasks = {task.name: task for task in wheel_tasks(wheel, wheel.read(STUDIES / wheel.study))}
    travels = 6 * len(wheel.moved) + bool(wheel.moved)  # three ways by two models, and the whole wheel's mesh
    assert len(tasks) == 2 * len(wheel.orientations) + 4 + travels  # two meshes, two finer curves
    assert tasks["ancf_wheel_fine"].inputs["options"]["factor"] == 2.0
    assert tasks["mesh_fine"].inputs["options"]["factor"] == 2.0 * tasks["mesh"].inputs["options"]["factor"]
    assert tasks["fe_fine"].inputs["deflections"] == tasks["ancf_wheel_fine"].inputs["deflections"]
    assert wheel.fine in wheel.orientations


def travelled(wheel: ComparedWheel, off: float) -> dict[str, Any]:
    """Plates are ``off`` sideways at the last orientation, else equal."""
    rows = [
        {"way": way.value, "orientation_deg": o, "fe": 4e3, "plates": 4e3} for o in wheel.moved for way in OVER_GROUND
    ]
    next(row for row in reversed(rows) if row["way"] == "lateral")["plates"] = 4e3 * off
    return found(wheel) | {"travels": rows}


def test_stiffness_along_the_ground_is_judged_where_it_is_kept(studies: Path) -> None:
    wheel = next(one for one in compared_wheels() if one.moved)
    for off, status in ((0.96, "pass"), (1.06, "fail")):
        study = study_with(studies, wheel, travelled(wheel, off))
        results = ANCF_WHEELS.read(study, {})
        check = {one.id: one for one in ANCF_WHEELS.checks(study, results)}["ancf_travel.built_in"]
        assert (check.status, check.role, check.value) == (status, "finding", pytest.approx(abs(off - 1.0)))
        template = page_environment().get_template("ancf_wheels/evidence.html.j2")
        assert "turned about the normal" in template.render(results=results, study=study, figures={})
    study = study_with(studies, wheel, found(wheel))
    assert [one.id for one in ANCF_WHEELS.checks(study, ANCF_WHEELS.read(study, {}))] == ["ancf_wheels.built_in"]


def test_a_record_that_lacks_a_travel_or_has_none_is_refused() -> None:
    wheel = next(one for one in compared_wheels() if one.moved)
    numbers = travelled(wheel, 1.0)
    with pytest.raises(InputError, match="travels"):
        agreement(wheel, numbers | {"travels": numbers["travels"][1:]})
    numbers["travels"][0]["fe"] = 0.0
    with pytest.raises(ValueError, match="above zero"):
        agreement(wheel, numbers)


def test_the_wheels_of_our_own_have_the_springs_they_are_named_for() -> None:
    own = {
        wheel.name: wheel.read(STUDIES / wheel.study).wheel.springs[0] for wheel in compared_wheels() if wheel.springs
    }
    assert {name: springs.shape for name, springs in own.items()} == {"arcs": "arc", "leaves": "spline"}


def test_it_is_asked_where_a_record_lies_beside_the_study(studies: Path) -> None:
    assert not ANCF_WHEELS.applies(read_study(studies / "exomars.toml"))
    study = study_with(studies, AMALIA, found(AMALIA))
    assert ANCF_WHEELS.applies(study)
    assert not ANCF_WHEELS.applies(read_study(studies / "amalia.toml"))
    (one,) = ANCF_WHEELS.read(study, {})
    assert (one.wheel.name, one.state) == ("amalia", "current")


def test_a_record_decides_by_its_largest_difference(studies: Path) -> None:
    for off, status in ((1.019, "pass"), (0.979, "fail")):
        study = study_with(studies, AMALIA, found(AMALIA, off))
        (check,) = ANCF_WHEELS.checks(study, ANCF_WHEELS.read(study, {}))
        assert (check.id, check.status, check.role) == ("ancf_wheels.amalia", status, "finding")


def test_a_record_of_another_study_decides_nothing(studies: Path) -> None:
    study = study_with(studies, AMALIA, found(AMALIA))
    path = studies / "amalia.toml"
    path.write_text(path.read_text(encoding="utf-8").replace('thickness = "0.4 mm"', 'thickness = "0.41 mm"', 1))
    (one,) = ANCF_WHEELS.read(study, {})
    assert one.state == "stale"
    assert ANCF_WHEELS.checks(study, [one])[0].status == "undecided"
    page = (
        page_environment().get_template("ancf_wheels/evidence.html.j2").render(results=[one], study=study, figures={})
    )
    assert "stale" in page
    assert COMMAND in page


@pytest.mark.parametrize("part", ["curves", "fine", "unknowns"])
def test_a_damaged_record_is_told_before_anything_is_computed(studies: Path, part: str) -> None:
    numbers = found(AMALIA)
    numbers[part] = [] if part == "curves" else {}
    study = study_with(studies, AMALIA, numbers)
    with pytest.raises(InputError, match="record"):
        ANCF_WHEELS.applies(study)


def test_a_record_of_other_orientations_or_points_is_refused() -> None:
    numbers = found(AMALIA)
    with pytest.raises(InputError, match="orientations"):
        agreement(AMALIA, numbers | {"curves": numbers["curves"][:-1]})
    with pytest.raises(InputError, match="points"):
        agreement(AMALIA, numbers | {"fine": numbers["fine"] | {"deflection_m": [0.0011, 0.0021]}})
