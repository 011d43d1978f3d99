"""A fitted tire that does not stand, or that its mesh holds up, is told so."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import pytest

from ancf_reduced.tire.preset import thesis_preset
from workbench.questions.ancf_fit.stand_task import reasons_against, stands

SOUND = {"unstable": [], "mesh": [{"orientation_deg": 0.0, "largest": -0.04, "deflection": 0.02, "reached": 0.03}]}
LAST = {"last_deflection_m": 0.03}


def test_a_sound_tire_has_no_reason_against_it() -> None:
    assert reasons_against(SOUND | LAST) == []


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"largest": 0.06}, "twice as many plates change +6 % of its load at 20.0 mm at 0 deg"),
        ({"reached": 0.02}, "no equilibrium beyond 20.0 mm at 0 deg"),
        ({"largest": None}, "no equilibrium at 0 deg"),
    ],
)
def test_each_reason_is_one_sentence(change: dict[str, object], text: str) -> None:
    row = SOUND["mesh"][0] | change
    (found,) = reasons_against(SOUND | LAST | {"mesh": [row]})
    assert text in found


def test_negative_eigenvalues_are_told_with_load_and_place() -> None:
    row = {"orientation_deg": 15.0, "deflection": 0.021, "load": 160.4, "count": 2, "angle_deg": 30.0, "radius": 0.1}
    (found,) = reasons_against(SOUND | LAST | {"unstable": [row]})
    assert "does not stand from 21.0 mm, 160 N at 15 deg on: 2 negative eigenvalues" in found
    assert "at 30 deg, 100 mm from the axle" in found


def test_the_task_judges_the_tire_of_its_fit(tmp_path: Path) -> None:
    """The thesis' tire in a fit's place: it stands, and a doubled mesh changes its load by more than 5 %."""
    fit, out = tmp_path / "fit", tmp_path / "out"
    fit.mkdir()
    out.mkdir()
    record = {"preset": asdict(thesis_preset()), "orientations_deg": [45.0], "deflections_m": [0.010, 0.015]}
    (fit / "result.json").write_text(json.dumps(record), encoding="utf-8")
    stands({"doubled_at_deg": [45.0]}, {"fit": fit}, out, lambda _: None)
    found = json.loads((out / "result.json").read_text(encoding="utf-8"))
    assert found["unstable"] == []
    (reason,) = reasons_against(found)
    assert "its mesh decides what it carries" in reason


def test_a_fit_that_failed_has_nothing_to_look_at(tmp_path: Path) -> None:
    (tmp_path / "result.json").write_text(json.dumps({"failure": "no"}), encoding="utf-8")
    out = tmp_path / "out"
    out.mkdir()
    stands({"doubled_at_deg": [45.0]}, {"fit": tmp_path}, out, lambda _: None)
    assert json.loads((out / "result.json").read_text(encoding="utf-8"))["failure"] == "no"
