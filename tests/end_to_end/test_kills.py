"""A small report killed a hundred times (SIGKILL, everything it started), anywhere from its start to its publishing.

Each round begins with an empty store and folder. A run is killed at a random moment within twice the time that a report
takes whose results are all stored, and started again, until it goes through or was killed often enough. So the kills
wander through all tasks, and through comparison and publishing at last. Each round must end with what an undisturbed
run writes, byte by byte, timings and provenance aside. The folder also holds files of the user's, one of them where a
result belongs.
"""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment
from workbench.execution.inventory import leftovers, results
from workbench.execution.store import Store

KILLS = 100
MOST_IN_A_ROUND = 30
"""Then a run is left to itself: a task that takes longer than any run may live would never end."""
SEED = 14
CHANGES = {
    r'orientations = \["0 deg", "45 deg"\]': 'orientations = ["0 deg"]',
    r'max_deflection = "34 mm"': 'max_deflection = "6 mm"',
    r"points = 9": "points = 2",
    r"points = 17": "points = 3",
    r'snapshot_loads = \["200 N"\]': 'snapshot_loads = ["20 N"]',
    r'deflections = \["10 mm", "30 mm"\]': 'deflections = ["6 mm"]',
}
USERS = {
    "notes.txt": "mine",
    "curves/fe_abaqus_2024.csv": "deflection_m,load_N\n0,0\n0.01,80\n",
    "series/my_brush.csv": "time_s,x\n0,1\n",
    "motions/own_ancf.npz": "mine",
    "fields/fe_paraview_state.vtu": "mine",
    "curves/fe_phi000.csv": "deflection_m,load_N\n0,0\n0.02,90\n",
}
"""The last one stands where the report writes its own."""


def _write_study(folder: Path) -> None:
    text = (ROOT / "studies" / "first.toml").read_text(encoding="utf-8")
    for pattern, new in CHANGES.items():
        text, count = re.subn(pattern, lambda _, new=new: new, text, count=1)
        assert count == 1, f"studies/first.toml no longer contains {pattern!r}: mend this list"
    (folder / "study.toml").write_text(text, encoding="utf-8")


def _start(folder: Path) -> subprocess.Popen[bytes]:
    """The report in a session of its own, so that all its processes can be killed at once."""
    arguments = command("report", "../study.toml", "--out", "out", "--store", "store")
    with (folder / "stdout").open("ab") as out, (folder / "stderr").open("ab") as err:
        return subprocess.Popen(
            arguments, cwd=folder, env=environment(), start_new_session=True, stdout=out, stderr=err
        )


def _fresh(folder: Path) -> Path:
    """A folder for one round, in which a user has files of their own."""
    for name, text in USERS.items():
        (folder / "out" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "out" / name).write_text(text, encoding="utf-8")
    return folder


def _whole(out: Path) -> dict[str, bytes]:
    """What must be equal byte by byte: curves, series, and the checks of the summary without the keys behind them."""
    found = {f"{p.parent.name}/{p.name}": p.read_bytes() for n in ("curves", "series") for p in (out / n).iterdir()}
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    checks = [{k: v for k, v in check.items() if k != "tasks"} for check in summary["checks"]]
    return found | {"checks": json.dumps(checks).encode(), "status": summary["status"].encode()}


def _user_texts(out: Path) -> list[str]:
    """Of every file of the user's that is left, wherever it is kept now."""
    texts = [p.read_bytes().decode("utf-8", "replace") for p in sorted(out.rglob("*")) if p.is_file()]
    return [text for text in USERS.values() if text in texts]


@pytest.mark.long
@pytest.mark.timeout(6 * 3600)
def test_a_hundred_kills_lose_nothing_and_change_no_byte(tmp_path: Path) -> None:
    _write_study(tmp_path)
    straight = _fresh(tmp_path / "straight")
    status = _start(straight).wait()
    assert status in (0, 1), (straight / "stderr").read_text(encoding="utf-8")
    wanted = _whole(straight / "out")
    draw, kills, rounds = random.Random(SEED), 0, 0
    while kills < KILLS:
        rounds += 1
        begin = time.monotonic()
        assert _start(straight).wait() == status  # all its results are stored
        length = time.monotonic() - begin
        folder = _fresh(tmp_path / f"round{rounds}")
        killed, ended = _round(folder, draw, 2.0 * length, KILLS - kills)
        kills += killed
        assert ended == status, (folder / "stderr").read_text(encoding="utf-8")
        assert _whole(folder / "out") == wanted, f"round {rounds}, seed {SEED}, after {kills} kills"
        assert _user_texts(folder / "out") == list(USERS.values()), f"round {rounds}, seed {SEED}"
        assert (folder / "out" / "kept-1" / "curves" / "fe_phi000.csv").is_file()
        assert not [p.name for p in (folder / "out").iterdir() if ".new" in p.name or "-new-" in p.name]
        store = Store(folder / "store")
        assert [one.fault for one in results(store, check=True) if one.fault] == []
        assert [one.kind for one in leftovers(store) if one.kind != "log"] == []
        shutil.rmtree(folder)
        print(f"round {rounds}: {kills} kills so far, {length:.1f} s with all results stored", flush=True)


def _round(folder: Path, draw: random.Random, longest: float, most: int) -> tuple[int, int]:
    """Kill and start again until a run goes through; how often it was killed, and the exit status at last."""
    kills, entries, allowed = 0, dict[str, int](), min(most, MOST_IN_A_ROUND)
    while True:
        process = _start(folder)
        try:
            status = process.wait(draw.uniform(0.0, longest) if kills < allowed else None)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
            found = {p.parent.name: p.stat().st_mtime_ns for p in (folder / "store").glob("??/*/manifest.json")}
            assert {k: v for k, v in found.items() if k in entries} == entries, "a finished result was lost or redone"
            entries = found
            published = (folder / "out" / ".workbench-files.json").exists()
            print(f"kill {kills}: {len(entries)} results stored{', publishing begun' if published else ''}", flush=True)
            continue
        return kills, status
