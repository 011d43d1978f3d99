"""Calibration on models with a known answer, and the study file it writes."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from contracts.errors import InputError
from workbench.questions.calibration import calibrate, scaled_study, strip_thicknesses
from workbench.study.reading import built_in_study, read_study
from workbench.study.rewrite import rewritten_study


def power(scale: float, exponent: float = 2.9) -> Callable[[float], float]:
    return lambda factor: scale * factor**exponent


@pytest.mark.parametrize("target", [900.0, 8250.0, 40e3])
def test_the_solid_model_meets_the_target(target: float) -> None:
    """Solid 7 % softer at every thickness: one correction is exact, to the root finder's 1e-4 of thickness."""
    found = calibrate(target, power(9000.0), power(0.93 * 9000.0))
    assert found.difference == pytest.approx(0.0, abs=6e-4)
    assert found.first.section == pytest.approx(target, rel=6e-4)
    assert found.corrected.section == pytest.approx(target / 0.93, rel=6e-4)


def test_one_correction_leaves_the_second_order() -> None:
    found = calibrate(8250.0, power(9000.0), power(8000.0, 2.7))
    assert abs(found.first.solid / 8250.0 - 1.0) > 0.05
    assert abs(found.difference) < 0.01


def test_few_runs_are_needed() -> None:
    seen: list[float] = []

    def section(factor: float) -> float:
        seen.append(factor)
        return power(9000.0)(factor)

    calibrate(8250.0, section, power(8300.0))
    assert len(seen) == len(set(seen)) <= 10


def test_a_target_out_of_reach_is_refused() -> None:
    with pytest.raises(InputError, match="target tangent"):
        calibrate(1e9, power(9000.0), power(9000.0))


def test_only_rim_and_springs_are_scaled() -> None:
    study = read_study(built_in_study())
    scaled = scaled_study(study, 1.5)
    before, after = strip_thicknesses(study), strip_thicknesses(scaled)
    assert set(before) == {"tire", "springs_outer", "springs_inner"}
    assert all(after[name] == pytest.approx(1.5 * t, abs=1e-7) for name, t in before.items())
    assert scaled.wheel.impact_springs == study.wheel.impact_springs
    assert scaled.wheel.outer_hub == study.wheel.outer_hub


def test_the_study_file_keeps_everything_else(tmp_path: Path) -> None:
    path = built_in_study()
    old = path.read_text(encoding="utf-8")
    thickness = {"tire": 0.5e-3, "springs_outer": 0.6e-3, "springs_inner": 0.7e-3}
    text = rewritten_study(old, thickness, "found by test", path.parent)
    (tmp_path / "new.toml").write_text(text, encoding="utf-8")
    assert strip_thicknesses(read_study(tmp_path / "new.toml")) == thickness
    before, after = tomllib.loads(old), tomllib.loads(text)
    for part in (
        before["wheel"]["tire"],
        *before["wheel"]["springs"],
        after["wheel"]["tire"],
        *after["wheel"]["springs"],
    ):
        del part["thickness"]
    assert after["inferred"].pop("wheel.tire.thickness") == "found by test"
    before["inferred"].pop("wheel.tire.thickness")
    assert after == before
    assert old.count("#") + 1 == text.count("#")


def test_curves_of_the_user_are_still_found() -> None:
    text = '[[reference.curves]]\nfile = "mine.csv"   # digitised\nlabel = "file"\n'
    new = rewritten_study(text, {}, "note", Path("/somewhere"))
    assert tomllib.loads(new)["reference"]["curves"] == [{"file": "/somewhere/mine.csv", "label": "file"}]
    assert "# digitised" in new


LAYOUTS = {
    "inline tables": '[wheel]\ntire = {thickness = "1 mm", a = 2}\nsprings = [{name = "s", thickness = "1 mm"}]\n',
    "dotted keys": 'wheel.tire.thickness = "1 mm"\n[[wheel.springs]]\nname = \'s\'\nthickness = """1 mm"""\n',
    "apart": '[[wheel.springs]]\nthickness="1 mm" # thin\nname="s"\n[fe]\na=1\n[wheel.tire]\nthickness = "1 mm"\n',
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_however_the_old_study_is_laid_out(layout: str) -> None:
    old = LAYOUTS[layout]
    new = tomllib.loads(rewritten_study(old, {"tire": 2e-3, "s": 3e-3}, "note", Path()))
    found = [part.pop("thickness") for part in (new["wheel"]["tire"], *new["wheel"]["springs"])]
    assert found == ["2.0000 mm", "3.0000 mm"]
    rest = tomllib.loads(old)
    del rest["wheel"]["tire"]["thickness"], rest["wheel"]["springs"][0]["thickness"]
    assert new == rest
