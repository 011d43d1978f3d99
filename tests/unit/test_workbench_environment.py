"""The study's section on temperature, its tasks and its checks, on curves whose answers are known."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import StudyError
from contracts.materials import AISI_301, TI_6AL_4V, TI_6AL_4V_AGED, Material
from contracts.materials_temperature import REFERENCE_TEMPERATURE
from workbench.questions.environment.question import (
    EnvironmentRun,
    Series,
    chosen_points,
    environment_checks,
    environment_tasks,
)
from workbench.study.reading import built_in_study, read_study, read_study_table, study_of

COLD = 130.15
STUDY: Any = SimpleNamespace(judged_load=250.0)


def load(d: np.ndarray) -> np.ndarray:
    """Some softening curve [N] of the deflection [m]."""
    return 9000.0 * d - 5e4 * d**2


def run(temperature: float, metal: Material = TI_6AL_4V, factor: float = 1.0, end: float = 0.04) -> EnvironmentRun:
    """The similar wheel's curve at a temperature, its load off by a factor; stress reaches 1250 MPa at 40 mm."""
    material = metal.at(temperature)
    theta, modulus = material.thermal_stretch, material.young_modulus / metal.young_modulus
    d = np.linspace(0.0, end, 81)
    columns = {"max_von_mises_tire_Pa": 1250e6 * d / 0.04}
    force = factor * theta**2 * modulus * load(d / theta)
    curve = StiffnessCurve(model="fe", orientation_deg=15.0, deflection=d, load=force, columns=columns)
    return EnvironmentRun(temperature=temperature, curve=curve, materials={"tire": material, "outer_hub": material})


def checks(*others: EnvironmentRun, reference: EnvironmentRun | None = None) -> dict[str, Any]:
    series = Series(label="as designed", reference=reference or run(REFERENCE_TEMPERATURE), others=others)
    return {check.id: check for check in environment_checks(STUDY, (series,))}


def test_a_similar_wheel_passes_and_one_per_cent_off_fails_the_gate() -> None:
    good, bad = checks(run(COLD)), checks(run(COLD, factor=1.01))
    assert good["environment.similarity"].role == "gate"
    assert (good["environment.similarity"].status, bad["environment.similarity"].status) == ("pass", "fail")
    assert good["environment.similarity"].value < 1e-5
    assert bad["environment.similarity"].value == pytest.approx(0.01, rel=0.02)


def test_the_load_ratio_is_held_against_the_modulus() -> None:
    check = checks(run(COLD))["environment.stiffness_-143C"]
    assert check.reference == pytest.approx(1.07321, abs=1e-5)
    assert check.value == pytest.approx(check.reference, rel=3e-3)
    assert check.value < check.reference  # the cold wheel is smaller
    assert checks(run(COLD, factor=1.02))["environment.stiffness_-143C"].status == "fail"


def test_first_yield_is_that_of_the_similar_wheel_at_every_orientation() -> None:
    """Elsewhere the stress is a tenth larger, so yield at -143 C comes at a tenth less deflection of the cold wheel."""
    warm, cold = run(REFERENCE_TEMPERATURE), run(COLD)
    column = "max_von_mises_tire_Pa"
    worse = replace(warm.curve, orientation_deg=0.0, columns={column: 1.1 * warm.curve.columns[column]})
    series = Series(label="as designed", reference=warm, others=(cold,), around=(warm.curve, worse))
    theta, modulus = 1.0 + cold.thermal_strain, cold.modulus_ratio
    at_20 = 0.04 * cold.materials["tire"].yield_strength / (modulus * 1.1 * 1250e6)
    found = series.first_yield(cold)
    assert found.deflection == pytest.approx(theta * at_20)
    assert found.load == pytest.approx(theta**2 * modulus * load(np.array(at_20)), rel=1e-4)
    check = {c.id: c for c in environment_checks(STUDY, (series,))}["environment.first_yield_-143C"]
    assert (check.value, check.status) == (pytest.approx(found.load), "pass")
    weak = replace(cold, materials={"tire": replace(cold.materials["tire"], yield_strength=600e6)})
    failed = {c.id: c for c in environment_checks(STUDY, (replace(series, others=(weak,)),))}
    assert failed["environment.first_yield_-143C"].status == "fail"


def test_yield_that_is_known_at_one_orientation_alone_is_not_judged() -> None:
    cold = run(COLD)
    assert "environment.first_yield_-143C" not in checks(cold)
    alone = Series(label="as designed", reference=run(REFERENCE_TEMPERATURE), others=(cold,))
    assert alone.first_yield(cold).deflection == pytest.approx(0.04 * cold.materials["tire"].yield_strength / 1250e6)


def test_metals_that_expand_differently_have_no_similar_wheel() -> None:
    mixed = replace(run(COLD), materials={"tire": TI_6AL_4V.at(COLD), "springs": AISI_301.at(COLD)})
    assert (mixed.thermal_strain, mixed.modulus_ratio) == (None, None)
    assert set(checks(mixed)) == set()


