"""Every module of ours that a worker loads for a task lies in what the task's key covers, so that the search for
imports does not judge itself.

Source: ``sys.modules`` of a process that runs the task as a worker does, for the quickest task of each kind in a small
report. Negative control: a module that is not reached is found.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.small_study import ROOT, environment
from workbench.execution.integrity import MANIFEST
from workbench.execution.reach import PACKAGES, reached

SCRIPT = """
import json, sys
from pathlib import Path
import workbench.execution.worker
from workbench.execution.jobs import Done, Job, run_job
before = set(sys.modules)
values = json.loads(sys.argv[1])
values |= {"needs": {n: Path(p) for n, p in values["needs"].items()}, "folder": Path(values["folder"])}
answer = run_job(Job(**values), lambda fraction: None)
assert isinstance(answer, Done), answer
print(json.dumps(sorted(set(sys.modules) - before)))
"""


def _quickest(store: Path) -> dict[str, dict[str, Any]]:
    """Manifest of the quickest task of each module."""
    found: dict[str, dict[str, Any]] = {}
    for path in store.glob(f"??/*/{MANIFEST}"):
        manifest = json.loads(path.read_text(encoding="utf-8"))
        module = manifest["function"].partition(":")[0]
        if module not in found or manifest["wall_s"] < found[module]["wall_s"]:
            found[module] = manifest
    return found


def _loaded(store: Path, manifest: dict[str, Any], out: Path) -> set[str]:
    """Modules of ours that the task loads, packages that only hold others apart."""
    needs = {name: str(store / key[:2] / key) for name, key in manifest["needs"].items()}
    out.mkdir()
    job = {"name": manifest["task"], "function": manifest["function"], "inputs": manifest["inputs"]}
    command = [sys.executable, "-c", SCRIPT, json.dumps(job | {"needs": needs, "folder": str(out), "origin": {}})]
    run = subprocess.run(command, env=environment(), cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    names = {name for name in json.loads(run.stdout.splitlines()[-1]) if name.partition(".")[0] in PACKAGES}
    return {name for name in names if not any(other.startswith(f"{name}.") for other in names)}


@pytest.mark.long
def test_what_workers_load_is_what_keys_cover(
    workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    assert first_report.returncode == 0
    found = _quickest(workspace / "store")
    assert len(found) > 10
    missed = {}
    for number, (module, manifest) in enumerate(sorted(found.items())):
        loaded = _loaded(workspace / "store", manifest, tmp_path / str(number))
        assert loaded, module
        missed[module] = sorted(loaded - set(reached(module)))
        assert set(manifest["origin"]["sources"]) == set(reached(module))
    assert {module: names for module, names in missed.items() if names} == {}


def test_negative_control_what_is_not_reached_is_found() -> None:
    assert "workbench.report.page" not in reached("workbench.questions.fe.task")
    with pytest.raises(ModuleNotFoundError):
        reached("workbench.tasks.nowhere")
