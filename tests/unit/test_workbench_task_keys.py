"""Keys of results: what decides a result is in its key, and nothing else."""

from __future__ import annotations

from tests.unit.test_workbench_runner import PROBE
from workbench.execution.task import Task, task_keys


def test_key_depends_on_inputs_needs_source_and_libraries() -> None:
    def key(**changes: object) -> str:
        values = {"name": "t", "function": f"{PROBE}:add", "inputs": {"value": 1.0}, "libraries": ("numpy",)}
        return task_keys((Task(**(values | changes)),))["t"]  # type: ignore[arg-type]

    keys = [
        key(),
        key(inputs={"value": 1.0000000000000002}),
        key(function=f"{PROBE}:crash"),
        key(sources=("contracts",)),
        key(libraries=("numpy", "scipy")),
    ]
    assert len(set(keys)) == len(keys)
    assert key() == key(cost=5.0)
