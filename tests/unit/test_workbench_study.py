"""Study files: the built-in one is read as it stands; each bad one gives one message with file, key, value and rule."""

from __future__ import annotations

import math
import re
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import StudyError
from geometry.wheel import exomars
from workbench.study.model_parameters import ancf_preset, brush_parameters
from workbench.study.reading import built_in_study, read_study
from workbench.study.wheel_design import wheel_design

HOOPS = built_in_study().parent / "exomars_hoops.toml"
TEXT = HOOPS.read_text(encoding="utf-8")


THICKNESS = r'thickness = "[^"]*"'
SHAPE = r'shape = "hoop"'
USER = '[[reference.curves]]\nfile = "none.csv"\nlabel = "a"\nkind = "measured"\nuncertainty = "3 %"\n'


def _write(tmp_path: Path, old: str, new: str) -> Path:
    """The study of the hoops with the first match of a pattern replaced."""
    text, count = re.subn(old, lambda _: new, TEXT, count=1)
    assert count == 1, f"the study no longer contains {old!r}: mend this test"
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("path", sorted((Path(__file__).parents[2] / "studies").glob("*.toml")), ids=lambda p: p.stem)
def test_every_shipped_study_is_valid(path: Path) -> None:
    assert read_study(path).name == path.stem


def test_built_in_study_is_read_in_si() -> None:
    study = read_study(built_in_study())
    assert study.name == "exomars"
    assert study.wheel.tire.outer_radius == 0.1425
    assert study.materials["Ti-6Al-4V"].young_modulus == 113.8e9
    degrees = (0, 15, 25, 40, 60, 80, 95, 105)
    assert study.fe.orientations == pytest.approx([math.radians(d) for d in degrees], abs=1e-14)
    assert study.of_the_thesis


def test_the_wheel_of_python_is_that_of_the_study() -> None:
    _require_alike(asdict(wheel_design(read_study(built_in_study()))), asdict(exomars()))


def _require_alike(found: Any, expected: Any) -> None:
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        for key, value in expected.items():
            _require_alike(found[key], value)
    elif isinstance(expected, tuple | list):
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            _require_alike(one, other)
    else:
        assert found == (pytest.approx(expected, rel=1e-12) if isinstance(expected, float) else expected)


def test_models_take_the_study_values() -> None:
    study = read_study(built_in_study())
    design = wheel_design(study)
    assert [s.name for s in design.spring_sets] == ["springs_outer", "springs_inner"]
    assert design.tire.material.density == 4430.0
    assert ancf_preset(study).contact_points == (10, 10)
    assert brush_parameters(study).cornering_stiffness == pytest.approx(850.0 * 180.0 / math.pi)


def test_shipped_ancf_and_brush_numbers_are_the_thesis_ones() -> None:
    """The study repeats the library's thesis presets; a slip in either file shows here."""
    from ancf_reduced.tire.preset import thesis_preset
    from rover_dynamics.tires.brush_tire import THESIS_BRUSH

    study = read_study(built_in_study())
    assert ancf_preset(study) == thesis_preset()
    assert brush_parameters(study) == THESIS_BRUSH


