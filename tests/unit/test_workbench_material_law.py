"""Laws of materials in a study file: what is read, what follows from them, what is refused and where."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError, StudyError
from contracts.material_laws import J2Plasticity, MooneyRivlin, Ogden, elastic_constants, law_from
from contracts.materials import TI_6AL_4V_AGED, Material
from workbench.questions.fe.graph import fe_curve_tasks, fe_inputs
from workbench.questions.fe.question import FE
from workbench.questions.fe.task import materials_of
from workbench.questions.models.wheel_tasks import orientations_to_solve
from workbench.questions.section.graph import section_tasks, without_planar_model
from workbench.questions.strength.question import STRENGTH
from workbench.questions.study_graph import report_tasks
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.laws import other_law, plastic_parts
from workbench.study.magnitudes import warnings_of
from workbench.study.model import Study
from workbench.study.own_mesh import materials_by_part
from workbench.study.reading import built_in_study, read_study
from workbench.study.strengths import yield_strengths
from workbench.study.wheel_design import design_from

RUBBER = """
[materials.rubber]
density = "1100 kg/m^3"
source = "round numbers"

[materials.rubber.law]
kind = "mooney_rivlin"
c10 = "0.3 MPa"
c01 = "0.05 MPa"
bulk_modulus = "1 GPa"
"""
FIRST = built_in_study().with_name("first.toml")
OGDEN = (
    RUBBER.partition("kind")[0]
    + 'kind = "ogden"\nmoduli = ["0.6 MPa", "0.1 MPa"]\nexponents = [2]\nbulk_modulus = "1 GPa"\n'
)
PLASTIC = """
[materials.Ti-6Al-4V.law]
kind = "j2_plasticity"
hardening_modulus = "2 GPa"
"""
SOFTENING = PLASTIC + 'saturation_stress = "500 MPa"\nsaturation_rate = 20\n'


def study_with(tmp_path: Path, more: str, *, tire: str = "") -> Study:
    """The tutorial's study with more tables behind it, its rim of another material."""
    text = FIRST.read_text(encoding="utf-8")
    if tire:
        head, mark, rest = text.partition("[wheel.tire]")
        assert mark
        text = head + mark + rest.replace('material = "Ti-6Al-4V"', f'material = "{tire}"', 1)
    path = tmp_path / "study.toml"
    path.write_text(text + more, encoding="utf-8")
    return read_study(path)


def test_rubber_has_its_stiffness_from_its_law(tmp_path: Path) -> None:
    study = study_with(tmp_path, RUBBER, tire="rubber")
    rubber = materials_by_part(study)["tire"]
    assert rubber.law == MooneyRivlin(c10=0.3e6, c01=0.05e6, bulk_modulus=1e9)
    assert rubber.lame_mu == pytest.approx(0.7e6)
    assert rubber.lame_lambda + 2.0 / 3.0 * rubber.lame_mu == pytest.approx(1e9, rel=1e-6)


def test_small_strain_constants_are_those_of_shear_and_bulk_modulus() -> None:
    law = Ogden(moduli=(0.6e6, -0.1e6), exponents=(2.0, -2.0), bulk_modulus=1e6)
    young_modulus, poisson_ratio = elastic_constants(law)
    assert young_modulus / (2.0 * (1.0 + poisson_ratio)) == pytest.approx(0.7e6)
    assert young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)) == pytest.approx(1e6)


def test_a_law_reaches_the_solver_and_no_task_changes_without_one(tmp_path: Path) -> None:
    plain, rubber = study_with(tmp_path, ""), study_with(tmp_path, RUBBER, tire="rubber")
    assert "law" not in str(fe_inputs(plain, 0.0, [1e-3])["materials"])
    inputs = fe_inputs(rubber, 0.0, [1e-3])
    assert inputs["materials"]["tire"]["law"]["kind"] == "mooney_rivlin"
    assert materials_of(inputs)["tire"].law == materials_by_part(rubber)["tire"].law
    assert all("'law': {'kind'" not in repr(task.inputs) for task in report_tasks(plain))


