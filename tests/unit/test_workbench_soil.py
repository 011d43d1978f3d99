"""The question of the wheel on soil: its tasks, checks, figures, and how a rim's compliance is read from shapes.

Claims: a study with [soil] asks for the bench and both models at rest; errors and gates are those of the numbers; the
compliance of a rim whose shape is known comes back from the plates' and the solid's files. Negative controls: plates
three per cent off fail their gate; a pull too small for the slope does not climb it.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from soil.carcass import Carcass
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil
from workbench.questions.soil.bench import COLUMNS, Bench, bench_csv, run_bench, wheel_on_soil
from workbench.questions.soil.carcass_task import _shape
from workbench.questions.soil.figures import soil_figures
from workbench.questions.soil.graph import at_rest_orientation, carcass_tasks, soil_tasks, soils_of
from workbench.questions.soil.measured import CONTROLS, REFINEMENTS, controls, measured, refinements
from workbench.questions.soil.question import SOIL
from workbench.questions.soil.results import AtRest, Held, HeldRefinement, OnSoil
from workbench.study.model import stated
from workbench.study.reading import built_in_study, read_study
from workbench.study.soil_file import soil_of
from workbench.study.wheel_design import wheel_design

STUDY = read_study(built_in_study())
CARCASS = Carcass(compliance=(5e-6, 75e-6, 41e-6, 8e-6), load=200.0, source="made up")
WHEEL = WheelOnSoil(radius=0.1425, width=0.12, carcass=CARCASS, lug_height=0.003, lugs=12)


@pytest.fixture(scope="module")
def bench() -> Bench:
    return run_bench(WHEEL, soil_named("fjs1"), 200.0, (0.0, 0.1, 0.2), 3.711, towed=True)


def on_soil(bench: Bench, plates: float = 1.01, depth: float = 0.01) -> OnSoil:
    """Results with plates that carry so many times what the solid does."""
    way = np.array([0.0, 0.01, 0.02, 0.03])
    load = np.array([0.0, 60.0, 140.0, 230.0])
    fe = StiffnessCurve(
        model="fe",
        orientation_deg=15.0,
        deflection=way,
        load=load,
        columns={"contact_point_penetration_m": np.array([0.0, 0.004, 0.008, 0.012])},
        source="made up",
    )
    ancf = replace(fe, model="ancf_wheel", load=plates * load, columns={})
    rest = AtRest(orientation_deg=15.0, load=200.0, curves={"fe": fe, "ancf_wheel": ancf}, drop=0.027, sinkage=depth)
    test = measured()
    held = Held(
        slip=test.slip.tolist(),
        measured=test.values.tolist(),
        refinements=tuple(
            HeldRefinement(name=one.name, values=one.values.tolist(), errors=one.errors.tolist())
            for one in refinements(test)
        ),
    )
    return OnSoil(benches=(bench,), held=held, at_rest=rest)


def test_a_study_with_soils_asks_for_the_bench_and_both_models_at_rest() -> None:
    names = [task.name for task in soil_tasks(STUDY)]
    assert names == ["carcass_fe", "soil_bench", "soil_measured", "mesh_soil", "soil_fe", "soil_ancf_wheel"]
    by_name = {task.name: task for task in soil_tasks(STUDY)}
    law = by_name["soil_fe"].inputs["soil"]
    assert law == by_name["soil_ancf_wheel"].inputs["soil"] == pytest.approx([soils_of(STUDY)[0].modulus(0.12), 1.1])
    assert at_rest_orientation(STUDY) == pytest.approx(15.0 + math.degrees(wheel_design(STUDY).grousers.phase))  # type: ignore[union-attr]
    assert not SOIL.applies(STUDY.model_copy(update={"soil": None}))
    json.dumps([task.inputs for task in by_name.values()])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"soils": ("grc1", "fjs1", "grc1")}, "soil.soils = grc1: is the name of two of them; leave one out"),
        ({"load": 2500.0}, r"load of the wheel = 2500 N on grc1 at slip 0\.6: must be below"),
    ],
)
def test_what_no_bench_can_do_is_told_before_anything_is_computed(change: dict[str, object], message: str) -> None:
    given = {"soils": ("grc1", "fjs1"), "load": 200.0} | change
    study = STUDY.model_copy(update={"soil": stated(STUDY.soil, "soil").model_copy(update=given)})
    with pytest.raises(InputError, match=message):
        soil_tasks(study)


def test_the_reports_own_curves_tell_the_rim() -> None:
    found = carcass_tasks(STUDY, "fe")
    assert found[-1].name == "carcass_fe"
    assert [name for _, name in found[-1].inputs["curves"]][:2] == ["fe_phi000", "fe_phi015"]
    plates = carcass_tasks(STUDY, "ancf_wheel")
    assert all(task.inputs["keep_points"] for task in plates[:-1])


def test_the_checks_say_what_the_numbers_are(bench: Bench) -> None:
    checks = {check.id: check for check in SOIL.checks(STUDY, on_soil(bench))}
    assert (checks["soil.ancf_wheel"].status, checks["soil.ancf_wheel"].role) == ("pass", "gate")
    assert checks["soil.measured_pull"].status == checks["soil.measured_sinkage"].status == "pass"
    assert checks["soil.measured_torque"].status == "fail"
    assert checks["soil.slope_fjs1"].status == "fail"
    assert checks["soil.bench_drop"].value == pytest.approx(abs(0.027 / (0.02 + 0.01 * 60.0 / 90.0) - 1.0))
    pulled = replace(bench, load=0.5 * max(row.wheel.drawbar_pull for row in bench.rows))
    climbs = SOIL.checks(STUDY, on_soil(pulled))
    assert {check.status for check in climbs if check.id == "soil.slope_fjs1"} == {"pass"}


def test_plates_three_per_cent_off_fail_the_gate(bench: Bench) -> None:
    checks = {check.id: check for check in SOIL.checks(STUDY, on_soil(bench, plates=0.97))}
    assert checks["soil.ancf_wheel"].status == "fail"


def test_a_bench_goes_into_a_file_and_comes_back(bench: Bench) -> None:
    assert Bench.from_json(json.loads(json.dumps(bench.to_json()))) == bench
    lines = bench_csv(bench).splitlines()
    assert lines[1] == ",".join(COLUMNS)
    assert len(lines) == 2 + 4
    assert bench.rows[-1].wheel.slip < 0.0 < bench.gain


def test_a_range_of_the_soil_makes_a_band() -> None:
    found = run_bench(replace(WHEEL, carcass=Carcass()), soil_named("ding2011"), 200.0, (0.2,), 3.711)
    (row,) = found.rows
    assert row.low < row.wheel.drawbar_pull < row.high


def test_refinements_are_held_against_the_same_points_and_nothing_is_fitted() -> None:
    found = {one.name: one.errors for one in refinements(measured())}
    assert list(found) == list(REFINEMENTS)
    assert found["all three"] == pytest.approx([0.120, 0.232, 0.094], abs=0.002)
    assert found["plain"][0] > 2.0 * found["all three"][0]


def test_wrong_numbers_are_noticed_by_the_measured_points() -> None:
    """Beyond the limits of pull or torque, which the right ones are not all."""
    found = {one.name: one.errors for one in controls(measured())}
    assert list(found) == list(CONTROLS)
    assert all(errors[0] > 2.0 * 0.3 and errors[1] > 2.0 * 0.232 for errors in found.values())


def test_figures_hold_each_soil_twice_and_every_refinement(bench: Bench) -> None:
    found = soil_figures((bench,), on_soil(bench).held)
    assert "fjs1, rigid rim" in found["soil_pull"]
    assert "friction of the bare rim" in found["soil_measured"]


def test_a_rim_that_moved_as_a_whole_has_that_shape() -> None:
    """A shift towards the hub by 1 mm at orientation 40 degrees: w = 1 mm cos(theta)."""
    orientation = math.radians(40.0)
    angle = np.linspace(-np.pi, np.pi, 90, endpoint=False)
    down = np.array([math.sin(orientation), 0.0, -math.cos(orientation)])
    ahead = np.array([math.cos(orientation), 0.0, math.sin(orientation)])
    circle = 0.1425 * (np.cos(angle)[:, None] * down + np.sin(angle)[:, None] * ahead)
    places = np.concatenate([circle + np.array([0.0, y, 0.0]) for y in (0.0, 0.06)])
    at, way = _shape(places, np.tile(-1e-3 * down, (len(places), 1)), orientation, 0.1425)
    assert len(at) == 90
    assert way == pytest.approx(1e-3 * np.cos(at), abs=5e-6)


def test_a_soil_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(
        'exponent = 1.0\ncohesive_modulus = 0\nfrictional_modulus = 8e5\ncohesion = "1 kPa"\n'
        'friction_angle = "45 deg"\ndensity = 1600\nrim_friction = 0.9\nsource = "a box of sand"\n',
        encoding="utf-8",
    )
    soil = soil_of("mine.toml", tmp_path)
    assert (soil.name, soil.cohesion, soil.rim_friction, soil.source) == ("mine", 1000.0, 0.9, "a box of sand")
    assert soil.friction_angle == pytest.approx(math.pi / 4)
    with pytest.raises(InputError, match="ding2011"):
        soil_of("nowhere")
    (tmp_path / "mine.toml").rename(tmp_path / "ding2011.toml")
    with pytest.raises(InputError, match="ding2011: is the name of a known soil; rename the file"):
        soil_of("ding2011.toml", tmp_path)


@pytest.mark.parametrize(
    ("key", "value", "word"),
    [
        ("cohesion", "0.25", r"cohesion = 0\.25 Pa: must lie in 1 to 1e\+07 Pa; 1 kPa is 1000 of it"),
        ("frictional_modulus", "2407.4", r"frictional_modulus = 2407\.4 N/m\^\(n\+2\): must lie in 10000"),
        ("density", "1.6", r"density = 1\.6 kg/m\^3: must lie in 100 to 20000"),
        ("shear_modulus", "11.4", r"shear_modulus = 11\.4 m: must lie in 0\.0001 to 1 m; write it with its unit"),
        ("shear_modulus", "[0.01, 11.4]", r"shear_modulus = 11\.4 m"),
        ("shear_modulus", "[0, 0.01]", "soil shear modulus = 0 mm: must be finite and greater than zero"),
        ("unloading_growth", "1e300", "unloading_growth"),
        ("source", '["a", "b"]', "source = .*must be a text"),
    ],
)
def test_a_slip_of_the_unit_is_told(tmp_path: Path, key: str, value: str, word: str) -> None:
    numbers = {"exponent": "1.0", "cohesive_modulus": "0", "frictional_modulus": "8e5", "cohesion": "1000"}
    numbers |= {"friction_angle": '"45 deg"', "density": "1600", key: value}
    lines = [f"{name} = {one}" for name, one in numbers.items()]
    (tmp_path / "mine.toml").write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(InputError, match=word):
        soil_of("mine.toml", tmp_path)


def test_the_lugs_are_the_design_s_grousers() -> None:
    found = wheel_on_soil(wheel_design(STUDY))
    assert (found.lugs, found.lug_height, found.radius) == (12, pytest.approx(0.003), pytest.approx(0.1425))