BAD: dict[str, tuple[str, str, list[str]]] = {
    "negative thickness": (THICKNESS, 'thickness = "-0.6 mm"', ["wheel.tire.thickness = '-0.6 mm'", "greater than 0"]),
    "zero thickness": (THICKNESS, "thickness = 0", ["wheel.tire.thickness = 0", "greater than 0"]),
    "wrong unit": (THICKNESS, 'thickness = "0.6 kg"', ["wheel.tire.thickness = '0.6 kg'", "must be a length"]),
    "string without unit": (THICKNESS, 'thickness = "0.6"', ["wheel.tire.thickness", "needs its unit"]),
    "full turn": (r'orientations = \["0 deg"', 'orientations = ["360 deg"', ["'360 deg': must be less than 360 deg"]),
    "few factors": (r"factors = \[1, 2, 3\]", "factors = [1]", ["must have at least 3 items"]),
    "name with a blank": (r'name = "exomars_hoops"', 'name = " "', ["must begin with a letter or a digit"]),
    "not a number": (THICKNESS, 'thickness = "thin"', ["wheel.tire.thickness = 'thin'", "must be a length"]),
    "nan with unit": (THICKNESS, 'thickness = "nan mm"', ["wheel.tire.thickness", "finite"]),
    "infinite": (THICKNESS, "thickness = inf", ["wheel.tire.thickness = inf", "finite"]),
    "boolean": (THICKNESS, "thickness = true", ["wheel.tire.thickness", "must be a length"]),
    "unknown key": (
        THICKNESS,
        'thicknes = "0.6 mm"',
        ["wheel.tire.thicknes = '0.6 mm'", "not a known key; use thickness"],
    ),
    "missing key": (THICKNESS, "", ["wheel.tire.thickness: is missing; add it"]),
    "unknown section": (r"\[wheel.tire\]", "[wheel.tyre]", ["wheel.tyre", "not a known key"]),
    "hub larger than rim": (
        r'outer_radius = "50 mm"',
        'outer_radius = "150 mm"',
        ["wheel.outer_hub.outer_radius = 150 mm", "must be smaller than the tire's inner radius"],
    ),
    "orientation nan": ('"0 deg", "15 deg"', 'nan, "15 deg"', ["fe.orientations[0] = nan", "finite"]),
    "angle without unit": ('"0 deg", "15 deg"', '0, "15 deg"', ["fe.orientations[0] = 0", "needs its unit"]),
    "orientation out of range": ('"0 deg", "15 deg"', '"400 deg", "15 deg"', ["fe.orientations[0] = '400 deg'"]),
    "springs of a set overlap": ("count = 3", "count = 40", ["wheel.springs[0].count = 40", "overlap"]),
    "unknown key in a set": (SHAPE, 'shape = "hoop"\ncolour = 1', ["wheel.springs[0].colour = 1", "not a known key"]),
    "unknown shape": (SHAPE, 'shape = "coil"', ["wheel.springs[0].shape = 'coil'", "arc"]),
    "fractional count": ("count = 3", "count = 2.5", ["wheel.springs[0].count = 2.5"]),
    "unknown material": (r'material = "[^"]*"', 'material = "cheese"', ["wheel.tire.material = cheese", "[materials]"]),
    "incompressible": ("poisson_ratio = 0.342", "poisson_ratio = 0.5", ["poisson_ratio = 0.5", "less than 0.5"]),
    "ancf hub larger than rim": (
        r'hub_radius = "50 mm"',
        'hub_radius = "130 mm"',
        ["ancf.hub_radius = 130 mm", "rim's inner radius"],
    ),
    "mesh study where nobody solves": (
        r'"0 deg", "15 deg"\]  ',
        '"0 deg", "7 deg"]  ',
        ["mesh_study.orientations = 7 deg", "must be one of fe.orientations"],
    ),
    "slope where nobody solves": (
        r"\n\[tolerances\]",
        '\nslope = { value = "8 N/mm", orientations = ["7 deg"], uncertainty = 0, kind = "measured", source = "s" }\n'
        "\n[tolerances]",
        ["reference.slope.orientations = 7 deg", "must be one of fe.orientations"],
    ),
    "mesh study off the curve": (
        r'"20 mm", "30 mm"\]',
        '"20 mm", "70 mm"]',
        ["mesh_study.deflections = 70 mm", "must not exceed fe.max_deflection"],
    ),
    "mesh study without the curves' mesh": (
        r"factors = \[.*\]",
        "factors = [1.2, 1.5, 2]",
        ["mesh_study.factors = 1.2, 1.5, 2", "must contain mesh.factor = 1"],
    ),
    "mesh study that does not refine": (
        r"factors = \[.*\]",
        "factors = [1, 2, 2]",
        ["mesh_study.factors = 1, 2, 2", "must increase"],
    ),
    "metres for millimetres": (
        'outer_radius = "142.5 mm"',
        "outer_radius = 142.5",
        ["wheel.tire.outer_radius = 142.5", "a number without a unit is SI, here 142500 mm"],
    ),
    "meshes too much alike": (
        r"factors = \[.*\]",
        "factors = [1, 1.01, 1.02]",
        ["mesh_study.factors = 1, 1.01, 1.02", "1.1 times the one before"],
    ),
    "a curve beside no run": (
        r"\n\[tolerances\]",
        f'\n{USER}source = "b"\norientation = "7 deg"\n\n[tolerances]',
        ["reference.curves[0].orientation = 7 deg", "must be one of fe.orientations"],
    ),
    "two meshes": (r"factors = \[.*\]", "factors = [1, 2]", ["mesh_study.factors", "at least 3"]),
    "small element": (
        r'element_size = "[^"]*"',
        'element_size = "0.1 mm"',
        ["mesh.element_size", "between 0.2 mm and"],
    ),
    "large element": (r'axial_size = "[^"]*"', 'axial_size = "0.6 m"', ["mesh.axial_size = '0.6 m'", "and 500 mm"]),
    "small refinement": (
        "order = 2",
        'order = 2\nrefinement = { tire = "1 um" }',
        ["mesh.refinement.tire = '1 um'", "between 0.2 mm"],
    ),
    "refinement of no part": (
        "order = 2",
        'order = 2\nrefinement = { tyre = "4 mm" }',
        ["mesh.refinement.tyre = 4 mm", "names no part of the wheel", "springs_outer"],
    ),
    "tolerance too small": (
        "relative_tolerance = 1e-8",
        "relative_tolerance = 1e-13",
        ["fe.relative_tolerance = 1e-13", "between 1e-12 and 0.0001"],
    ),
    "tolerance too large": (
        "relative_tolerance = 1e-8",
        "relative_tolerance = 1e-3",
        ["fe.relative_tolerance = 0.001", "between 1e-12 and 0.0001"],
    ),
    "soft contact": (
        r'contact_stiffness = "[^"]*"',
        "contact_stiffness = 1e5",
        ["fe.contact_stiffness = 100000.0", "between 1e6 N/m^3 and 1e15 N/m^3"],
    ),
    "no deflection": (
        r'max_deflection = "40 mm"',
        'max_deflection = "36 um"',
        ["fe.max_deflection = '36 um'", "between 0.05 mm and"],
    ),
    "deflection to the hub": (
        r'max_deflection = "40 mm"',
        'max_deflection = "92 mm"',
        ["fe.max_deflection = 92 mm", "gap between rim and hub, 91.8"],
    ),
    "ancf deflection to the hub": (
        r'max_deflection = "36 mm"\npoints = 36',
        'max_deflection = "92.5 mm"\npoints = 36',
        ["ancf.max_deflection = 92.5 mm", "gap between rim and hub, 92.5 mm"],
    ),
    "too many points": (r"points = 16", "points = 501", ["fe.points = 501", "less than or equal to 500"]),
    "one point": (r"points = 16", "points = 1", ["fe.points = 1", "greater than or equal to 2"]),
    "quadrature": ("spokes = 4", "spokes = 4\nquadrature = [5, 11, 3]", ["ancf.quadrature[1] = 11", "equal to 10"]),
    "modulus in GPa without unit": (
        r'young_modulus = "113.8 GPa"',
        "young_modulus = 113.8",
        ["materials.Ti-6Al-4V.young_modulus = 113.8", "between 1e-5 GPa and 2000 GPa"],
    ),
    "thin rim": (THICKNESS, 'thickness = "0.61 um"', ["wheel.tire.thickness = '0.61 um'", "between 0.01 mm and"]),
    "thin spring": (
        r'thickness = "[^"]*"(?=.*\nshape)',
        'thickness = "0.61 um"',
        ["wheel.springs[0].thickness = '0.61 um'", "between 0.01 mm and"],
    ),
    "no list": (
        r'snapshot_loads = \["200 N"\]',
        'snapshot_loads = "200 N"',
        ["fe.snapshot_loads = '200 N'", "must be a list"],
    ),
    "orientation twice": ('"0 deg", "15 deg"', '"15 deg", "15 deg"', ["fe.orientations", "holds 15 deg twice"]),
    "decimal comma": (THICKNESS, 'thickness = "0,6 mm"', ["wheel.tire.thickness = '0,6 mm'", "use a point"]),
    "not toml": ('name = "exomars_hoops"', "name = exomars", ["not valid TOML", "line"]),
    "no curve file": (r"\[tolerances\]", USER + 'source = "b"\n[tolerances]', ["reference.curves[0].file = none.csv"]),
    "curve without source": (r"\[tolerances\]", USER + "[tolerances]", ["reference.curves[0].source", "is missing"]),
}