def test_the_wheel_of_a_mesh_task_keeps_the_law(tmp_path: Path) -> None:
    study = study_with(tmp_path, RUBBER, tire="rubber")
    mesh = next(task for task in report_tasks(study) if task.name == "mesh")
    assert design_from(mesh.inputs["wheel"]).materials["tire"].law == materials_by_part(study)["tire"].law


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (RUBBER.replace("mooney_rivlin", "rubber"), r"materials.rubber.law.kind = 'rubber': must be one of st_venant"),
        (RUBBER.replace('c10 = "0.3 MPa"\n', ""), "materials.rubber.law.c10: is missing"),
        (RUBBER.replace("0.3 MPa", "0.3 mm"), "materials.rubber.law.c10 = '0.3 mm': must be a pressure"),
        (
            RUBBER.replace("0.3 MPa", "-0.3 MPa"),
            "materials.rubber.law.c10 = -0.3 MPa: .*c01 = 0.05 MPa gives no stiffness against shear .* -0.5 MPa",
        ),
        (OGDEN, r"materials.rubber.law.moduli = 0.6 MPa, 0.1 MPa: .*must be as many as the exponents \(2\)"),
        (OGDEN.replace("[2]", "[2, -14]"), r"law.moduli = 0.6 MPa, 0.1 MPa: .*the exponents 2, -14 .* -0.1 MPa"),
        (
            RUBBER.replace("density", 'temperature_data = "AISI 301"\ndensity'),
            "rubber.temperature_data = AISI 301.*rubber",
        ),
        (SOFTENING, "Ti-6Al-4V.law.saturation_stress = 500 MPa.*lies below yield_strength = 880 MPa"),
        ("[materials.law]\nkind = 'ogden'\nmoduli = [1]\n", r"materials.law.kind.*known key; .*\[materials.NAME.law"),
        (RUBBER.replace("c01", "mu"), "materials.rubber.law.mu"),
        (RUBBER.replace("density", 'young_modulus = "2 MPa"\ndensity'), "young_modulus.*must be left out"),
        (RUBBER.replace("density", "poisson_ratio = 0.4\ndensity"), "poisson_ratio.*must be left out"),
        (RUBBER.replace("density", 'yield_strength = "5 MPa"\ndensity'), "yield_strength.*does not yield"),
        (RUBBER.replace("mooney_rivlin", "neo_hookean"), "materials.rubber.law.c10"),
        (PLASTIC.replace("2 GPa", "-2 GPa"), "materials.Ti-6Al-4V.law.hardening_modulus"),
        (PLASTIC + "saturation_rate = 20\n", "materials.Ti-6Al-4V.law.saturation_rate.*goes with"),
        ("[materials.nothing]\ndensity = 1000\nsource = 'none'\n", "materials.nothing.young_modulus: is missing"),
    ],
)
def test_what_is_wrong_with_a_law_is_told_with_file_and_key(more: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=told) as caught:
        study_with(tmp_path, more)
    assert str(tmp_path / "study.toml") in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("[fe]", '[fe]\nmaterial_law = "mooney_rivlin"'),
        ("[fe]", '[fe]\nlaw = "ogden"'),
        ("[[wheel.springs]]", '[[wheel.springs]]\nlaw = "ogden"'),
    ],
)
def test_a_law_elsewhere_is_told_its_place(old: str, new: str, tmp_path: Path) -> None:
    path, text = tmp_path / "study.toml", FIRST.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(StudyError, match=r"law = .*; other laws stand with their material: \[materials.NAME.law\]"):
        read_study(path)


def test_rubber_of_the_second_invariant_alone_and_saturation_at_yield_are_read(tmp_path: Path) -> None:
    assert materials_by_part(study_with(tmp_path, RUBBER.replace("0.3 MPa", "0 MPa"), tire="rubber"))["tire"].law
    level = SOFTENING.replace("500 MPa", "880 MPa")
    assert "tire" in plastic_parts(study_with(tmp_path, level))


def test_parts_that_do_not_yield_are_not_judged(tmp_path: Path) -> None:
    study = study_with(tmp_path, RUBBER, tire="rubber")
    assert "tire" not in yield_strengths(study)
    assert "springs" in yield_strengths(study)
    assert STRENGTH.applies(study)
    soft = study.model_copy(update={"materials": dict.fromkeys(study.materials, study.materials["rubber"])})
    assert not STRENGTH.applies(soft)
    (pictures,) = (task for task in FE.tasks(soft) if task.name == "pictures")
    assert pictures.inputs["yield_strength"] is None


