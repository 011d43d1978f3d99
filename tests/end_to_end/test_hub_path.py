"""``workbench stiffness --path``: the hub along a path, its file and energies; what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.path_curve import read_path
from tests.end_to_end.small_study import run, said, tiny_study

PATH = "radial 2 mm, fore_aft 1 mm + wind_up -1 deg, fore_aft 0 mm + wind_up 0 deg"


@pytest.mark.parametrize("model", ["fe", pytest.param("ancf_wheel", marks=pytest.mark.long)])
def test_a_path_has_its_file_and_comes_back(tmp_path: Path, model: str) -> None:
    (tmp_path / "study.toml").write_text(tiny_study(), encoding="utf-8")
    where = ("--orientation", "15", "--model", model, "--out", "o", "--store", "s")
    ended = run("stiffness", "study.toml", "--path", PATH, *where, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "energies of the hub's path" in ended.stdout
    found = read_path(tmp_path / "o" / "paths" / f"{model}_phi015.csv", model, 15.0)
    assert (found.partial, len(found.places)) == (False, 1 + 5 + 4 + 4)
    np.testing.assert_allclose(found.places[9, [0, 2, 4]], [1e-3, 2e-3, -np.radians(1.0)], rtol=1e-9)
    np.testing.assert_allclose(found.places[13, [0, 4]], 0.0, atol=1e-12)
    assert found.columns["force_forward_N"][9] < found.columns["force_forward_N"][5] - 1.0
    assert 0.0 < found.work[5] < found.work[9]
    assert abs(found.work[-1] - found.stored[-1] - found.lost[-1]) < 0.02 * found.work[-1]
    again = run("stiffness", "study.toml", "--path", PATH, *where, folder=tmp_path)
    assert (again.returncode, "0 tasks computed" in again.stdout) == (0, True), again.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--path", "lateral 5 mm"], "must begin with the radial way alone"),
        (["--path", "radial 5 mm, radial 50 mm"], "must lie above zero and within fe.max_deflection, 6 mm"),
        (["--path", PATH, "--load", "20"], "load = 20 N: does not go with --path"),
        (["--path", PATH, "--travel", "lateral"], "--path: moves the hub its own way, beside --travel"),
        (["--path", PATH, "--model", "brush"], "has no hub that could be moved"),
    ],
)
def test_a_path_that_cannot_be_ends_with_one_message(tmp_path: Path, arguments: list[str], message: str) -> None:
    (tmp_path / "study.toml").write_text(tiny_study(), encoding="utf-8")
    ended = said("stiffness", "study.toml", *arguments, folder=tmp_path)
    assert (ended.returncode, message in " ".join(ended.stderr.split())) == (2, True), ended.stderr