@pytest.mark.parametrize(("old", "new", "wanted"), BAD.values(), ids=BAD.keys())
def test_bad_study_names_file_key_value_and_rule(tmp_path: Path, old: str, new: str, wanted: list[str]) -> None:
    path = _write(tmp_path, old, new)
    with pytest.raises(StudyError) as caught:
        read_study(path)
    message = str(caught.value)
    assert str(path) in message
    assert "\n" not in message
    for text in wanted:
        assert text in message, message


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        (r"friction_max = \S+", "friction_max = 0.3", "brush.friction_max = "),
        (r"friction_min = \S+", "friction_min = 0.9", "brush.friction_max = "),
        (r'thickness = "1\.5 mm"', 'thickness = "30 mm"', "wheel.cone.thickness = "),
        (r'outer_position = "36 mm"', 'outer_position = "59.9 mm"', "wheel.cone.outer_position = "),
        (r'outer_radius = "20 mm"', 'outer_radius = "49 mm"', "wheel.inner_hub.outer_radius = "),
        (r'bands = \[\["-15 mm", "15 mm"\]\]', 'bands = [["-70 mm", "15 mm"]]', "wheel.impact_springs.bands = "),
        (r'hub_radius = "[^"]*"', 'hub_radius = "130 mm"', "ancf.hub_radius = "),
    ],
)
def test_a_rule_of_several_numbers_blames_the_key_the_library_names(
    tmp_path: Path, old: str, new: str, key: str
) -> None:
    with pytest.raises(StudyError) as caught:
        read_study(_write(tmp_path, old, new))
    assert f": {key}" in str(caught.value)


