"""``make test-long``: runs the tests marked ``long`` and keeps the result in docs/test_long.json and docs/test_long.md.

The record names its date, commit, machine and every test with its outcome and duration, and a key: the hash of all the
sources the tests depend on. The manual (docs/hooks/site.py) shows it as current while the key holds, else as stale.

Usage: python -m tests.long_run [PYTEST ARGUMENT ...]      (with arguments nothing is kept: only some tests ran)
"""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import platform
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
RECORD = Path("docs/test_long.json")
PAGE = Path("docs/test_long.md")
MARK = "pytest.mark.long"
PACKAGES = ("contracts", "geometry", "soil", "reference_fe", "ancf_reduced", "rover_dynamics", "workbench", "studies")
COMMAND = (sys.executable, "-m", "pytest", "-m", "long", "-n", "2", "--dist", "worksteal", "--timeout", "7200")
STATE = "<!-- state -->"


def key_of(root: Path) -> str:
    """Hash of what the long tests depend on: packages, studies, pins, the marked tests and what tests share."""
    paths = {path for name in PACKAGES for path in (root / name).rglob("*") if path.is_file()}
    for path in (root / "tests").rglob("*.py"):
        if not path.name.startswith("test_") or MARK in path.read_text(encoding="utf-8"):
            paths.add(path)
    paths |= {path for path in (root / "constraints.txt", root / "pyproject.toml") if path.is_file()}
    digest = hashlib.sha256()
    for path in sorted(path for path in paths if "__pycache__" not in path.parts):
        digest.update(f"{path.relative_to(root).as_posix()}\0{path.stat().st_size}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def state_of(root: Path) -> str:
    """``current`` or ``stale``: whether the sources are those of the record; ``not run yet`` without a record."""
    if not (root / RECORD).is_file():
        return "not run yet"
    record = json.loads((root / RECORD).read_text(encoding="utf-8"))
    return "current" if record["key"] == key_of(root) else "stale"


def outcomes(report: Path) -> list[dict[str, Any]]:
    """Each test of a JUnit report: name, outcome (passed, failed or skipped) and duration [s]."""
    rows = []
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        kinds = {child.tag for child in case}
        outcome = "failed" if kinds & {"failure", "error"} else "skipped" if "skipped" in kinds else "passed"
        name = f"{case.get('classname', '').replace('.', '/')}.py::{case.get('name')}"
        rows.append({"test": name, "outcome": outcome, "seconds": round(float(case.get("time", "0")), 1)})
    return sorted(rows, key=lambda row: row["test"])


def machine() -> str:
    """Processor, cores and memory of this machine, system and Python."""
    text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    names = [line.partition(":")[2].strip() for line in text.splitlines() if line.startswith("model name")]
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    cores = len(os.sched_getaffinity(0))
    name = names[0] if names else platform.machine()
    return f"{name}, {cores} cores, {memory:.0f} GiB, Python {platform.python_version()}"


def commit() -> str:
    """Commit of the sources, with a note if they differ from it."""

    def git(*arguments: str) -> str:
        return subprocess.run(("git", *arguments), cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()

    changed = git("status", "--porcelain", "--", ".", f":!{RECORD}", f":!{PAGE}")
    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + (" with changes" if changed else "")


def page_of(record: dict[str, Any]) -> str:
    """The record as a page of the manual."""
    counts = record["counts"]
    told = ", ".join(f"{counts[name]} {name}" for name in ("passed", "failed", "skipped") if counts.get(name))
    rows = "".join(f"| `{row['test']}` | {row['outcome']} | {row['seconds']:g} |\n" for row in record["tests"])
    return f"""# Long tests

What takes minutes is left out of `make test` and run by `make test-long`: kills, fuzz, whole studies. This page and
`docs/test_long.json` are written by that command. Its key is a hash of every source the tests depend on: once they
change, the manual shows the result as stale.

{STATE}

| | |
|---|---|
| result | {told or "no test ran"} |
| date | {record["date"]} |
| commit | {record["commit"]} |
| machine | {record["machine"]} |
| wall time | {record["wall_s"] / 60:.0f} min |
| key | `{record["key"]}` |

| test | result | s |
|---|---|---|
{rows}"""


def main(arguments: list[str]) -> int:
    """Run the long tests; keep the result unless only some were asked for; pytest's exit status."""
    begun, key = datetime.datetime.now(datetime.UTC), key_of(ROOT)
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "junit.xml"
        status = subprocess.run((*COMMAND, f"--junitxml={report}", *arguments), cwd=ROOT, check=False).returncode
        if arguments or not report.is_file():
            return status
        rows = outcomes(report)
    record = {
        "schema": 1,
        "date": begun.strftime("%Y-%m-%d %H:%M UTC"),
        "commit": commit(),
        "machine": machine(),
        "key": key,
        "wall_s": round((datetime.datetime.now(datetime.UTC) - begun).total_seconds()),
        "counts": dict(Counter(row["outcome"] for row in rows)),
        "tests": rows,
    }
    (ROOT / RECORD).write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    (ROOT / PAGE).write_text(page_of(record), encoding="utf-8")
    print(f"kept in {RECORD} and {PAGE}")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
