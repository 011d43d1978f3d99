"""The full study: what its graph holds, the wheel's own symmetry, the map of load over orientation."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.orientations.question import ORIENTATIONS, OrientationMap
from workbench.questions.study_graph import report_tasks
from workbench.study.full import around, full_study, is_mirrored, rotational_period, steps_around
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.study.rules import broken_rules

HERE = built_in_study().parent


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


@pytest.fixture(scope="module")
def hoops() -> Study:
    """Its own mirror image."""
    return read_study(HERE / "exomars_hoops.toml")


def _springs(study: Study, **changes: object) -> Study:
    """The study with its first spring set changed."""
    first, *others = study.wheel.springs
    wheel = study.wheel.model_copy(update={"springs": (first.model_copy(update=changes), *others)})
    return study.model_copy(update={"wheel": wheel})


def test_the_graph_holds_every_orientation_of_a_period_on_three_meshes(study: Study) -> None:
    full = full_study(study)
    assert list(broken_rules(full)) == []
    assert full.reference == study.reference
    tasks = {task.name: task for task in report_tasks(full)}
    solved = [name for name in tasks if name.startswith("fe_phi")]
    assert solved == [f"fe_phi{o:03d}" for o in range(0, 120, 5)]
    assert tasks["mesh"].inputs["options"]["factor"] == 1.0
    for factor in (2, 3):
        assert {f"fe_x{factor}_phi{o:03d}" for o in range(0, 120, 5)} <= set(tasks)
    (own,) = (task for task in report_tasks(study) if task.name == "mesh")
    assert set(own.inputs["options"]) == set(tasks["mesh"].inputs["options"])
    metrics = tasks["metrics"].needs
    assert set(solved) <= set(metrics)


def test_meshes_of_default_and_full_study_are_shared(study: Study) -> None:
    default, full = ({t.name: t for t in report_tasks(s)} for s in (study, full_study(study)))
    for name in ("mesh", "mesh_x2", "mesh_x3"):
        assert default[name].inputs == full[name].inputs
    assert default["fe_x2_phi015"].key({"mesh_x2": "m"}) == full["fe_x2_phi015"].key({"mesh_x2": "m"})


@pytest.mark.parametrize(
    "path",
    sorted(set(HERE.glob("*.toml")) - {HERE / name for name in ("words_search.toml", "spiral.toml", "spoked.toml")}),
    ids=lambda p: p.stem,
)
def test_every_shipped_study_has_a_full_study(path: Path) -> None:
    full = full_study(read_study(path))
    steps = np.diff([math.degrees(o) for o in full.fe.orientations])
    assert len(steps) * steps[0] + steps[0] == pytest.approx(rotational_period(full))


def test_the_wheel_repeats_itself_after_the_common_divisor_of_its_counts(study: Study) -> None:
    assert rotational_period(study) == 120.0
    assert rotational_period(_springs(study, count=4)) == 360.0
    bare = study.wheel.model_copy(update={"grousers": None})
    assert rotational_period(study.model_copy(update={"wheel": bare})) == 120.0


def test_a_lattice_repeats_itself_after_a_cell_and_is_its_own_mirror_image() -> None:
    honeycomb = read_study(built_in_study().with_name("honeycomb.toml"))
    assert rotational_period(honeycomb) == 22.5
    assert is_mirrored(honeycomb)
    assert not is_mirrored(read_study(built_in_study().with_name("leaves.toml")))


def test_orientations_stand_for_arcs_of_the_period(study: Study, hoops: Study) -> None:
    """A mirrored wheel has half a period, 60 deg, whose ends count half; a one-way wheel a circle of 120 deg."""
    assert around(hoops).weights([0.0, 15.0, 30.0, 45.0, 60.0]) == pytest.approx([0.125, 0.25, 0.25, 0.25, 0.125])
    assert around(hoops).weights([0.0, 120.0, 60.0]) == pytest.approx([0.25, 0.25, 0.5])
    assert around(study).weights([0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0]) == pytest.approx([0.125] * 8)
    one_way = _springs(hoops, shape="arc")
    assert around(one_way).weights([0.0, 30.0, 60.0, 90.0]) == pytest.approx([0.25] * 4)
    assert around(one_way).weights([0.0, 15.0, 60.0]) == pytest.approx([37.5 / 120.0, 30.0 / 120.0, 52.5 / 120.0])
    assert around(one_way).weights([45.0]) == [1.0]


def test_mirror_symmetry_needs_phases_and_two_sided_springs(study: Study, hoops: Study) -> None:
    assert not is_mirrored(study)
    assert is_mirrored(hoops)
    assert not is_mirrored(_springs(hoops, phase=math.radians(10.0)))
    assert not is_mirrored(_springs(hoops, shape="arc"))
    elastic = hoops.model_copy(update={"fe": hoops.fe.model_copy(update={"hub": "elastic"})})
    assert not is_mirrored(elastic)  # the impact springs are arcs


@pytest.mark.parametrize(("step", "word"), [(7.0, "must divide 120 deg"), (8.0, "is not among 0 to 112 deg")])
def test_a_step_that_does_not_fit_is_refused(study: Study, step: float, word: str) -> None:
    full = study.full.model_copy(update={"orientation_step": math.radians(step)})
    with pytest.raises(InputError, match=word):
        full_study(study.model_copy(update={"full": full}))


@pytest.mark.parametrize(
    ("period", "step", "told"),
    [(72.0, 11.25, ["9", "12"]), (90.0, 120.0, ["90"]), (360.0 / 7.0, 20.0, ["17.14285714", "25.71428571"])],
)
def test_steps_that_divide_the_period_are_named(
    study: Study, period: float, step: float, told: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("workbench.study.full.rotational_period", lambda _: period)

    def stepped(angle: float) -> Study:
        full = study.full.model_copy(update={"orientation_step": math.radians(angle)})
        return study.model_copy(update={"full": full})

    with pytest.raises(InputError, match=f"choose {' or '.join(told)} deg"):
        steps_around(stepped(step))
    for one in map(float, told):
        assert len(steps_around(stepped(one))) == round(period / one)


def _map(orientations: tuple[float, ...] = (0.0, 30.0, 60.0, 90.0), damage: float = 0.0) -> OrientationMap:
    d = np.linspace(0.0, 0.02, 11)
    curves = {}
    for phi in orientations:
        load = (8000.0 + 500.0 * math.cos(math.radians(3.0 * phi)) + damage * phi) * d
        curves[phi] = StiffnessCurve(model="fe", orientation_deg=phi, deflection=d, load=load)
    return OrientationMap(curves=curves, missing=(), period=120.0, mirrored=True)


def test_mirrored_orientations_are_found_and_held_against_each_other(study: Study) -> None:
    found = _map()
    assert found.mirror_pairs == ((30.0, 90.0),)
    assert found.complete
    assert not _map((0.0, 15.0, 30.0)).complete
    assert found.mirror_error() == pytest.approx(0.0, abs=1e-12)
    assert _map(damage=10.0).mirror_error() == pytest.approx(600.0 / 8600.0, rel=1e-9)
    for damage, status in ((0.0, "pass"), (10.0, "fail")):
        (check,) = ORIENTATIONS.checks(study, _map(damage=damage))
        assert (check.id, check.role, check.status) == ("fe.mirror_symmetry", "finding", status)
    assert replace(found, mirrored=False).mirror_pairs == ()
    assert ORIENTATIONS.checks(study, _map((0.0, 15.0, 60.0))) == ()


def test_loads_over_orientation_reach_as_far_as_every_curve() -> None:
    found = _map()
    deflections = found.deflections(5e-3)
    assert deflections == pytest.approx([0.005, 0.010, 0.015, 0.020])
    assert found.loads(deflections).shape == (4, 4)
    assert found.loads(deflections)[:, 0] == pytest.approx(8500.0 * deflections)
