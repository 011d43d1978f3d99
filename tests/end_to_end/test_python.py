"""The wheel from Python as a user would write it: the command line's numbers, its store, and no guard in the script.

Claim: `workbench.stiffness` in a plain script, on standard input (a notebook has no file either) and the command
``workbench stiffness`` compute the same bytes, and each reuses what the other stored. Tolerance: none, equal numbers,
for the tasks are the same.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import meshio
import numpy as np
import pytest

import workbench as ww
from contracts.curves import read_curve
from contracts.errors import InputError
from tests.end_to_end.small_study import ROOT, environment, run, tiny_study
from workbench.execution import runner

SCRIPT = """
import sys
import workbench as ww

curve = ww.stiffness(ww.read_study("tiny.toml"), model=sys.argv[1], orientation=0, store="store")
print(curve.load_at(0.006), *sorted({"petsc4py", "gmsh", "vtk", "matplotlib", "pandas"} & set(sys.modules)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with ``tiny.toml``, the wheel of `studies/first.toml` at 2 points on a mesh far too coarse."""
    made = tmp_path_factory.mktemp("python")
    (made / "tiny.toml").write_text(tiny_study(), encoding="utf-8")
    (made / "script.py").write_text(SCRIPT, encoding="utf-8")
    return made


def python(folder: Path, *arguments: str, given: str = "") -> str:
    """What a Python process prints, which must end well and say nothing else."""
    ended = subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=environment(), input=given, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert (ended.returncode, ended.stderr) == (0, "")
    return ended.stdout


@pytest.fixture(scope="module")
def solved(folder: Path) -> float:
    """Load [N] at 6 mm, computed by a script without ``if __name__ == "__main__"``: nothing but the load is printed."""
    printed = python(folder, "script.py", "fe").split()
    assert len(printed) == 1, printed
    return float(printed[0])


@pytest.fixture(scope="module")
def by_command(folder: Path, solved: float) -> str:
    """What ``workbench stiffness`` prints, with a store of its own."""
    ended = run("stiffness", "tiny.toml", "--out", "out", "--store", "own", folder=folder)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def test_python_and_command_compute_the_same(
    folder: Path, solved: float, by_command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "3 tasks computed, 0 reused" in by_command
    written = read_curve(folder / "out" / "curves" / "fe_phi000.csv")
    assert written.deflection[-1] == 0.006
    assert written.load[-1] == solved > 0.0
    monkeypatch.setattr(runner, "LocalWorkers", None)  # a second call starts none
    for store in ("store", "own"):
        curve = ww.stiffness(ww.read_study(folder / "tiny.toml"), orientation=360, store=folder / store)
        assert np.array_equal(curve.load, written.load)
    again = run("stiffness", "tiny.toml", "--out", "again", "--store", "store", folder=folder)
    assert "1 tasks computed, 2 reused" in again.stdout  # the footprint, which Python does not ask for
    for name in ("curves/fe_phi000.csv", "fields/fe_phi000_20N.vtu", "fe_peak_stress.csv"):
        assert (folder / "again" / name).read_bytes() == (folder / "out" / name).read_bytes()


def test_the_command_alone_writes_fields_and_stress(folder: Path, by_command: str) -> None:
    """At 20 N, which the curve reaches, and not at 10 kN."""
    out = folder / "out"
    fields = {"fe_phi000_20N.vtu", "fe_phi000_points.npz", "fe_phi000_pressure.npz", "parts.json"}
    assert {p.name for p in (out / "fields").iterdir()} == fields
    stress = meshio.read(out / "fields" / "fe_phi000_20N.vtu").point_data["von_mises_Pa"]
    header, *rows = [line.split(",") for line in (out / "fe_peak_stress.csv").read_text(encoding="utf-8").splitlines()]
    table = [dict(zip(header, row, strict=True)) for row in rows]
    assert [(row["part"], row["load_N"]) for row in table] == [(part, "20") for part in ("tire", "grousers", "springs")]
    worst = max(table, key=lambda row: float(row["utilisation"]))
    assert float(worst["max_von_mises_Pa"]) == pytest.approx(stress.max(), rel=0.5)  # there at the nodes, on average
    assert float(worst["utilisation"]) == pytest.approx(float(worst["stress_Pa"]) / 880e6)
    assert float(worst["stress_Pa"]) != float(worst["max_von_mises_Pa"])  # linearised through the thickness
    assert re.search(rf"0 deg.*20 N.*{worst['part']}.*880 MPa", by_command)
    curve = ww.stiffness(ww.read_study(folder / "tiny.toml"), orientation=0, store=folder / "own")
    assert curve.peak_stress(20.0)["stress_Pa"].to_list() == pytest.approx([float(row["stress_Pa"]) for row in table])
    assert curve.fields[20.0].read_bytes() == (out / "fields" / "fe_phi000_20N.vtu").read_bytes()


def test_other_peoples_files_stay_and_a_second_run_replaces_its_own(folder: Path, by_command: str) -> None:
    mine = folder / "mine" / "fields" / "fe_phi000_20N.vtu"
    mine.parent.mkdir(parents=True)
    mine.write_text("mine", encoding="utf-8")
    arguments = ("stiffness", "tiny.toml", "--out", "mine", "--store", "own")
    first = run(*arguments, folder=folder)
    assert first.returncode == 0
    assert "kept" in first.stdout
    assert (folder / "mine" / "kept-1" / "fields" / mine.name).read_text(encoding="utf-8") == "mine"
    assert run(*arguments, folder=folder).returncode == 0
    assert not (folder / "mine" / "kept-2").exists()


def test_without_a_file_to_run_again(folder: Path) -> None:
    """On standard input and as ``python -c``, workers start as in a script; the brush line is 8250 N/m."""
    for store, arguments, given in (("stdin", ("-", "brush"), True), ("line", ("-c", "", "brush"), False)):
        script = SCRIPT.replace('"store"', f'"{store}"')
        line = [script if one == "" else one for one in arguments]
        assert float(python(folder, *line, given=script if given else "")) == pytest.approx(49.5)


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_the_pages_code_runs(
    folder: Path, solved: float, page: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """All but what opens a report, which tests/unit/test_workbench_api.py runs."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
    kept = [block for block in blocks if "read_report" not in block]
    assert kept
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("WORKBENCH_STORE", str(folder / "store"))
    (tmp_path / "studies").mkdir()
    for name in ("my.toml", "studies/first.toml"):
        (tmp_path / name).write_text(tiny_study(), encoding="utf-8")
    names: dict[str, object] = {}
    for block in kept:
        exec(compile(block, page, "exec"), names)
    assert isinstance(names["curve"], ww.Curve)
    assert names["curve"].load_at(0.006) == solved
    matplotlib.pyplot.close("all")


def test_a_store_that_cannot_be_is_refused(folder: Path) -> None:
    place = folder / "file"
    place.write_text("no folder", encoding="utf-8")
    with pytest.raises(InputError) as raised:
        ww.stiffness(ww.read_study(folder / "tiny.toml"), model="brush", store=place)
    assert str(place) in str(raised.value)
