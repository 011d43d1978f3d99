"""A search by ``workbench sweep`` as a user runs it: found, confirmed, run again over what is stored, bad aims."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, said, small_study_text

SEARCH = """
[sweep]
design = "search"
samples = 12
batch = 4
scaled = true
confirm = 2
confirm_step = "60 deg"
deflections = ["5 mm"]
loads = ["20 N", "40 N"]
"wheel.tire.thickness" = { low = "0.4 mm", high = "0.9 mm" }
"wheel.springs[0].bands[1][0] = -wheel.springs[0].bands[0][1]" = { low = "15 mm", high = "45 mm" }

[sweep.aims]
load_at_5mm_N = { target = 41.25, within = 0.03 }
max_linearised_at_40N_Pa = { at_most = 100e6 }

[sweep.one_of.reading]
soft = { deflection_at_20N_m = { at_least = 1e-3 } }
stiff = { deflection_at_20N_m = { at_most = 1e-4 } }
"""


@pytest.fixture(scope="module")
def searched(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A folder with what a search left, and what it said."""
    folder = tmp_path_factory.mktemp("search")
    text = small_study_text().replace('orientations = ["0 deg"]', 'orientations = ["0 deg", "60 deg"]', 1)
    (folder / "study.toml").write_text(f"{text}\n{SEARCH}", encoding="utf-8")
    ended = run("sweep", "study.toml", "--out", "out", "--store", "store", folder=folder)
    assert ended.returncode == 0, ended.stderr
    return folder, ended.stdout


def _rows(out: Path) -> list[dict[str, str]]:
    with (out / "sweep.csv").open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.long
def test_every_point_is_judged_and_the_best_run_again(searched: tuple[Path, str]) -> None:
    """What ran again has the thickness found, two orientations of a period, and the load that was sought."""
    folder, told = searched
    assert "12 of 12 points; best: " in told
    rows = _rows(folder / "out")
    assert [int(row["point"]) for row in rows] == list(range(1, 15))
    first, again = rows[:12], rows[12:]
    ranked = sorted(first, key=lambda row: (float(row["cost"]), int(row["point"])))
    assert [row["confirms"] for row in again] == [row["point"] for row in ranked[:2]]
    assert [row["strip_scale"] for row in again] == [f"{float(row['strip_scale']):.6g}" for row in ranked[:2]]
    assert float(again[0]["load_at_5mm_N"]) == pytest.approx(float(ranked[0]["load_at_5mm_N"]), rel=0.03)
    assert all(len(row["task_key"].split()) == 2 for row in again)
    assert {row["pareto"] for row in rows} == {"0.0", "1.0"}
    assert {row["reading"] for row in rows} == {"soft"}
    assert float(ranked[0]["largest_miss"]) < float(ranked[-1]["largest_miss"])


@pytest.mark.long
def test_the_same_search_computes_nothing_again_and_a_longer_one_goes_on(searched: tuple[Path, str]) -> None:
    folder, _ = searched
    stored = {path: path.stat().st_mtime_ns for path in folder.glob("store/??/*/manifest.json")}
    assert run("sweep", "study.toml", "--out", "again", "--store", "store", folder=folder).returncode == 0
    assert _rows(folder / "again") == _rows(folder / "out")
    longer = (folder / "study.toml").read_text(encoding="utf-8").replace("samples = 12", "samples = 16")
    (folder / "longer.toml").write_text(longer, encoding="utf-8")
    assert run("sweep", "longer.toml", "--out", "longer", "--store", "store", folder=folder).returncode == 0
    kept = [{k: v for k, v in row.items() if k != "pareto"} for row in _rows(folder / "longer")[:12]]
    assert kept == [{k: v for k, v in row.items() if k != "pareto"} for row in _rows(folder / "out")[:12]]
    after = {path: path.stat().st_mtime_ns for path in folder.glob("store/??/*/manifest.json")}
    assert {path: after[path] for path in stored} == stored
    assert len(after) > len(stored)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("load_at_5mm_N", "load_at_6mm_N", "sweep.aims.load_at_6mm_N: is no number of the table; e.g. load_at_5mm_N"),
        ("wheel.springs[0].bands", "wheel.springs[7].bands", "wheel.springs[7].bands[1][0] = 30 mm: names no key"),
        (
            'low = "0.4 mm", high = "0.9 mm"',
            'low = "400 mm", high = "900 mm"',
            "sweep: none of its first points can be used: ",
        ),
    ],
)
def test_a_search_that_cannot_be_made_is_one_message(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = f"{small_study_text()}\n{SEARCH}".replace(old, new)
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    ended = said("sweep", "study.toml", "--out", "out", "--store", "store", folder=tmp_path)
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert message in line


def test_check_refuses_a_search_over_a_key_that_is_none(tmp_path: Path) -> None:
    text = f"{small_study_text()}\n{SEARCH}".replace("wheel.springs[0].bands", "wheel.springs[7].bands")
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    ended = said("check", "study.toml", folder=tmp_path)
    assert ended.returncode == 2
    assert "names no key of the study" in ended.stderr