@pytest.mark.parametrize(
    ("more", "tire", "kind"), [(RUBBER, "rubber", "mooney_rivlin"), (PLASTIC, "", "j2_plasticity")]
)
def test_models_without_the_law_are_refused_with_the_reason(more: str, tire: str, kind: str, tmp_path: Path) -> None:
    study = study_with(tmp_path, more, tire=tire)
    name = tire or "Ti-6Al-4V"
    assert other_law(study) == (f"materials.{name}.law.kind", kind)
    with pytest.raises(InputError, match=rf"law.kind = {kind}: has no planar form"):
        section_tasks(study)
    assert without_ancf_wheel(study) == f"materials.{name}.law.kind = {kind}"
    assert fe_curve_tasks(study)


def test_the_law_of_a_rigid_hub_does_not_count(tmp_path: Path) -> None:
    head, mark, rest = FIRST.read_text(encoding="utf-8").partition("[wheel.outer_hub]")
    path = tmp_path / "study.toml"
    path.write_text(head + mark + rest.replace("Ti-6Al-4V", "rubber", 1) + RUBBER, encoding="utf-8")
    assert without_planar_model(read_study(path)) is None


def test_a_law_of_the_study_counts_for_materials_without_their_own(tmp_path: Path) -> None:
    own = '[materials.Ti-6Al-4V.law]\nkind = "st_venant_kirchhoff"\n'
    neo = {"material_law": "neo_hookean"}
    plain, stated = study_with(tmp_path, ""), study_with(tmp_path, own)
    assert other_law(plain.model_copy(update={"fe": plain.fe.model_copy(update=neo)})) == (
        "fe.material_law",
        "neo_hookean",
    )
    assert other_law(stated.model_copy(update={"fe": stated.fe.model_copy(update=neo)})) is None


def test_a_rover_s_wheel_is_elastic(tmp_path: Path) -> None:
    plastic = study_with(tmp_path, PLASTIC)
    assert "tire" in plastic_parts(plastic)
    with pytest.raises(InputError, match="j2_plasticity: is not in a rover's wheel"):
        orientations_to_solve(plastic)
    assert orientations_to_solve(study_with(tmp_path, RUBBER, tire="rubber"))


def test_a_fit_of_elastic_tires_to_a_plastic_wheel_is_refused(tmp_path: Path) -> None:
    text = built_in_study().read_text(encoding="utf-8")
    path = tmp_path / "study.toml"
    path.write_text(text + PLASTIC, encoding="utf-8")
    with pytest.raises(StudyError, match="ancf_fit = a table: makes elastic tires, which cannot follow tire"):
        read_study(path)


@pytest.mark.parametrize("model", ["section", "ancf_wheel"])
def test_a_sweep_of_a_model_without_the_law_is_refused(model: str, tmp_path: Path) -> None:
    sweep = f'\n[sweep]\nmodels = ["{model}"]\nstrip_thickness = ["0.5 mm", "0.6 mm"]\n'
    assert study_with(tmp_path, sweep).sweep is not None
    with pytest.raises(StudyError, match=f"sweep.models = {model}: has no law of materials.Ti-6Al-4V.law.kind = j2"):
        study_with(tmp_path, PLASTIC + sweep)


def test_samples_of_a_model_that_does_not_have_the_law_are_told(tmp_path: Path) -> None:
    study = study_with(tmp_path, PLASTIC)
    asked = read_study(built_in_study()).input_uncertainty
    told = warnings_of(study.model_copy(update={"input_uncertainty": asked}))
    assert any(line.startswith("[input_uncertainty] has no effect") for line in told)


def test_temperature_scales_stresses_of_plasticity_and_is_refused_of_rubber() -> None:
    values = {name: getattr(TI_6AL_4V_AGED, name) for name in TI_6AL_4V_AGED.__dataclass_fields__}
    law = J2Plasticity(hardening_modulus=2e9, saturation_stress=1.2e9, saturation_rate=50.0)
    cold = Material(**values | {"law": law}).at(130.15)
    assert cold.yield_strength is not None
    ratio = cold.yield_strength / 1100e6
    assert ratio > 1.1
    assert isinstance(cold.law, J2Plasticity)
    assert cold.law.hardening_modulus == pytest.approx(2e9 * ratio)
    assert cold.law.saturation_stress == pytest.approx(1.2e9 * ratio)
    assert cold.law.saturation_rate == 50.0
    rubber = law_from({"kind": "mooney_rivlin", "c10": 1e6, "bulk_modulus": 1e9})
    with pytest.raises(InputError, match="has no temperature data"):
        Material(**values | {"law": rubber, "yield_strength": None}).at(230.0)
    with pytest.raises(InputError, match="is where plasticity begins"):
        Material(**values | {"law": law, "yield_strength": None})
