"""Task: work and precision of the multibody engine on one problem.

Verified by tests/unit/test_workbench_multibody.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_dynamics.multibody.verification.work_precision import PROBLEMS, compile_loops, control_for, work
from workbench.execution.result_files import write_result

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["measure_work"]


def measure_work(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``: a row for each kind of steps and error allowed; compiling is not counted."""
    problem = PROBLEMS[inputs["problem"]]
    asked = [(method, allowed) for method in ("explicit", "implicit") for allowed in inputs[method]]
    for method in ("explicit", "implicit"):
        compile_loops(problem, control_for(method, 1e-6))
    rows = []
    for k, (method, allowed) in enumerate(asked):
        rows.append({"method": method, "allowed": allowed, **asdict(work(problem, control_for(method, allowed)))})
        progress((k + 1) / len(asked))
    write_result(out, {"rows": rows})
    return 6 * len(problem.model().bodies)