SPLINE = """shape = "spline"
points = [[0.5, "70 deg"], [RADIUS, "100 deg"]]
"""


def test_spring_that_crosses_the_hub_is_refused(tmp_path: Path) -> None:
    new = SPLINE.replace("RADIUS", "1.3")
    path = _write(tmp_path, SHAPE, new)
    with pytest.raises(StudyError, match=r"wheel\.springs\[0\]\.points\[1\]\[0\] = 1\.3: must lie between"):
        read_study(path)


def test_sets_that_overlap_are_refused(tmp_path: Path) -> None:
    path = _write(tmp_path, re.escape('[["-20 mm", "20 mm"]]'), '[["-50 mm", "50 mm"]]')
    path.write_text(path.read_text(encoding="utf-8").replace('phase = "60 deg"', 'phase = "0 deg"'), encoding="utf-8")
    with pytest.raises(StudyError, match=r"wheel\.springs.*overlap or cross"):
        read_study(path)


def test_files_that_are_no_study(tmp_path: Path) -> None:
    empty, binary = tmp_path / "empty.toml", tmp_path / "binary.toml"
    empty.write_text("\n", encoding="utf-8")
    binary.write_bytes(b"name = \xff\xfe")
    for path, rule in (
        (tmp_path / "none.toml", "does not exist"),
        (tmp_path, "is a folder"),
        (empty, "is empty"),
        (binary, "not UTF-8"),
        (empty / "below", "cannot be read"),
    ):
        with pytest.raises(StudyError, match=rule) as caught:
            read_study(path)
        assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (f"a = {'[' * 5000}", "is not valid TOML: brackets in brackets without end"),
        (f"a = {'9' * 5000}", "is not valid TOML: a number of thousands of digits"),
        (f"{'a.' * 5000}a = 1", "has more than 2000 points in line 1"),
        (f"{'a.' * 1000}a = 1", "has tables within tables, more than 20 deep"),
    ],
    ids=["brackets", "digits", "key", "tables"],
)
def test_what_no_parser_bears(tmp_path: Path, text: str, wanted: str) -> None:
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(StudyError) as caught:
        read_study(path)
    assert wanted in str(caught.value)
    assert len(str(caught.value)) < 400


