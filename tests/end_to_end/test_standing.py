"""A wheel that does not stand is told so: an arch on three stiff leaves, pressed midway between two of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import ROOT, run
from workbench.questions.model_curves import read_run

_CHANGES = {
    "count = 12": "count = 3",
    "count = 4": "count = 3",
    'thickness = "0.5 mm"': 'thickness = "2 mm"',
    "points = 9 ": "points = 4 ",
    "[mesh_study]": '[ancf_wheel]\nelement_size = "8 mm"\naxial_size = "40 mm"\n[mesh_study]',
}


@pytest.mark.parametrize("ground", ["plane", "rock"])
def test_where_and_how_a_wheel_does_not_stand_is_told(tmp_path: Path, ground: str) -> None:
    """On a plane it stands, on a rock it sways from some 26 mm on."""
    obstacle = 'obstacle = { shape = "half_round_rock", radius = "20 mm" }' if ground == "rock" else ""
    text = (ROOT / "studies" / "first.toml").read_text(encoding="utf-8")
    for old, new in {**_CHANGES, "keep_points = true ": f"{obstacle} "}.items():
        assert old in text
        text = text.replace(old, new, 1)
    (tmp_path / "arch.toml").write_text(text, encoding="utf-8")
    model = ("--model", "ancf_wheel", "--orientation", "60")
    ended = run("stiffness", "arch.toml", *model, "--out", "out", "--store", "store", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    curve = read_curve(next((tmp_path / "out" / "curves").glob("*60*.csv")))
    assert (curve.columns["negative_pivots"].max() > 0.0) == (ground == "rock")
    (folder,) = {path.parent for path in (tmp_path / "store").rglob("result.json")}
    told = read_run(folder).unstable
    if ground == "plane":
        assert told is None
        assert "stand" not in ended.stderr
    else:
        assert told is not None
        assert told.startswith("the wheel does not stand from 25.5 mm, ")
        assert told.endswith(", tire"), "what sways is the rim"
        assert f": {told}\n" in ended.stderr
