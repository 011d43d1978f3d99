"""``workbench sample`` as a user runs it: a small record, run again over the store, read back; bad input."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.end_to_end.small_study import run, said, tiny_study
from workbench.questions.input_uncertainty.samples import samples_of
from workbench.questions.input_uncertainty.statistics import rank_correlations, told_apart

SECTION = """
[input_uncertainty]
samples = 20
seed = 5
orientations = ["0 deg"]
max_deflection = "6 mm"
points = 2
max_load = "10 kN"
"wheel.tire.thickness = wheel.springs[0].thickness" = { deviation = "0.03 mm", source = "a tolerance" }
"materials.Ti-6Al-4V.yield_strength" = { low = "800 MPa", high = "960 MPa", source = "no part in the load" }
"""
# Keys drawn as one have one value in the study.
STUDY = re.sub(r'(?m)^thickness = "0.[56] mm"', 'thickness = "0.5 mm"', tiny_study())
type Sampled = tuple[Path, list[subprocess.CompletedProcess[str]]]


@pytest.fixture(scope="module")
def sampled(tmp_path_factory: pytest.TempPathFactory) -> Sampled:
    """Folder with study and record, two runs on one store."""
    folder = tmp_path_factory.mktemp("sample")
    study = folder / "own.toml"
    study.write_text(STUDY + SECTION, encoding="utf-8")
    return folder, [run("sample", study, "--store", folder / "store") for _ in range(2)]


def _record(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "own.kept" / "input_uncertainty.json").read_text(encoding="utf-8"))
    return found


def test_the_record_holds_every_sample_and_a_second_run_computes_nothing(sampled: Sampled) -> None:
    folder, (first, again) = sampled
    assert first.returncode == again.returncode == 0, first.stderr
    assert first.stdout.count(": computed in") == 21
    assert again.stdout.count(": computed in") == 0
    record = _record(folder)
    assert record["command"] == f"workbench sample {folder / 'own.toml'}"
    assert len(record["found"]["samples"]) == 20
    assert (folder / "own.kept" / "input_uncertainty.json").stat().st_size < 300_000


def test_load_goes_with_the_thickness_and_not_with_the_yield_strength(sampled: Sampled) -> None:
    """Bending: the load's logarithm has a slope near 3 over that of the thickness; strength moves utilisation alone."""
    samples = samples_of(_record(sampled[0])["found"])
    end = samples.load[:, -1]
    thickness, strength = rank_correlations(samples.values, end)
    assert thickness > 0.99
    assert abs(strength) < told_apart(20)
    assert 2.0 < np.polyfit(np.log(samples.values[:, 0]), np.log(end), 1)[0] < 3.3


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("", "input_uncertainty: is missing"),
        (SECTION.replace("0.03 mm", "0.03 m"), "deviation = 0.03 m: must be in the unit of the value"),
        (SECTION.replace("wheel.tire.thickness", "wheel.tyre.thickness"), "is about no value of the study file"),
    ],
)
def test_what_cannot_be_sampled_is_one_message(tmp_path: Path, more: str, message: str) -> None:
    study = tmp_path / "own.toml"
    study.write_text(STUDY + more, encoding="utf-8")
    found = said("sample", study, "--store", tmp_path / "store")
    assert found.returncode == 2
    assert message in found.stderr
    assert not (tmp_path / "own.kept").exists()