def test_unreadable_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file without read permission; refused by hand, since root may read everything."""
    path = tmp_path / "study.toml"
    path.write_text(TEXT, encoding="utf-8")

    def refuse(*_: object) -> int:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("contracts.input_file.os.open", refuse)
    with pytest.raises(StudyError, match="cannot be read"):
        read_study(path)


def test_a_material_with_a_dot_in_its_name_is_blamed_by_it(tmp_path: Path) -> None:
    numbers = 'young_modulus = 1e11\npoisson_ratio = 0.3\ndensity = 4000\nyield_strength = 1e9\nsource = "s"\n'
    own = f'[materials.x]\n{numbers}[materials."x.source.y"]\n{numbers}temperature_data = "nonsense"\n'
    with pytest.raises(StudyError, match="nonsense: temperature data is not known"):
        read_study(_write(tmp_path, r"\[mesh\]\n", f"{own}[mesh]\n"))


def test_names_that_differ_in_what_is_not_shown_are_refused(tmp_path: Path) -> None:
    """The later one had replaced the earlier one without a word."""
    own = "".join(f'[materials."steel{mark}1"]\nsource = "s"\n' for mark in ("\\t", " "))
    with pytest.raises(StudyError, match=r"name = 'steel 1': stands for two names"):
        read_study(_write(tmp_path, r"\[mesh\]\n", f"{own}[mesh]\n"))


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ('max_load = "150 N"', 'max_load = "150 N"\nsnapshot_loads = ["-200 N"]', "must be greater than 0 in SI units"),
        ('outer_radius = "142.5 mm"', 'outer_radius = "-142.5 mm"', "must be greater than 0 in SI units"),
    ],
)
def test_a_limit_of_zero_is_shown_once(tmp_path: Path, old: str, new: str, rule: str) -> None:
    text = (built_in_study().parent / "strip_sweep.toml").read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "a.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(StudyError) as caught:
        read_study(tmp_path / "a.toml")
    assert caught.value.rule == rule


def test_a_wheel_is_built_once_for_the_same_sections_only() -> None:
    """A study with another wheel, other metal or another name has another."""
    study = read_study(built_in_study())
    design = wheel_design(study)
    assert wheel_design(study.model_copy(update={"title": "again"})) is design
    tire = study.wheel.tire.model_copy(update={"thickness": 0.002})
    thick = study.model_copy(update={"wheel": study.wheel.model_copy(update={"tire": tire})})
    assert wheel_design(thick).tire.thickness == 0.002
    metal = {name: one.model_copy(update={"density": 9e3}) for name, one in study.materials.items()}
    heavy = wheel_design(study.model_copy(update={"materials": metal}))
    assert {one.density for one in heavy.materials.values()} == {9e3}
    assert wheel_design(study.model_copy(update={"name": "other"})).name == "other"
    assert wheel_design(study) is design
