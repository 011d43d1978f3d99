"""The fit of the ANCF tire in the workbench: which loads count, its tasks, its checks, what a study may ask for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.fit.parameters import Parameter
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import stiffness_curve
from contracts.curves import StiffnessCurve, write_curve
from contracts.errors import InputError, StudyError
from workbench.questions.ancf_fit.fit import average_error, fitted_deflections, read_fit
from workbench.questions.ancf_fit.graph import fit_tasks
from workbench.questions.ancf_fit.question import AncfFits
from workbench.questions.ancf_fit.records import Fitted, Held
from workbench.questions.ancf_fit.task import evaluate, fit
from workbench.questions.model_curves import ModelCurves
from workbench.questions.registry import questions_of
from workbench.questions.study_graph import report_tasks
from workbench.study.model import Study
from workbench.study.model_parameters import fit_start
from workbench.study.reading import built_in_study, read_study
from workbench.study.rewrite import rewritten_table

D = np.linspace(0.0, 0.03, 16)
LINE = StiffnessCurve(model="fe", orientation_deg=0.0, deflection=D, load=8e3 * D)
SMALL = replace(thesis_preset(), quadrature=(3, 3, 2), contact_points=(6, 3))
ALL = {"period": 60.0, "mirrored": True}
"""The wheel's two orientations, 0 and 30 deg, weigh alike."""


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def test_loads_are_spread_in_equal_ratios() -> None:
    found = LINE.load_at(fitted_deflections(LINE, (20.0, 160.0), 4))
    np.testing.assert_allclose(found, [20.0, 40.0, 80.0, 160.0])
    assert fitted_deflections(LINE, (20.0, 999.0), 3)[-1] == pytest.approx(0.03)
    with pytest.raises(InputError, match="beyond the end"):
        fitted_deflections(LINE, (241.0, 999.0), 3)


def test_the_largest_error_is_found_with_its_sign() -> None:
    low = replace(LINE, load=LINE.load - np.where(np.arange(len(D)) == 8, 6.0, 0.0))
    found = average_error([low, LINE], LINE, (20.0, 200.0))
    assert found.largest == pytest.approx(-3.0 / 128.0, rel=0.02)
    assert found.at_load == pytest.approx(128.0, rel=0.02)


def test_tasks_of_the_built_in_study(study: Study) -> None:
    tasks = {task.name: task for task in fit_tasks(study)}
    assert study.ancf_fit is not None
    assert list(tasks) == ["ancf_as_it_is", *(f"ancf_fit_{tire.name}" for tire in study.ancf_fit.tires)]
    known = {task.name for task in report_tasks(study)}
    assert all(set(task.needs) < known for task in tasks.values())
    assert "ancf_fit" in [question.name for question in questions_of(study)]
    without = study.model_copy(update={"ancf_fit": None})
    assert fit_tasks(without) == []
    assert "ancf_fit" not in [question.name for question in questions_of(without)]


def test_the_start_keeps_the_stiffness_per_area_and_the_datum(study: Study) -> None:
    assert study.ancf_fit is not None
    six = study.ancf_fit.tires[1]
    bare = fit_start(study, six.model_copy(update={"start": type(six.start)()}))
    assert bare.contact_stiffness * 6 == pytest.approx(study.ancf.contact_stiffness * 4)
    assert fit_start(study, six).datum_radius == study.ancf.outer_radius


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    """Results as the FE tasks leave them, but from a tire 20 % stiffer than the preset."""
    root, names = tmp_path_factory.mktemp("fe"), {"fe_phi000": 0.0, "fe_phi030": 30.0}
    truth = replace(SMALL, young_modulus=1.2 * SMALL.young_modulus)
    grid = [0.0, 0.002, *np.arange(0.004, 0.0251, 0.001).round(6).tolist()]
    for name, o in names.items():
        (root / name).mkdir()
        write_curve(stiffness_curve(truth, np.radians(o), grid), root / name / "curve.csv")
    return {name: root / name for name in names}


def test_a_fit_and_its_result(folders: Mapping[str, Path], tmp_path: Path) -> None:
    """The modulus that made the curves is found, with an interval; the mass is that of Table I."""
    preset = asdict(SMALL) | {"contact_points": [6, 3], "quadrature": [3, 3, 2]}
    inputs = {"preset": preset, "orientations_deg": [0.0, 30.0], "load_range": [30.0, 150.0], "points": 4}
    inputs |= {
        "average_weight": 3.0,
        "phase_starts": 1,
        "mirrored": True,
        "around": ALL,
    }
    fit(inputs | {"free": [["young_modulus", 1e4, 1e7]]}, folders, tmp_path, lambda fraction: None)
    tire = read_fit("test", tmp_path, Fitted)
    (row,) = tire.numbers.parameters
    assert row.value == pytest.approx(1.2 * SMALL.young_modulus, rel=0.02)  # curves are joined linearly between points
    assert row.interval[0] < row.value < row.interval[1]
    assert tire.numbers.flexible_mass_kg == pytest.approx(4.44157)
    assert abs(tire.numbers.average.largest) < 0.03
    assert list(tire.curves) == [0.0, 30.0]
    evaluate(inputs, folders, tmp_path, lambda fraction: None)
    own = read_fit("own", tmp_path, Held)
    assert own.numbers.preset.young_modulus == SMALL.young_modulus
    assert max(own.numbers.relative_rms) > 0.05
    # a tire whose spokes stand on its plane of symmetry is its own mirror image
    np.testing.assert_allclose(own.numbers.mirrored_rms, own.numbers.relative_rms, rtol=0.05)


