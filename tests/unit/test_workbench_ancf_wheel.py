"""ANCF wheel in the workbench: its tasks, its gates, what its model does not have."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, average_curve
from contracts.errors import InputError
from workbench.questions.ancf_wheel.graph import every_second
from workbench.questions.ancf_wheel.question import ANCF_WHEEL
from workbench.questions.ancf_wheel.results import AncfWheelRuns, differences
from workbench.questions.fe.graph import INNER_STIFFNESS, curve_deflections
from workbench.questions.model_curves import ModelCurves, RunNumbers
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.magnitudes import warnings_of
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

ROOT = Path(__file__).parents[2]
D = np.linspace(0.0, 0.03, 16)
ORIENTATIONS = (0.0, 15.0, 25.0, 40.0, 60.0, 80.0, 95.0, 105.0)


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def curves(model: str, factor: float) -> ModelCurves:
    found = {
        o: StiffnessCurve(
            model=model,
            orientation_deg=o,
            deflection=D,
            load=factor * (8e3 + 10.0 * o) * D,
            columns={
                "stored_energy_J": 0.5 * factor * (8e3 + 10.0 * o) * D**2,
                "inner_penetration_m": np.where(D > 0.0161, 1e-6, 0.0),
                "max_linearised_springs_outer_Pa": factor * 2e10 * D,
            },
        )
        for o in (0.0, 22.5)
    }
    runs = {o: RunNumbers() for o in found}
    return ModelCurves(model=model, by_orientation=found, average=average_curve(list(found.values())), runs=runs)


def _statuses(study: Study, ancf: ModelCurves, fe: ModelCurves) -> dict[str, str]:
    checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=ancf, fe=fe))
    found = {c.id.removeprefix("ancf_wheel."): c for c in checks}
    assert [name for name, c in found.items() if c.role != "gate"] == ["spring_stress_touching"]
    return {name: found[name].status for name in ("load_largest", "load_mean", "energy_largest")}


@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_a_wheel_three_per_cent_off_breaks_the_gates(study: Study, factor: float) -> None:
    found = _statuses(study, curves("ancf_wheel", factor), curves("fe", 1.0))
    assert found == {"load_largest": "fail", "load_mean": "fail", "energy_largest": "fail"}


def test_the_mean_has_a_limit_of_its_own(study: Study) -> None:
    assert set(_statuses(study, curves("ancf_wheel", 1.008), curves("fe", 1.0)).values()) == {"pass"}
    found = _statuses(study, curves("ancf_wheel", 1.015), curves("fe", 1.0))
    assert found == {"load_largest": "pass", "load_mean": "fail", "energy_largest": "pass"}


def test_an_orientation_without_points_is_not_passed(study: Study) -> None:
    """No point in common, or no curve at all: an error, never a pass."""
    fe = curves("fe", 1.0)
    first = fe.by_orientation[0.0]
    short = replace(first, deflection=1e-2 * first.deflection, load=1e-2 * first.load)
    for model in (
        replace(fe, by_orientation={**fe.by_orientation, 0.0: short}),
        replace(fe, by_orientation={22.5: fe.by_orientation[22.5]}),
    ):
        assert set(_statuses(study, curves("ancf_wheel", 1.0), model).values()) == {"error"}
    with pytest.raises(InputError, match="share no point"):
        differences(first, short)


def test_an_energy_that_is_off_shows_alone(study: Study) -> None:
    """Loads equal, energies three per cent apart; without the column it is an error."""
    fe, ancf = curves("fe", 1.0), curves("ancf_wheel", 1.0)
    for column, status in (({"stored_energy_J": 1.03 * 4e3 * D**2}, "fail"), ({}, "error")):
        changed = {
            o: replace(c, columns={k: v for k, v in c.columns.items() if k != "stored_energy_J"} | column)
            for o, c in ancf.by_orientation.items()
        }
        found = _statuses(study, replace(ancf, by_orientation=changed), fe)
        assert found == {"load_largest": "pass", "load_mean": "pass", "energy_largest": status}


def test_stresses_are_judged_before_and_after_the_first_touch(study: Study) -> None:
    """Six per cent off at the points before, or at those after: one check sees it each, the other does not."""
    fe, ancf = curves("fe", 1.0), curves("ancf_wheel", 1.0)
    for factor, expected in (
        (np.where(D > 0.0161, 1.0, 1.06), ["fail", "pass"]),
        (np.where(D > 0.0161, 0.94, 1.0), ["pass", "fail"]),
    ):
        name = "max_linearised_springs_outer_Pa"
        off = {
            o: replace(c, columns={**c.columns, name: factor * c.columns[name]}) for o, c in ancf.by_orientation.items()
        }
        checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=replace(ancf, by_orientation=off), fe=fe))
        assert [c.status for c in checks if "spring_stress" in c.id] == expected
    never = {o: replace(c, columns={**c.columns, "inner_penetration_m": 0.0 * D}) for o, c in fe.by_orientation.items()}
    checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=ancf, fe=replace(fe, by_orientation=never)))
    assert "ancf_wheel.spring_stress_touching" not in [c.id for c in checks]


def test_a_shape_that_is_off_breaks_its_gate(study: Study) -> None:
    """One point 0.11 mm away; no row is an error; where the solid keeps no points nothing is asked."""
    fe, ancf = curves("fe", 1.0), curves("ancf_wheel", 1.0)
    row = {"orientation_deg": 0.0, "deflection_m": 0.01, "rms_m": 3e-5, "rms_tire_m": 2e-5, "rms_springs_outer_m": 5e-5}
    row |= {"load_N": 80.0, "rim_force_N": 0.0, "solid_rim_force_N": 0.0}

    def shape(rows: list[dict[str, float]] | None) -> list[str]:
        checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=ancf, fe=fe, shapes=rows))
        return [c.status for c in checks if c.id == "ancf_wheel.shape"]

    assert shape([row, row]) == ["pass"]
    assert shape([row, row | {"rms_m": 1.1e-4}]) == ["fail"]
    assert shape([]) == ["error"]
    assert shape(None) == []


def test_forces_on_the_rim_are_held_over_the_load(study: Study) -> None:
    """6 N apart at 100 N of load fail, 4 N pass; where nothing touches nothing is asked."""
    fe, ancf = curves("fe", 1.0), curves("ancf_wheel", 1.0)
    row = {"orientation_deg": 0.0, "deflection_m": 0.01, "rms_m": 3e-5, "load_N": 100.0, "rim_force_N": 20.0}

    def status(*solid: float, own: float = 20.0) -> list[str]:
        rows = [row | {"rim_force_N": own, "solid_rim_force_N": force} for force in solid]
        checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=ancf, fe=fe, shapes=rows))
        return [c.status for c in checks if c.id == "ancf_wheel.rim_force"]

    assert status(20.0, 16.0) == ["pass"]
    assert status(20.0, 26.0) == ["fail"]
    assert status(0.0, own=0.0) == []


def test_one_task_an_orientation_at_every_second_point(study: Study) -> None:
    points = curve_deflections(study)
    tasks = list(ANCF_WHEEL.tasks(study))
    shape = tasks.pop()
    assert len(tasks) == len(study.fe.orientations)
    assert shape.name == "ancf_wheel_shape"
    assert set(shape.needs) == {"mesh", *(f"{m}_phi{o:03.0f}" for m in ("ancf_wheel", "fe") for o in ORIENTATIONS)}
    bare = study.model_copy(update={"fe": study.fe.model_copy(update={"keep_points": False})})
    assert len(ANCF_WHEEL.tasks(bare)) == len(tasks)
    for changes, asked in ({"order": 1}, False), ({"order": 1, "thickness_elements": 2}, True):
        meshed = study.model_copy(update={"mesh": study.mesh.model_copy(update=changes)})
        assert (ANCF_WHEEL.tasks(meshed)[-1].name == "ancf_wheel_shape") is asked
    assert {task.name for task in tasks} >= {"ancf_wheel_phi000", "ancf_wheel_phi105"}
    assert all(task.inputs["deflections"] == every_second(points) for task in tasks)
    assert tasks[0].inputs["inner_contact_stiffness"] == INNER_STIFFNESS
    through = study.model_copy(update={"fe": study.fe.model_copy(update={"inner_contact": False})})
    assert ANCF_WHEEL.tasks(through)[0].inputs["inner_contact_stiffness"] == 0.0
    rough = study.model_copy(update={"fe": study.fe.model_copy(update={"friction": 0.3})})
    assert ANCF_WHEEL.tasks(rough)[0].inputs["friction"] == 0.3
    assert ANCF_WHEEL.tasks(rough)[0].inputs["deflections"] == points  # the way counts, and so do its steps
    assert "hub" not in ANCF_WHEEL.tasks(rough)[0].inputs["options"]
    soft = study.model_copy(update={"fe": study.fe.model_copy(update={"hub": "elastic"})})
    assert ANCF_WHEEL.tasks(soft)[0].inputs["options"]["hub"] == "elastic"
    assert every_second([1.0, 2.0, 3.0]) == [1.0, 3.0]
    assert every_second([1.0, 2.0]) == [2.0]


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("fe", "material_law", "neo_hooke"),
        ("fe", "contact_stiffness", None),
        ("fe", "contact_method", "augmented_lagrangian"),
    ],
)
def test_what_its_model_does_not_have_is_not_asked(study: Study, section: str, key: str, value: object) -> None:
    changed = study.model_copy(update={section: getattr(study, section).model_copy(update={key: value})})
    assert ANCF_WHEEL.applies(study)
    assert not ANCF_WHEEL.applies(changed)
    assert [told for told in warnings_of(changed) if told.startswith("[ancf_wheel] has no effect")]
    assert not [told for told in warnings_of(study) if "ancf_wheel" in told]
    assert not ANCF_WHEEL.applies(study.model_copy(update={"ancf_wheel": None}))


def test_an_elastic_hub_needs_springs_that_end_on_it() -> None:
    strips = read_study(ROOT / "studies/amalia.toml")
    soft = strips.model_copy(update={"fe": strips.fe.model_copy(update={"hub": "elastic"})})
    assert "without springs between rim and hub" in str(without_ancf_wheel(soft))
    assert without_ancf_wheel(strips) is None
