"""``workbench compare`` as a user runs it: files of two laboratories, a verdict, pictures, messages."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, said
from workbench.cli import _run

OURS = "deflection_m,load_N\n0,0\n0.01,88\n0.02,176\n0.03,264\n"
THEIRS = "# source: lab B\ndeflection_mm,load_kN\n0,0\n7,0.056\n15,0.12\n30,0.24\n"


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """Our curve, and a reference a tenth softer in other units on another grid; a blank and a letter in the names."""
    ours, theirs = tmp_path / "my curve.csv", tmp_path / "Prüfstand.csv"
    ours.write_text(OURS, encoding="utf-8")
    theirs.write_text(THEIRS, encoding="utf-8")
    return ours, theirs


def _refused(ended: subprocess.CompletedProcess[str], *texts: str) -> None:
    assert (ended.returncode, ended.stdout, ended.stderr.count("\n")) == (2, "", 1), ended.stderr
    assert ended.stderr.startswith("workbench: error: ")
    for text in texts:
        assert text in ended.stderr


def test_two_curves_from_anywhere(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("deflection_m,load_N\n0,0\n0.03,275\n", encoding="utf-8")
    (tmp_path / "b.csv").write_text("deflection_m,load_N,note\n0,0,1\n0.03,250,2\n", encoding="utf-8")
    ended = run("compare", tmp_path / "a.csv", tmp_path / "b.csv")
    assert ended.returncode == 0, ended.stderr
    for text in ("10.000 %", "25.000 N", "0.8333 N/mm", "energy to 250 N", "-9.09 %"):
        assert text in ended.stdout
    assert "ISO" not in ended.stdout


def test_a_rating_for_who_asks(files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    both, out = list(map(str, files)), tmp_path / "out"
    assert _run(["compare", *both, "--rating", "iso18571", "--out", str(out)]) == 0
    assert "ISO/TS 18571 rating" in capsys.readouterr().out
    found = json.loads((out / "compare.json").read_text(encoding="utf-8"))
    assert 0.5 < found["metrics"]["iso_rating"] < 1.0
    assert _run(["compare", *both, "--rating", "iso9999"]) == 2
    assert "rating = iso9999: must be iso18571" in capsys.readouterr().err


def test_a_curve_of_metres_is_told(files: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "wide.csv").write_text("deflection_m,load_N\n0,0\n8,275\n", encoding="utf-8")
    ended = said("compare", tmp_path / "wide.csv", files[1])
    assert ended.returncode == 0
    told = f"workbench: warning: {tmp_path / 'wide.csv'}: largest deflection = 8000 mm is unusual"
    assert ended.stderr.startswith(told)
    assert ended.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "status", "word"),
    [
        (("--tolerance", "15 %"), 0, "passed"),
        (("--tolerance", "5 %"), 1, "failed"),
        (("--tolerance", "12 %", "--uncertainty", "3 %"), 1, "undecided"),
        (("--tolerance", "15 %", "--uncertainty", "3 %"), 0, "passed"),
    ],
)
def test_the_verdict_is_the_exit_status(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str], options: tuple[str, ...], status: int, word: str
) -> None:
    assert _run(["compare", *map(str, files), *options]) == status
    shown = capsys.readouterr()
    assert shown.err == ""
    assert f"\n{word}: Relative L2 difference 10.000 %" in shown.out


def test_pages_and_numbers(files: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "out put"
    ended = run("compare", *files, "--tolerance", "5 %", "--uncertainty", "1 %", "--out", out)
    assert ended.returncode == 1, ended.stderr
    assert sorted(p.name for p in out.glob("[!.]*")) == ["compare.csv", "compare.html", "compare.json", "compare.png"]
    found = json.loads((out / "compare.json").read_text(encoding="utf-8"))
    assert found["reference"] == {"name": "Prüfstand", "source": "lab B"}
    assert found["judgement"]["outcome"] == "failed"
    assert found["judgement"]["uncertainty"] == pytest.approx(0.01)
    assert found["energies"]["reference"] == pytest.approx(0.5 * 240.0 * 0.03)
    assert found["tangents"]["largest"] == pytest.approx(800.0, rel=1e-6)
    page = (out / "compare.html").read_text(encoding="utf-8")
    assert "my curve against Prüfstand" in page
    assert (out / "compare.png").read_bytes().startswith(b"\x89PNG")


def test_a_sliver_in_common_is_no_verdict(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sliver = tmp_path / "sliver.csv"
    sliver.write_text("deflection_mm,load_N\n0,0\n0.2,1.6\n", encoding="utf-8")
    assert _run(["compare", str(sliver), str(files[1]), "--tolerance", "5 %"]) == 1
    assert "\nundecided: Relative L2 difference 0.000 %, of the common range alone" in capsys.readouterr().out
    assert _run(["compare", str(sliver), str(files[1])]) == 0
    assert "\nnot judged: " in capsys.readouterr().out
    assert _run(["compare", str(sliver), str(files[1]), "--max-load", "3 N", "--tolerance", "50 %"]) == 0
    assert "\npassed: " in capsys.readouterr().out


def test_bad_input_writes_nothing(files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ours, _ = files
    plates = tmp_path / "plates.csv"
    plates.write_text("diameter_change_mm,load_N\n0,0\n30,240\n", encoding="utf-8")
    out = tmp_path / "out"
    _refused(run("compare", ours, plates, "--out", out), "neither follows from the other", "plates")
    for option, value in (
        ("--tolerance", "5 N"),
        ("--uncertainty", "lots"),
        ("--max-load", "-1 N"),
        ("--max-load", "3 mm"),
        ("--max-load", "1e-9"),
        ("--max-load", "1e300"),
        ("--max-load", "2 N"),
        ("--tolerance", "1e-300 %"),
    ):
        assert _run(["compare", *map(str, files), option, value, "--out", str(out)]) == 2
        assert f"= {value}" in capsys.readouterr().err
    assert not out.exists()