def test_a_turned_tire_is_found_by_its_mirror_image(folders: Mapping[str, Path], tmp_path: Path) -> None:
    """Curves of spokes at 20 deg meet themselves at 0 and 30 deg; minus 30 deg is 50 deg from a spoke, not 10."""
    inputs = {"orientations_deg": [0.0, 30.0], "load_range": [30.0, 150.0], "mirrored": True, "around": ALL}
    turned = replace(SMALL, phase=np.radians(20.0))
    preset = asdict(turned) | {"contact_points": [6, 3], "quadrature": [3, 3, 2]}
    evaluate(inputs | {"preset": preset}, folders, tmp_path, lambda fraction: None)
    numbers = read_fit("own", tmp_path, Held).numbers
    assert numbers.mirrored_rms[0] == pytest.approx(numbers.relative_rms[0], rel=0.05)
    assert abs(numbers.mirrored_rms[1] - numbers.relative_rms[1]) > 0.05


def test_phases_are_tried_as_the_study_asks(study: Study, folders: Mapping[str, Path], tmp_path: Path) -> None:
    assert study.ancf_fit is not None
    six = fit_tasks(study, [study.ancf_fit.tires[1].model_copy(update={"phase_starts": 6})])[-1]
    assert six.inputs["phase_starts"] == 6
    assert not six.inputs["mirrored"]  # the wheel's leaves are bowed one way
    preset = asdict(SMALL) | {"contact_points": [6, 3], "quadrature": [3, 3, 2]}
    inputs = {"preset": preset, "orientations_deg": [0.0, 30.0], "load_range": [30.0, 150.0], "points": 3}
    inputs |= {
        "average_weight": 1.0,
        "phase_starts": 2,
        "mirrored": True,
        "around": ALL,
    }
    free = [["young_modulus", 1e4, 1e7], ["phase", -0.8, 0.8]]
    fit(inputs | {"free": free}, folders, tmp_path, lambda fraction: None)
    trials = read_fit("test", tmp_path, Fitted).numbers.phase_trials
    assert [t.start for t in trials] == pytest.approx([0.0, -np.pi / 4])
    assert trials[0].sum_of_squares < 0.1 * trials[1].sum_of_squares


def test_curves_too_short_for_the_range_leave_the_reason(folders: Mapping[str, Path], tmp_path: Path) -> None:
    preset = asdict(SMALL) | {"contact_points": [6, 3], "quadrature": [3, 3, 2]}
    inputs = {
        "preset": preset,
        "orientations_deg": [0.0, 30.0],
        "load_range": [300.0, 350.0],
        "mirrored": False,
        "around": ALL,
    }
    evaluate(inputs, folders, tmp_path, lambda fraction: None)
    with pytest.raises(InputError, match="beyond the end of the FE average"):
        read_fit("own", tmp_path, Held)


def test_curves_half_a_period_apart_are_compared() -> None:
    """8 % apart everywhere; one of them alone says nothing."""
    ends = {0.0: LINE, 60.0: replace(LINE, orientation_deg=60.0, load=1.08 * LINE.load)}
    fe = ModelCurves(model="fe", by_orientation=ends, average=LINE, runs={})
    fits = AncfFits(own=None, fitted=(), kept="", fe=fe, period=120.0)
    assert fits.half_period == pytest.approx(0.08 / 1.04)
    assert replace(fits, period=90.0).half_period is None


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('free = ["young_modulus", "thickness"', 'free = ["young_modulus", "rim_thickness", "thickness"', "twice"),
        ('free = ["young_modulus"', 'free = ["colour"', "free"),
        ("circumferential_plates = 6\nfree", "circumferential_plates = 7\nfree", "multiple of the spokes"),
        ('keep = "six_spokes"', 'keep = "seven_spokes"', "is none of"),
        ('young_modulus = ["20 kPa", "50 MPa"]', 'young_modulus = ["50 MPa", "20 kPa"]', "must increase"),
        ('young_modulus = ["20 kPa", "50 MPa"]', 'young_modulus = ["20 kPa", "30 kPa"]', "within its bounds"),
        ('hub_radius = "30 mm", contact', 'hub_radius = "140 mm", contact', "hub radius must be below"),
        ('load_range = ["20 N", "250 N"]', 'load_range = ["250 N", "20 N"]', "must increase"),
        (
            "# --- The brush tire",
            '[[ancf_fit.tires]]\nname = "still"\nspokes = 3\ncircumferential_plates = 6\n'
            'free = ["young_modulus"]\nphase_starts = 2\n\n# --- The brush tire',
            "needs the phase among free",
        ),
    ],
)
def test_bad_sections_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = built_in_study().read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "study.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(StudyError, match=message):
        read_study(tmp_path / "study.toml")


def test_a_table_is_rewritten_with_its_comments() -> None:
    """An array over several lines had been cut in two."""
    text = (
        '[a]\nspokes = 4 # four\n\n[ancf]\nspokes = 4   # radial\nlist = [\n  "1",  # one\n  "2",\n]\n[b]\nspokes = 4\n'
    )
    new = rewritten_table(text, "ancf", {"spokes": 6, "list": ["3"], "phase": "0.1 rad"})
    assert new == (
        '[a]\nspokes = 4 # four\n\n[ancf]\nspokes = 6   # radial\nlist = ["3"]\nphase = "0.1 rad"\n[b]\nspokes = 4\n'
    )


def test_every_parameter_has_bounds(study: Study) -> None:
    assert study.ancf_fit is not None
    assert set(type(study.ancf_fit.bounds).model_fields) == {p.value for p in Parameter}
