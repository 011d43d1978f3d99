"""ANCF wheel in the workbench: its tasks, its gates, what its model does not have."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, average_curve
from contracts.errors import InputError
from workbench.questions.ancf_wheel.graph import every_second
from workbench.questions.ancf_wheel.question import ANCF_WHEEL
from workbench.questions.ancf_wheel.results import AncfWheelRuns, differences
from workbench.questions.fe.graph import curve_deflections
from workbench.questions.model_curves import ModelCurves, RunNumbers
from workbench.study.magnitudes import warnings_of
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

D = np.linspace(0.0, 0.03, 16)


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def curves(model: str, factor: float) -> ModelCurves:
    found = {
        o: StiffnessCurve(model=model, orientation_deg=o, deflection=D, load=factor * (8e3 + 10.0 * o) * D)
        for o in (0.0, 22.5)
    }
    runs = {o: RunNumbers() for o in found}
    return ModelCurves(model=model, by_orientation=found, average=average_curve(list(found.values())), runs=runs)


def _statuses(study: Study, ancf: ModelCurves, fe: ModelCurves) -> dict[str, str]:
    checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=ancf, fe=fe))
    assert [c.role for c in checks] == ["gate", "gate", "finding"]
    return {c.id: c.status for c in checks[:2]}


@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_a_wheel_three_per_cent_off_breaks_the_gates(study: Study, factor: float) -> None:
    found = _statuses(study, curves("ancf_wheel", factor), curves("fe", 1.0))
    assert found == {"ancf_wheel.load_largest": "fail", "ancf_wheel.load_mean": "fail"}


def test_the_mean_has_a_limit_of_its_own(study: Study) -> None:
    assert set(_statuses(study, curves("ancf_wheel", 1.008), curves("fe", 1.0)).values()) == {"pass"}
    found = _statuses(study, curves("ancf_wheel", 1.015), curves("fe", 1.0))
    assert found == {"ancf_wheel.load_largest": "pass", "ancf_wheel.load_mean": "fail"}


def test_an_orientation_without_points_is_not_passed(study: Study) -> None:
    """No point in common, or no curve at all: an error, never a pass."""
    fe = curves("fe", 1.0)
    first = fe.by_orientation[0.0]
    touching = replace(first, columns={"inner_penetration_m": np.where(D > 0.0, 1e-6, 0.0)})
    for model in (
        replace(fe, by_orientation={**fe.by_orientation, 0.0: touching}),
        replace(fe, by_orientation={22.5: fe.by_orientation[22.5]}),
    ):
        assert set(_statuses(study, curves("ancf_wheel", 1.0), model).values()) == {"error"}


def test_points_where_springs_touch_are_left_out() -> None:
    """The last point before the first contact of the solid's own parts is the last one compared."""
    solid = curves("fe", 1.0).by_orientation[0.0]
    touching = replace(solid, columns={"inner_penetration_m": np.where(D > 0.0161, 1e-6, 0.0)})
    at, found = differences(replace(solid, load=1.01 * solid.load), touching)
    assert at[-1] == pytest.approx(0.016)
    np.testing.assert_allclose(found, 0.01)
    assert differences(solid, touching, touching=True)[0][-1] == D[-1]
    with pytest.raises(InputError, match="before springs touch"):
        differences(solid, replace(solid, columns={"inner_penetration_m": 1e-6 * np.ones_like(D)}))


def test_touching_points_are_a_finding_of_their_own(study: Study) -> None:
    """Five per cent off where springs touch: the gates do not see it, the finding does."""
    fe, ancf = curves("fe", 1.0), curves("ancf_wheel", 1.0)
    touch = {"inner_penetration_m": np.where(D > 0.0161, 1e-6, 0.0)}
    solid = replace(fe, by_orientation={o: replace(c, columns=touch) for o, c in fe.by_orientation.items()})
    factor = np.where(D > 0.0161, 0.95, 1.0)
    weak = replace(ancf, by_orientation={o: replace(c, load=factor * c.load) for o, c in ancf.by_orientation.items()})
    checks = ANCF_WHEEL.checks(study, AncfWheelRuns(ancf=weak, fe=solid))
    assert [c.status for c in checks] == ["pass", "pass", "fail"]
    assert checks[2].value == pytest.approx(0.05)


def test_one_task_an_orientation_at_every_second_point(study: Study) -> None:
    points = curve_deflections(study)
    tasks = ANCF_WHEEL.tasks(study)
    assert len(tasks) == len(study.fe.orientations)
    assert {task.name for task in tasks} >= {"ancf_wheel_phi000", "ancf_wheel_phi105"}
    assert all(task.inputs["deflections"] == every_second(points) for task in tasks)
    assert every_second([1.0, 2.0, 3.0]) == [1.0, 3.0]
    assert every_second([1.0, 2.0]) == [2.0]


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [("fe", "friction", 0.3), ("fe", "hub", "elastic"), ("fe", "material_law", "neo_hooke")],
)
def test_what_its_model_does_not_have_is_not_asked(study: Study, section: str, key: str, value: object) -> None:
    changed = study.model_copy(update={section: getattr(study, section).model_copy(update={key: value})})
    assert ANCF_WHEEL.applies(study)
    assert not ANCF_WHEEL.applies(changed)
    assert [told for told in warnings_of(changed) if told.startswith("[ancf_wheel] has no effect")]
    assert not [told for told in warnings_of(study) if "ancf_wheel" in told]
    assert not ANCF_WHEEL.applies(study.model_copy(update={"ancf_wheel": None}))
