"""``workbench stiffness --soil``: softer than rigid ground, deeper, alike by solid and plates; what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import run, tiny_study


def test_a_wheel_is_pressed_into_soil_and_says_how_deep(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(tiny_study(), encoding="utf-8")
    ended = run("stiffness", "study.toml", "--soil", "grc1", "--store", "s", "--out", "soil", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "pressed into soil grc1" in ended.stdout
    assert "mm in the soil" in ended.stdout
    rigid = run("stiffness", "study.toml", "--store", "s", "--out", "rigid", folder=tmp_path)
    assert rigid.returncode == 0, rigid.stderr
    soil, hard = (read_curve(tmp_path / out / "curves" / "fe_phi000.csv") for out in ("soil", "rigid"))
    assert soil.source.endswith("pressed into soil grc1")
    assert 0.0 < soil.load[-1] < 0.8 * hard.load[-1]
    sunk = soil.columns["contact_point_penetration_m"]
    assert 0.3 * soil.deflection[-1] < sunk[-1] < soil.deflection[-1]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--model", "section"), "is not pressed into soil; fe, ancf_wheel are"),
        (("--travel", "lateral"), "leave out --travel"),
        (("--obstacle", "step", "--height", "20 mm"), "leave out --obstacle"),
    ],
)
def test_what_is_not_pressed_into_soil_is_refused(tmp_path: Path, arguments: tuple[str, ...], told: str) -> None:
    (tmp_path / "study.toml").write_text(tiny_study(), encoding="utf-8")
    ended = run("stiffness", "study.toml", "--soil", "grc1", *arguments, folder=tmp_path)
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stderr
    assert told in ended.stderr
