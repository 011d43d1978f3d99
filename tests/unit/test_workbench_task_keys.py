"""Keys of results: what decides a result is in its key, and nothing else."""

from __future__ import annotations

import pytest

from tests.unit.test_workbench_runner import PROBE
from workbench.execution import task as module
from workbench.execution.task import Task, task_keys


def test_key_depends_on_inputs_needs_source_and_libraries(monkeypatch: pytest.MonkeyPatch) -> None:
    def key(**changes: object) -> str:
        values = {"name": "t", "function": f"{PROBE}:add", "inputs": {"value": 1.0}}
        return task_keys((Task(**(values | changes)),))["t"]  # type: ignore[arg-type]

    keys = [key(), key(inputs={"value": 1.0000000000000002}), key(function=f"{PROBE}:crash")]
    assert key() == key(cost=5.0)
    with monkeypatch.context() as patch:
        patch.setattr(module, "reached", lambda _: {PROBE: "another text"})
        keys.append(key())
    with monkeypatch.context() as patch:
        patch.setattr(module, "library_versions", lambda _: {"numpy": "1.0"})
        keys.append(key())
    assert len(set(keys)) == len(keys)
