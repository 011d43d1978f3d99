"""Lattice, tread and tapered springs in a study: read, named to tasks, swept, refused by what cannot have them."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from ancf_reduced.wheel.mesh import build_ancf_wheel
from contracts.errors import InputError
from geometry.lattice import Lattice
from geometry.parts import Tread
from geometry.wheel import WheelDesign, exomars_hoops
from workbench.questions.calibration import scaled_study, strip_thicknesses
from workbench.questions.wheel.graph import wheel_inputs
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.study.rewrite import rewritten_study
from workbench.study.strengths import yield_strengths
from workbench.study.sweep_points import _set_parameter
from workbench.study.wheel_design import design_from, wheel_design

LATTICE = Lattice(kind="honeycomb", cells=12, layers=2, thickness=1e-3, weld_length=6e-3, bands=((-0.05, 0.05),))
HOOPS = replace(exomars_hoops(), cone=None, impact_springs=None, inner_hub=None)


def shipped(name: str) -> Study:
    return read_study(built_in_study().with_name(f"{name}.toml"))


def table(name: str) -> dict[str, Any]:
    return tomllib.loads(Path(built_in_study().with_name(f"{name}.toml")).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", ["honeycomb", "leaves", "tread"])
def test_a_task_makes_the_studys_wheel_from_its_inputs(name: str) -> None:
    study = shipped(name)
    again, own = design_from(wheel_inputs(study)), wheel_design(study)
    assert set(again.materials) == set(own.materials)
    assert again.lattice is None or replace(again.lattice, material=own.tire.material) == own.lattice
    assert [one.mean_thickness for one in again.spring_sets] == [one.mean_thickness for one in own.spring_sets]
    assert again.ground_radius == own.ground_radius


def test_other_wheels_tasks_hear_nothing_of_them() -> None:
    """Results that were computed before there were such parts keep their keys."""
    wheel = wheel_inputs(read_study(built_in_study()))["wheel"]
    assert not {"lattice", "tread"} & wheel.keys()
    assert not any({"thickness_middle", "thickness_hub"} & springs.keys() for springs in wheel["springs"])
    assert "grousers" in wheel
    assert wheel_inputs(shipped("leaves"))["wheel"]["springs"][0]["thickness_hub"] == pytest.approx(0.8e-3)


def test_joints_are_not_judged() -> None:
    assert set(yield_strengths(shipped("honeycomb"))) == {"tire", "lattice", "outer_hub"}


@pytest.mark.parametrize(
    ("name", "lacks"),
    [("honeycomb", "wheel.lattice"), ("leaves", "springs of varying thickness"), ("tread", "wheel.tread")],
)
def test_no_ancf_wheel_of_them(name: str, lacks: str) -> None:
    assert without_ancf_wheel(shipped(name)) == lacks


@pytest.mark.parametrize(
    "design",
    [
        replace(HOOPS, spring_sets=(), lattice=LATTICE),
        replace(HOOPS, tread=Tread(thickness=5e-3)),
        replace(HOOPS, spring_sets=(replace(HOOPS.spring_sets[0], thickness_hub=1e-3),)),
    ],
    ids=["lattice", "tread", "tapered"],
)
def test_plates_of_them_are_refused(design: WheelDesign) -> None:
    with pytest.raises(InputError, match="use the solid model or the section model"):
        build_ancf_wheel(design, element_size=0.02, axial_size=0.03)


def scaled(content: dict[str, Any], factor: float) -> None:
    _set_parameter(Path("study.toml"), content, "strip_scale", factor, content)


def test_a_sweep_scales_every_thickness_of_a_strip_or_makes_it_even() -> None:
    leaves, honeycomb = table("leaves"), table("honeycomb")
    scaled(leaves, 2.0)
    keys = ("thickness", "thickness_middle", "thickness_hub")
    assert [leaves["wheel"]["springs"][0][key] for key in keys] == ["1 mm", "1 mm", "1.6 mm"]
    scaled(honeycomb, 0.5)
    assert honeycomb["wheel"]["lattice"]["thickness"] == "0.4 mm"
    _set_parameter(Path("leaves.toml"), leaves, "strip_thickness", "0.7 mm", leaves)
    assert leaves["wheel"]["springs"][0]["thickness"] == leaves["wheel"]["tire"]["thickness"] == "0.7 mm"
    assert not {"thickness_middle", "thickness_hub"} & leaves["wheel"]["springs"][0].keys()


def test_calibration_scales_walls_and_refuses_what_tapers() -> None:
    study = shipped("honeycomb")
    assert strip_thicknesses(study, 1.5) == pytest.approx({"tire": 2.25e-3, "lattice": 1.2e-3})
    assert strip_thicknesses(scaled_study(study, 1.5)) == strip_thicknesses(study, 1.5)
    path = built_in_study().with_name("honeycomb.toml")
    text = rewritten_study(path.read_text(encoding="utf-8"), {"lattice": 1.2e-3}, "note", path.parent)
    assert tomllib.loads(text)["wheel"]["lattice"]["thickness"] == "1.2000 mm"
    with pytest.raises(InputError, match="which calibrate does not scale"):
        strip_thicknesses(shipped("leaves"))
