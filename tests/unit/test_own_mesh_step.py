"""Solids of a STEP file meshed as a wheel: joined, named, measured; what is no body of solids is one message."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from geometry.checks import check_mesh
from geometry.gmsh_session import gmsh_session
from geometry.measures import mesh_volume
from geometry.own_mesh.roles import Placement, Roles
from geometry.own_mesh.step_body import FaceRule, StepBody, StepSizes, named_faces, told
from geometry.own_mesh.step_files import read_step
from geometry.own_mesh.wheel_mesh import wheel_of_file
from tests.step_wheel import draw_disc

METRES = Placement(unit=1.0)
SIZES = StepSizes(element_size=0.05, of_solids={}, around=12)
RULES = {"bore": FaceRule(radius=(0.04, 0.04)), "tread": FaceRule(radius=(0.1, 0.1), solids=("rim",))}
ROLES = Roles(parts={"hub": ("hub",), "rim": ("rim",)}, hub=("bore",), ground=("tread",))
PARTS = ("hub", "rim")
VOLUME = 0.05 * math.pi * (0.1**2 - 0.04**2)


@pytest.fixture(scope="module")
def disc(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("step") / "disc.step"
    draw_disc(path)
    return path


@pytest.fixture(scope="module")
def body(disc: Path) -> StepBody:
    return read_step(disc, SIZES)


def test_solids_that_touch_become_one_wheel_of_their_volume(body: StepBody) -> None:
    """Of second order with 12 elements around: the volume to 1e-3; loose parts would not hang on the hub."""
    mesh = wheel_of_file(body.named(RULES, METRES), ROLES, METRES)
    check_mesh(mesh)
    assert sum(mesh_volume(mesh).values()) == pytest.approx(VOLUME, rel=1e-3)
    tread = mesh.points[np.unique(mesh.facets[mesh.facet_tags == mesh.faces["tread"]])]
    assert np.hypot(tread[:, 0], tread[:, 2]) == pytest.approx(0.1, rel=1e-3)
    assert sum(solid.volume for solid in body.solids) == pytest.approx(VOLUME, rel=1e-9)


def test_faces_are_listed_as_a_user_names_them(body: StepBody) -> None:
    lines = told(body, METRES)
    assert [line.split(":")[0] for line in lines[:2]] == ["solid 1, hub", "solid 2, rim"]
    assert "of hub: cylinder, radius 40 mm, position -25 to 25 mm, 126 cm^2" in "\n".join(lines)
    assert len(body.faces) == 6, "the face between hub and rim is none of the outside"


def test_a_face_is_named_by_number_too(body: StepBody) -> None:
    (tread,) = body.numbers(RULES["tread"], METRES)
    assert body.numbers(FaceRule(numbers=(tread,)), METRES) == (tread,)
    side = body.numbers(FaceRule(position=(0.025, 0.025)), METRES)
    assert len(side) == 2
    assert body.numbers(FaceRule(solids=("rim",), radius=(0.07, 0.1)), METRES) == tuple(
        face.number for face in body.faces if face.solid == "rim"
    )


def test_the_units_of_the_file_do_not_matter(disc: Path, tmp_path: Path) -> None:
    """The same numbers called inches are a body 25.4 times as large."""
    text = disc.read_text(encoding="utf-8")
    metres = text.replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)")
    assert metres != text
    (tmp_path / "metres.step").write_text(metres, encoding="utf-8")
    large = read_step(tmp_path / "metres.step", StepSizes(element_size=50.0, of_solids={}, around=12))
    assert sum(solid.volume for solid in large.solids) == pytest.approx(1e9 * VOLUME, rel=1e-9)
    with pytest.raises(InputError, match=r"radius of the ground faces = 100 m: is that of no wheel"):
        wheel_of_file(large.named({name: FaceRule(solids=("rim",)) for name in ("tread",)}, METRES), _held(), METRES)


def _held() -> Roles:
    return Roles(parts=ROLES.parts, hub=("hub",), ground=("tread",))


def test_a_part_has_its_own_size(disc: Path) -> None:
    fine = read_step(disc, StepSizes(element_size=0.05, of_solids={"rim": 0.02}, around=0))
    coarse, around = (read_step(disc, StepSizes(element_size=0.05, of_solids={}, around=n)) for n in (0, 36))
    counts = [{name: len(cells) for name, cells in one.file.groups.items()} for one in (coarse, fine, around)]
    assert counts[1]["rim"] > 2 * counts[0]["rim"]
    assert counts[2]["hub"] > 2 * counts[0]["hub"], "36 elements around are finer"


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        (
            FaceRule(radius=(0.12, 0.12), solids=("rim",)),
            "rule = of rim, radius 120 mm: holds for no face.*nearest are face . of rim: radius 100 mm, position -25",
        ),
        (
            FaceRule(radius=(0.01, 0.09), position=(0.03, 0.2)),
            "radius 10 to 90 mm, position 30 to 200 mm: holds for no",
        ),
        (FaceRule(solids=("tire",)), "solid = tire: is not in the file, which has hub, rim"),
        (FaceRule(numbers=(99,)), "face = 99: is no face on the outside, which are"),
    ],
)
def test_a_rule_that_holds_for_nothing_is_told(body: StepBody, rule: FaceRule, words: str) -> None:
    with pytest.raises(InputError, match=words) as told_:
        body.named({"tread": rule}, METRES)
    assert told_.value.key.startswith("faces.tread")


def test_a_wrong_axle_and_a_wrong_unit_are_asked_about(body: StepBody) -> None:
    with pytest.raises(InputError, match='with axle = "y" it holds for some'):
        body.numbers(RULES["tread"], Placement(unit=1.0, axle="z", up="x"))
    small = [replace(one, box=1e-3 * one.box) for one in body.solids]
    with pytest.raises(InputError, match=r"the file's body is 0\.2 mm across: is its unit right"):
        replace(body, solids=small).numbers(FaceRule(radius=(1.0, 1.0)), METRES)


def test_names_are_told_with_numbers_and_parts(body: StepBody) -> None:
    numbers = body.numbers_of({"side": FaceRule(position=(0.025, 0.025)), "tread": RULES["tread"]}, METRES)
    of = {
        solid: next(f.number for f in body.faces if f.solid == solid and f.number in numbers["side"]) for solid in PARTS
    }
    lines = named_faces(body, numbers, {"HUB": "middle"})
    assert lines == [
        f"side: faces {of['hub']} of middle, {of['rim']} of rim",
        f"tread: face {numbers['tread'][0]} of rim",
    ]


def test_solids_that_touch_nothing_are_named(body: StepBody, tmp_path: Path) -> None:
    body.require_joined({"Hub"})
    draw_disc(tmp_path / "loose.step", gap=1e-3)
    loose = read_step(tmp_path / "loose.step", SIZES)
    with pytest.raises(InputError, match="solids = solid 2, rim: touches no other solid; close the gap"):
        loose.require_joined({"hub"})
    loose.require_joined({"hub", "rim"})


def test_solids_with_a_gap_are_loose(tmp_path: Path) -> None:
    draw_disc(tmp_path / "loose.step", gap=1e-3)
    loose = read_step(tmp_path / "loose.step", SIZES)
    with pytest.raises(InputError, match="of rim: do not hang on the hub"):
        wheel_of_file(loose.named(RULES, METRES), ROLES, METRES)


def test_what_is_no_body_of_solids_is_told(tmp_path: Path) -> None:
    draw_disc(tmp_path / "overlap.step", gap=-1e-3)
    with pytest.raises(InputError, match="has solids that overlap: hub and rim"):
        read_step(tmp_path / "overlap.step", SIZES)
    with gmsh_session("skin") as gmsh:
        gmsh.model.occ.addRectangle(0.0, 0.0, 0.0, 1.0, 1.0)
        gmsh.model.occ.synchronize()
        gmsh.write(str(tmp_path / "skin.step"))
    with pytest.raises(InputError, match="has no solids, but 1 surfaces or curves"):
        read_step(tmp_path / "skin.step", SIZES)


@pytest.mark.parametrize("content", [b"$MeshFormat\n", b'SystemCall "touch owned";', b"ISO-10303-21;\n", b""])
def test_what_is_no_step_file_is_told(tmp_path: Path, content: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wheel.step").write_bytes(content)
    with pytest.raises(InputError, match=r"wheel\.step"):
        read_step(tmp_path / "wheel.step", SIZES)
    assert not (tmp_path / "owned").exists()


def test_a_file_cut_short_is_told(disc: Path, tmp_path: Path) -> None:
    (tmp_path / "half.step").write_bytes(disc.read_bytes()[: disc.stat().st_size // 2])
    with pytest.raises(InputError, match=r"half\.step"):
        read_step(tmp_path / "half.step", SIZES)


def test_sizes_no_mesher_could_hold_are_refused_before(disc: Path) -> None:
    with pytest.raises(InputError, match="makes at least") as told_:
        read_step(disc, StepSizes(element_size=1e-4, of_solids={}, around=0))
    assert told_.value.key == "element_size"
    assert "whose body is 200 x 50 x 200 mm" in told_.value.rule
    with pytest.raises(InputError, match=r"element size = 0\.1 mm: makes at least") as told_:
        read_step(disc, StepSizes(element_size=0.05, of_solids={"rim": 1e-4}, around=0, part_of={"rim": "tire"}))
    assert told_.value.key == "parts.tire.element_size"
    with pytest.raises(InputError, match="tire: is no solid of the file, which has hub, rim"):
        read_step(disc, StepSizes(element_size=0.05, of_solids={"tire": 0.01}, around=0))


def test_the_session_leaves_no_option_behind(disc: Path) -> None:
    with gmsh_session("outer") as gmsh:
        before = gmsh.option.getNumber("Mesh.MeshSizeMax")
        read_step(disc, SIZES)
        assert gmsh.option.getNumber("Mesh.MeshSizeMax") == before
