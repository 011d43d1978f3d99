"""A small study with one defect: what the message names is a key of the file, with its value as one writes it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from contracts.errors import StudyError
from workbench.commands.studies import run_check
from workbench.execution.errors import RunError
from workbench.study.magnitudes import loosened, of_the_file, warnings_of
from workbench.study.reading import built_in_study, read_study, read_study_table
from workbench.study.sweep_points import sweep_points

MIN = """name = "min"
title = "Minimal"
[wheel.tire]
outer_radius = "142.5 mm"
width = "120 mm"
thickness = "0.6 mm"
material = "Ti"
[[wheel.springs]]
name = "springs"
count = 4
bands = [["-60 mm", "60 mm"]]
thickness = "0.5 mm"
shape = "hoop"
weld_length = "8 mm"
material = "Ti"
[wheel.outer_hub]
outer_radius = "50 mm"
thickness = "2 mm"
width = "120 mm"
material = "Ti"
[materials.Ti]
young_modulus = "113.8 GPa"
poisson_ratio = 0.342
density = "4430 kg/m^3"
yield_strength = "880 MPa"
source = "MatWeb"
[mesh]
element_size = "16 mm"
axial_size = "40 mm"
[fe]
orientations = ["0 deg"]
max_deflection = "10 mm"
points = 2
max_load = "300 N"
"""
BAND = '[reference.band]\nkind = "measured"\nsource = "s"\nuncertainty = 0\n[[reference.band.points]]\nload = "100 N"\n'
ENVIRONMENT = '[environment]\ntemperatures = ["20 degC"]\norientation = "0 deg"\n'


def _written(folder: Path, more: str, changes: dict[str, str] | None = None) -> Path:
    text = MIN
    for old, new in (changes or {}).items():
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "min.toml").write_text(text + more, encoding="utf-8")
    return folder / "min.toml"


def _complaint(folder: Path, more: str, changes: dict[str, str] | None = None) -> str:
    path = _written(folder, more, changes)
    with pytest.raises(StudyError) as caught:
        read_study(path)
    return str(caught.value).removeprefix(f"{path}: ")


REFUSED = {
    "elastic hub": ('hub = "elastic"\n', "fe.hub = elastic: needs [wheel.inner_hub]"),
    "hub study": (
        '[hub_study]\norientation = "0 deg"\ndeflections = ["9 mm"]\n',
        "hub_study = a table: needs [wheel.i",
    ),
    "band": (BAND + 'low = "50 mm"\nhigh = "9 mm"\n', "reference.band.points[0].low = 50 mm: must not exceed high"),
    "deflection of a temperature": (
        ENVIRONMENT + 'max_deflection = "11 mm"\n',
        "environment.max_deflection = 11 mm: must not exceed fe.max_deflection",
    ),
    "points of a temperature": (ENVIRONMENT + "points = 3\n", "environment.points = 3: must not exceed fe.points = 2"),
}


@pytest.mark.parametrize(("more", "wanted"), REFUSED.values(), ids=REFUSED.keys())
def test_what_a_section_cannot_have_is_refused(tmp_path: Path, more: str, wanted: str) -> None:
    assert _complaint(tmp_path, more).startswith(wanted)


@pytest.mark.parametrize(
    "more",
    ["", "[full]\nfactor = 1.7\n"],
    ids=["nothing", "finer mesh without a mesh study"],
)
def test_what_a_section_can_have_is_read(tmp_path: Path, more: str) -> None:
    assert read_study(_written(tmp_path, more)).name == "min"


STEP = '[fe.obstacle]\nshape = "step"\nedge_radius = "5 mm"\n'
PLANE = '[fe.obstacle]\nshape = "plane"\n'
FIT = '[ancf_fit]\n[[ancf_fit.tires]]\nspokes = 4\ncircumferential_plates = 4\nfree = ["phase"]\n'
SHAPES = "must be one of plane, step, cleat, half_round_rock"
NAMED = {
    "missing in a list of tables": (BAND + 'low = "5 mm"\n', "reference.band.points[0].high: is missing"),
    "missing name of a tire": (FIT, "ancf_fit.tires[0].name: is missing"),
    "empty list": (
        'snapshot_loads = []\n[sweep]\nstrip_thickness = ["1 mm"]\nloads = []\n',
        "sweep.loads = a list of 0: ",
    ),
    "yaw": (STEP + 'height = "5 mm"\nyaw = "10 deg"\n', "fe.obstacle.yaw = 10 deg: turns the ground"),
    "camber": ('camber = "-2 deg"\n', "fe.camber = -2 deg: turns the ground"),
    "height in kg": (STEP + 'height = "5 kg"\n', "fe.obstacle.height = '5 kg': must be a length"),
    "edge higher than the step": (
        STEP + 'height = "4 mm"\n',
        "fe.obstacle.edge_radius = 5 mm: must not exceed the height",
    ),
    "edge of a narrow cleat": (
        STEP.replace("step", "cleat") + 'height = "9 mm"\nwidth = "9 mm"\n',
        "fe.obstacle.edge_radius = 5 mm: must not exceed the height and half the width",
    ),
    "no height": (STEP, "fe.obstacle.height: is missing"),
    "height of a plane": (PLANE + 'height = "5 mm"\n', "fe.obstacle.height = '5 mm': is not a known key; remove it or"),
    "misspelt height": (STEP + 'heigth = "5 mm"\n', "fe.obstacle.heigth = '5 mm': is not a known key; use height"),
    "no shape": ('[fe.obstacle]\nheight = "5 mm"\n', f"fe.obstacle.shape: {SHAPES}; "),
    "wrong shape": ('[fe.obstacle]\nshape = "wall"\n', f"fe.obstacle.shape = 'wall': {SHAPES}; "),
    "shape alone": (
        'obstacle = "step"\n',
        "fe.obstacle = 'step': must be a table; write it as [fe.obstacle] and its keys",
    ),
    "text for a section": (
        '[sweep]\nstrip_thickness = ["1 mm"]\n[ancf_fit]\ntires = ["a"]\n',
        "ancf_fit.tires[0] = 'a': must be a table; write it as [[ancf_fit.tires]]",
    ),
}


@pytest.mark.parametrize(("more", "wanted"), NAMED.values(), ids=NAMED.keys())
def test_a_complaint_names_a_key_of_the_file(tmp_path: Path, more: str, wanted: str) -> None:
    assert _complaint(tmp_path, more).startswith(wanted)


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('name = "springs"', 'name = "1a"', "begin with a letter; letters, digits and _ may follow"),
        ('name = "min"', 'name = "-"', "begin with a letter or a digit; letters, digits, _, . and - may follow"),
    ],
)
def test_the_rule_of_a_name_is_its_pattern(tmp_path: Path, old: str, new: str, wanted: str) -> None:
    assert wanted in _complaint(tmp_path, "", {old: new})


SPLINE = 'shape = "spline"\npoints = '
HOOP = 'shape = "hoop"\n'


@pytest.mark.parametrize(
    ("new", "wanted"),
    [
        (HOOP + 'points = [[0.5, "70 deg"]]\n', '[0].points = (0.5, 70 deg): belong to shape = "spline"'),
        ('shape = "spline"\n', '[0].points: must be given for shape = "spline"; e.g. points = [[0.5, "70 deg"]]'),
        (HOOP + "direction = -1\n", "[0].direction = -1: has no effect on a hoop"),
        (SPLINE + '[[0.5, "70 deg"], [1.5, "90 deg"]]\n', "[0].points[1][0] = 1.5: must lie between 0"),
        (SPLINE + '[[0.05, "60 deg"]]\n', "[0].points = centreline at radius"),
        ('shape = "arc"\ndirection = true\n', "[0].direction = True: must be a number"),
    ],
)
def test_a_spring_s_own_key_is_named(tmp_path: Path, new: str, wanted: str) -> None:
    assert _complaint(tmp_path, "", {HOOP: new}).startswith(f"wheel.springs{wanted}")


def test_a_truth_is_no_number(tmp_path: Path) -> None:
    assert _complaint(tmp_path, "", {"[fe]": "order = true\n[fe]"}).startswith("mesh.order = True: must be a number")


def test_a_direction_that_says_what_is_so_anyway_is_read(tmp_path: Path) -> None:
    assert read_study(_written(tmp_path, "", {HOOP: HOOP + "direction = 1\n"})).wheel.springs[0].direction == 1


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('["-60 deg", "60 deg"]', '["60 deg", "-60 deg"]', "ancf_fit.bounds.phase = 60 deg, -60 deg: must increase"),
        (
            'contact_stiffness = "0.7 N/mm"',
            'phase = "70 deg", contact_stiffness = "0.7 N/mm"',
            "ancf_fit.tires[1].start.phase = 70 deg: must begin within its bounds",
        ),
        ('"20 kPa", "50 MPa"', '"2 MPa", "50 MPa"', "ancf_fit.tires[0].start.young_modulus = 1.5 MPa: must begin"),
        ('thickness = ["2 mm"', 'thickness = ["6.5 mm"', "ancf_fit.tires[0].start.rim_thickness = 6 mm: must begin"),
        ('["10 mm", "30 mm"]', '["20 mm", "10 mm"]', "mesh_study.deflections = 20 mm, 10 mm: must increase"),
        (
            "[tolerances]",
            "[[reference.curves]]\nfile='a'\nlabel='a'\nsource='b'\nkind='measured'\norientation='7 deg'\n[tolerances]",
            "reference.curves[0].orientation = 7 deg: must be one of fe.orientations",
        ),
    ],
)
def test_values_are_shown_as_they_are_written(tmp_path: Path, old: str, new: str, wanted: str) -> None:
    path, text = tmp_path / "study.toml", built_in_study().read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(StudyError) as caught:
        read_study(path)
    assert str(caught.value).removeprefix(f"{path}: ").startswith(wanted)


@pytest.mark.parametrize(
    ("key", "wanted"), [("ancf.width", "ancf"), ("wheel.grousers.count", "wheel.grousers"), ("rover.x", "rover")]
)
def test_a_sweep_of_a_section_that_is_not_there(tmp_path: Path, key: str, wanted: str) -> None:
    found = _complaint(tmp_path, f'[sweep]\n"{key}" = [7, 8]\n')
    assert found == f"sweep.{key}: needs [{wanted}]; add [{wanted}], or remove it from the sweep"


def test_a_sweep_of_orientations_needs_no_other_section(tmp_path: Path) -> None:
    path = _written(tmp_path, '[sweep]\norientation = ["0 deg", "15 deg"]\n')
    points = sweep_points(path, read_study_table(path))
    assert [one.study.fe.orientations[0] for one in points] == pytest.approx([0.0, 0.0, math.radians(15.0)])


STEEL = """[materials.Steel]
young_modulus = "193 GPa"
poisson_ratio = 0.29
density = "8000 kg/m^3"
yield_strength = "205 MPa"
source = "s"
"""
TOLD = {
    "section": (
        '[inferred]\n"ancf.width" = "a"\n',
        "inferred.'ancf.width' names no key of the study, which has no ancf; ",
    ),
    "all of a section": ('[inferred]\n"wheel.cone.*" = "a"\n', "which has no wheel.cone; "),
    "material": ('[inferred]\n"materials.Steel.density" = "a"\n', "which has no materials.Steel; "),
    "number": ('[inferred]\n"wheel.springs[7].count" = "a"\n', "which has no wheel.springs[7]; "),
    "unused material": (STEEL, "materials.Steel is of no part of the wheel"),
    "tolerance": (
        "[tolerances]\nmesh_uncertainty = 0.5\n",
        "mesh_uncertainty has no effect: its check needs mesh_study",
    ),
    "preset": ("[tolerances]\nancf_preset = 0.02\n", "ancf_preset has no effect: its check needs ancf.thesis_preset"),
}


@pytest.mark.parametrize(("more", "wanted"), TOLD.values(), ids=TOLD.keys())
def test_what_has_no_effect_is_told(tmp_path: Path, more: str, wanted: str) -> None:
    path = _written(tmp_path, more)
    study = read_study(path)
    (told,) = of_the_file(study)
    assert wanted in told
    assert (loosened(study), warnings_of(study)) == ((), (told,))


@pytest.mark.parametrize(
    "more",
    [
        '[inferred]\n"wheel.springs.shape" = "a"\n"wheel.*.material" = "a"\n"mesh.*" = "a"\n"wheel.cone" = "out"\n',
        '[fe.obstacle]\nshape = "plane"\n[inferred]\n"fe.contact_stiffness" = "a"\n"fe.obstacle.shape" = "a"\n',
        '[materials."a.b"]\n' + STEEL.partition("\n")[2] + '[sweep]\n"wheel.tire.material" = ["Ti", "a.b"]\n'
        '[inferred]\n"materials.a.b.density" = "a"\n',
        STEEL + '[sweep]\n"wheel.tire.material" = ["Ti", "Steel"]\n',
    ],
)
def test_nothing_is_told_of_what_has_an_effect(tmp_path: Path, more: str) -> None:
    assert of_the_file(read_study(_written(tmp_path, more))) == ()


def test_a_grid_has_no_seed(tmp_path: Path) -> None:
    found = _complaint(tmp_path, '[sweep]\nstrip_thickness = ["1 mm"]\nseed = 3\n')
    assert found == 'sweep.seed = 3: belongs to design = "latin-hypercube"; remove it'


def test_what_the_full_report_refuses_is_refused_at_once(tmp_path: Path) -> None:
    assert run_check(_written(tmp_path, '[full]\norientation_step = "10 deg"\n')) == 0
    with pytest.raises(RunError, match=r"min.toml: full.orientation_step = 7 deg: must divide 90 deg"):
        run_check(_written(tmp_path, '[full]\norientation_step = "7 deg"\n'))


def test_the_meshes_of_the_full_study_hold_its_own(tmp_path: Path) -> None:
    own = '[mesh_study]\norientation = "0 deg"\ndeflections = ["9 mm"]\n[full]\nfactor = 1.7\n'
    assert _complaint(tmp_path, own).startswith("full.factor = 1.7: must be one of full.mesh_study_factors = 1, 2, 3")
