"""A small study with one defect: what the message names is a key of the file, with its value as one writes it."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import StudyError
from workbench.study.reading import read_study

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
BAND = '[reference]\ninitial_tangent = "8 N/mm"\nsource = "s"\n[[reference.points]]\nload = "100 N"\n'
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
    "band": (BAND + 'low = "50 mm"\nhigh = "9 mm"\n', "reference.points[0].low = 50 mm: must not exceed high"),
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
SHAPES = "must be one of plane, step, half_round_rock"
NAMED = {
    "missing in a list of tables": (BAND + 'low = "5 mm"\n', "reference.points[0].high: is missing"),
    "missing name of a tire": (FIT, "ancf_fit.tires[0].name: is missing"),
    "empty list": (
        'snapshot_loads = []\n[sweep]\nstrip_thickness = ["1 mm"]\nloads = []\n',
        "sweep.loads = a list of 0: ",
    ),
    "yaw": (STEP + 'height = "5 mm"\nyaw = "10 deg"\n', "fe.obstacle.yaw = 10 deg: turns the ground"),
    "camber": ('camber = "-2 deg"\n', "fe.camber = -2 deg: turns the ground"),
    "height in kg": (STEP + 'height = "5 kg"\n', "fe.obstacle.height = '5 kg': must be a length"),
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


def test_the_meshes_of_the_full_study_hold_its_own(tmp_path: Path) -> None:
    own = '[mesh_study]\norientation = "0 deg"\ndeflections = ["9 mm"]\n[full]\nfactor = 1.7\n'
    assert _complaint(tmp_path, own).startswith("full.factor = 1.7: must be one of full.mesh_study_factors = 1, 1.5, 2")