def test_without_a_source_yield_is_not_judged() -> None:
    cold = run(COLD, AISI_301)
    assert not cold.yield_is_known
    assert "environment.first_yield_-143C" not in checks(cold, reference=run(REFERENCE_TEMPERATURE, AISI_301))
    assert run(REFERENCE_TEMPERATURE, AISI_301).yield_is_known


def test_points_are_spread_and_end_with_the_last() -> None:
    deflections = [0.001 * k for k in range(1, 21)]
    assert chosen_points(deflections, 4) == [0.005, 0.010, 0.015, 0.020]
    assert chosen_points(deflections, 3)[-1] == 0.020
    assert chosen_points(deflections[:2], 8) == deflections[:2]


def test_tasks_are_one_for_each_curve_the_study_does_not_have() -> None:
    study = read_study(built_in_study())
    tasks = {task.name: task.inputs for task in environment_tasks(study)}
    names = ["-143C", "35C", "AISI_301_20C", "AISI_301_-143C"]
    assert list(tasks) == [f"environment_{name}" for name in names]
    assert tasks["environment_-143C"]["deflections"] == [0.0075, 0.0125, 0.0175, 0.025, 0.030, 0.035]
    cold = tasks["environment_-143C"]["materials"]["tire"]
    words = {"name": "Ti-6Al-4V", "source": TI_6AL_4V_AGED.source, "temperature_data": "Ti-6Al-4V"}
    assert Material(**words, **cold) == replace(TI_6AL_4V_AGED.at(COLD), name="Ti-6Al-4V")
    assert tasks["environment_AISI_301_20C"]["materials"]["outer_hub"]["young_modulus"] == 193e9


def test_variants_whose_names_differ_in_signs_alone_have_tasks_of_their_own() -> None:
    table = read_study_table(built_in_study())
    steel = table["materials"].pop("AISI 301")
    names = ["steel 1", "steel-1", "\u94c1", "\u92fc"]
    table["materials"] |= {name: steel | {"density": f"{7000 + k} kg/m^3"} for k, name in enumerate(names)}
    table["environment"]["variants"] = names
    study = study_of(built_in_study(), table)
    tasks = environment_tasks(study)
    assert len({task.name for task in tasks}) == len(tasks) == 2 + 2 * len(names)
    densities = [task.inputs["materials"]["tire"]["density"] for task in tasks[2:]]
    assert densities == [7000.0 + k for k in range(4) for _ in range(2)]


BAD = {
    "no unit": ('"-143 degC"', "-143", "environment.temperatures[0]", "a temperature needs its unit"),
    "twice": ('"35 degC"', '"-143 degC"', "environment.temperatures", "holds -143 C twice"),
    "outside the data": ('"-143 degC"', '"4 K"', "environment.temperatures", "must lie within the data"),
    "orientation": (
        'orientation = "15 deg"  ',
        'orientation = "7 deg"  ',
        "environment.orientation",
        "fe.orientations",
    ),
    "too short": ('max_deflection = "36 mm"', 'max_deflection = "1 mm"', "environment.max_deflection", "first point"),
    "variant": (r'variants = \["AISI 301"\]', 'variants = ["gold"]', "environment.variants", "is not in [materials]"),
    "data": ('temperature_data = "AISI 301"', 'temperature_data = "gold"', "temperature_data", "is not known"),
    "no data": ('temperature_data = "Ti-6Al-4V".*', "", "environment.temperatures", "has no temperature data"),
}


@pytest.mark.parametrize("case", BAD, ids=list(BAD))
def test_bad_sections_are_refused_with_key_and_rule(case: str, tmp_path: Path) -> None:
    old, new, key, rule = BAD[case]
    text = built_in_study().read_text(encoding="utf-8")
    start = text.index("[environment]") if "temperature_data" not in old else 0
    changed, count = re.subn(old, lambda _: new, text[start:], count=1)
    assert count == 1
    path = tmp_path / "study.toml"
    path.write_text(text[:start] + changed, encoding="utf-8")
    with pytest.raises(StudyError) as error:
        read_study(path)
    assert key in error.value.key
    assert rule in str(error.value)


def test_an_odd_temperature_is_told_as_it_is_though_the_list_is_sorted() -> None:
    """The study sorts them: the place in the file of a number of the study is not known."""
    table = read_study_table(built_in_study())
    table["environment"]["temperatures"] = ["20 degC", "1e-20 K", "-40 degC"]
    with pytest.raises(StudyError) as error:
        study_of(built_in_study(), table)
    assert "1e-20" in error.value.value
    assert "degC" not in error.value.value


def test_a_study_without_the_section_has_no_tasks_for_it(tmp_path: Path) -> None:
    text = built_in_study().read_text(encoding="utf-8")
    start, end = text.index("[environment]"), text.index("# --- The reduced model")
    path = tmp_path / "study.toml"
    path.write_text(text[:start] + text[end:], encoding="utf-8")
    assert read_study(path).environment is None
