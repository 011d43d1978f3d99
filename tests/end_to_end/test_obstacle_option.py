"""``workbench stiffness --obstacle``: a cleat, as by the study's own key, which then computes nothing anew."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contracts.curves import read_curve
from tests.end_to_end.small_study import run, tiny_study

CLEAT = ("--obstacle", "cleat", "--height", "20 mm", "--width", "12 mm", "--offset", "12 mm")
KEYS = '[fe.obstacle]\nshape = "cleat"\nheight = "20 mm"\nwidth = "12 mm"\nedge_radius = "5 mm"\nposition = "12 mm"\n'
GROUND = "pressed on a cleat: height 20 mm, width 12 mm, edge radius 5 mm, position 12 mm"
WHERE = ("--model", "section", "--orientation", "0", "--orientation", "15", "--store", "s")


def test_a_cleat_is_pressed_at_every_orientation_and_is_that_of_the_key(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(tiny_study(), encoding="utf-8")
    (tmp_path / "keys.toml").write_text(f"{tiny_study()}\n{KEYS}", encoding="utf-8")
    for arguments in (("study.toml", "--out", "plane"), ("study.toml", *CLEAT, "--out", "cleat")):
        ended = run("stiffness", *arguments, *WHERE, folder=tmp_path)
        assert ended.returncode == 0, ended.stderr
        assert (GROUND in ended.stdout) == ("cleat" in arguments)
    again = run("stiffness", "keys.toml", *WHERE, "--out", "keys", folder=tmp_path)
    assert (again.returncode, "0 tasks computed, 2 reused" in again.stdout) == (0, True), again.stderr
    for name in ("section_phi000.csv", "section_phi015.csv"):
        plane, cleat, keys = (read_curve(tmp_path / out / "curves" / name) for out in ("plane", "cleat", "keys"))
        np.testing.assert_array_equal(cleat.load, keys.load)
        assert cleat.source == keys.source == f"{plane.source}, {GROUND}"
        assert 0.0 < cleat.load[-1] < 0.9 * plane.load[-1]
