"""``workbench modes`` as a user runs it: both models of the tutorial's wheel on a coarse mesh, and bad input.

Claim: plates and solid have the same modes: frequencies within 1.5 %, shapes with a criterion above 0.99.
Tolerance: the coarse mesh of the solid, 24 mm along its strips.
"""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, said, tiny_study


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.long
def test_both_models_have_the_same_modes(tmp_path: Path) -> None:
    study = tmp_path / "wheel.toml"
    study.write_text(tiny_study(), encoding="utf-8")
    asked = ("modes", study, "--model", "both", "--count", "6", "--store", tmp_path / "s")
    ended = run(*asked, "--out", tmp_path / "o")
    assert ended.returncode == 0, ended.stderr
    for text in ("torsional", "sum, %", "the same modes by both models", "4 tasks computed, 0 reused"):
        assert text in ended.stdout
    pairs = table(tmp_path / "o" / "modes" / "modes_compared_held.csv")
    assert len(pairs) == 6
    for row in pairs:
        assert abs(float(row["difference"])) < 0.015, row
        assert float(row["mac"]) > 0.99, row
    rows = table(tmp_path / "o" / "modes" / "modes_fe_held.csv")
    assert rows[0]["kind"] == "torsional"
    assert float(rows[0]["effective_mass_ry"]) == pytest.approx(float(rows[0]["participation_ry"]) ** 2)
    for model in ("fe", "ancf_wheel"):
        vtu = (tmp_path / "o" / "modes" / f"modes_{model}_held.vtu").read_bytes()
        assert vtu.count(b"mode_0") >= 6
    again = run(*asked, "--out", tmp_path / "o2")
    assert "0 tasks computed, 4 reused" in again.stdout
    names = [p.name for p in sorted((tmp_path / "o" / "modes").iterdir())]
    for name in names:
        assert (tmp_path / "o" / "modes" / name).read_bytes() == (tmp_path / "o2" / "modes" / name).read_bytes()


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--model", "brush"), "has no modes; give fe, ancf_wheel or both"),
        (("--state", "rolling"), "give free, held, standing"),
        (("--load", "100"), "is of no use to --state held"),
        (("--state", "standing", "--load", "nan"), "must lie between"),
        (("--count", "0"), "must lie between 1 and 100"),
        (("no_such_study.toml",), "no_such_study.toml"),
    ],
)
def test_bad_choices_are_one_message(options: tuple[str, ...], text: str, tmp_path: Path) -> None:
    ended = said("modes", *options, "--out", tmp_path / "o", "--store", tmp_path / "s")
    assert ended.returncode == 2
    assert text in ended.stderr
    assert ended.stderr.count("\n") == 1
