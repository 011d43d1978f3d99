"""``workbench sweep`` as a user runs it: the example killed and started again, a point that fails, bad input."""

from __future__ import annotations

import csv
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment, run, said, small_study_text

EXAMPLE = ROOT / "studies" / "strip_sweep.toml"
DEADLINE = 500.0


def _manifests(store: Path) -> dict[str, int]:
    """Time of each stored result, by key."""
    return {p.parent.name: p.stat().st_mtime_ns for p in store.glob("??/*/manifest.json")}


def _rows(out: Path) -> list[dict[str, str]]:
    with (out / "sweep.csv").open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, int], subprocess.CompletedProcess[str]]:
    """The shipped example, killed (SIGKILL) after two results and run again: folder, results before, second run."""
    folder = tmp_path_factory.mktemp("sweep")
    arguments = ("sweep", EXAMPLE, "--out", folder / "out", "--store", folder / "store", "--workers", "1")
    process = subprocess.Popen(
        command(*arguments), env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    start = time.monotonic()
    while len(_manifests(folder / "store")) < 2:
        assert process.poll() is None, "the sweep ended before it could be killed"
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait(10.0)
    assert not (folder / "out").exists()
    return folder, _manifests(folder / "store"), run(*arguments)


@pytest.mark.long
def test_a_killed_sweep_goes_on(killed: tuple[Path, dict[str, int], subprocess.CompletedProcess[str]]) -> None:
    folder, before, again = killed
    assert again.returncode == 0, again.stderr
    assert again.stdout.count(": reused") == len(before) >= 2
    assert again.stdout.count(": computed in") == 6 - len(before)
    after = _manifests(folder / "store")
    assert {key: after[key] for key in before} == before
    assert re.search(r"about \d+ (s|min) left", again.stdout)
    assert list((folder / "store" / "tmp").iterdir()) == []


def test_thicker_strips_are_stiffer_and_the_base_agrees_with_itself(
    killed: tuple[Path, dict[str, int], subprocess.CompletedProcess[str]],
) -> None:
    """Bending stiffness goes with the cube of the thickness: the tangents' exponent lies near 3."""
    rows = _rows(killed[0] / "out")
    assert [row["point"] for row in rows] == list("0123456")
    assert {row["state"] for row in rows} == {"whole"}
    tangent = {(row["strip_thickness_mm"], row["orientation_deg"]): row["initial_tangent_N_per_m"] for row in rows}
    for orientation in ("0.0", "30.0"):
        ratio = float(tangent["0.65", orientation]) / float(tangent["0.55", orientation])
        assert 2.5 < (ratio - 1.0) / (0.65 / 0.55 - 1.0) < 4.5
    assert float(rows[0]["relative_l2"]) == 0.0
    assert all(len(key) == 64 for row in rows for key in row["task_key"].split())


def test_the_page_is_whole_and_drawn_in_a_browser(
    killed: tuple[Path, dict[str, int], subprocess.CompletedProcess[str]],
) -> None:
    page = killed[0] / "out" / "sweep.html"
    assert not re.search(r"""<(script|link|img)[^>]+(src|href)=["']?http""", page.read_text(encoding="utf-8"))
    chromium = shutil.which("chromium")
    if chromium is None:
        assert os.environ.get("CI") != "true", "continuous integration must have chromium"
        pytest.skip("chromium is not on PATH")
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom")
    drawn = subprocess.run([chromium, *options, page.as_uri()], capture_output=True, text=True, check=True)
    assert len(re.findall(r'class="axis-title"', drawn.stdout)) >= 6
    assert len(re.findall(r'<g class="trace scatter', drawn.stdout)) == 8  # six points, the study at both orientations
    assert "initial_tangent" not in drawn.stdout.partition("<body")[2]


def test_a_point_that_fails_does_not_lose_the_others(tmp_path: Path) -> None:
    """The ANCF tire cannot be pressed onto its hub; the point where it can, and the brush, are in the table."""
    text = small_study_text().replace('orientations = ["0 deg", "45 deg"]', 'orientations = ["0 deg"]')
    swept = '[sweep]\nmodels = ["ancf", "brush"]\nbase = false\n"ancf.max_deflection" = ["92 mm", "6 mm"]\n'
    (tmp_path / "study.toml").write_text(f"{text}\n{swept}", encoding="utf-8")
    ended = run("sweep", "study.toml", "--out", "out", "--store", "store", folder=tmp_path)
    assert ended.returncode == 2
    (message,) = ended.stderr.splitlines()
    assert message.startswith("workbench: error: study.toml: 1 of 4 curves are not whole: point 1 (ancf, failed)")
    rows = _rows(tmp_path / "out")
    assert [row["state"] for row in rows] == ["failed", "whole", "whole", "whole"]
    assert "Newton stopped" in rows[0]["note"]
    assert rows[0]["initial_tangent_N_per_m"] == ""
    assert float(rows[1]["initial_tangent_N_per_m"]) == pytest.approx(8250.0)
    assert float(rows[2]["initial_tangent_N_per_m"]) > 1000.0
    assert (tmp_path / "out" / "sweep.parquet").is_file()
    assert 'class="failed"' in (tmp_path / "out" / "sweep.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("swept", "message"),
    [
        ("", "sweep: is missing"),
        ('[sweep]\nstrip_thickness = ["0.5 mm", "0 mm"]\n', "[sweep] point 2 (strip_thickness = '0 mm'): wheel.tire"),
        ('[sweep]\norientation = ["0 deg"]\n[fe]\n', "is not valid TOML"),
    ],
)
def test_bad_input_is_one_message_before_anything_runs(tmp_path: Path, swept: str, message: str) -> None:
    (tmp_path / "study.toml").write_text(f"{small_study_text()}\n{swept}", encoding="utf-8")
    ended = said("sweep", "study.toml", "--out", "out", "--store", "store", folder=tmp_path)
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert message in line
    assert not (tmp_path / "out").exists()
    assert not (tmp_path / "store").exists()


def test_many_points_are_announced_before_they_are_read(tmp_path: Path) -> None:
    """Ten thousand took minutes without a word."""
    swept = '[sweep]\ndesign = "latin-hypercube"\nsamples = 120\nstrip_thickness = ["0.5 mm", "0 mm"]\n'
    (tmp_path / "study.toml").write_text(f"{small_study_text()}\n{swept}", encoding="utf-8")
    ended = said("sweep", "study.toml", "--out", "out", "--store", "store", folder=tmp_path)
    assert (ended.returncode, len(ended.stderr.splitlines())) == (2, 1)
    assert ended.stdout.startswith("reading 120 points, each as a whole study")


def test_a_parameter_that_no_model_reads_is_told(tmp_path: Path) -> None:
    """Equal rows had looked like a curve that it does not move."""
    swept = (
        '[sweep]\nmodels = ["brush"]\norientation = ["0 deg", "7 deg"]\nbrush.radial_stiffness = ["8 N/mm", "9 N/mm"]\n'
    )
    (tmp_path / "study.toml").write_text(f"{small_study_text()}\n{swept}", encoding="utf-8")
    ended = said("sweep", "study.toml", "--out", "out", "--store", "store", folder=tmp_path)
    assert ended.returncode == 0
    assert "sweep.orientation changes nothing that brush computes; leave it out" in ended.stderr
    assert "sweep.brush.radial_stiffness" not in ended.stderr
