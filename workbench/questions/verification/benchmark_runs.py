"""Runs a benchmark and its damaged copy and stores what both measured.

Verified by tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.execution.result_files import write_result

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["Numbers", "Runs", "run_with_control"]

type Numbers = dict[str, Any]
type Runs = Mapping[str, tuple[Callable[[], Numbers], Callable[[], float]]]
"""Name -> the run, and what its check measures on a damaged copy."""


def run_with_control(runs: Runs, name: str, out: Path, progress: Progress) -> int:
    """Run the negative control, which compiles most of what both need, then the benchmark: ``result.json``."""
    run, control = runs[name]
    damaged = control()
    progress(0.3)
    start = time.perf_counter()
    numbers = run()
    write_result(out, {"solve_s": time.perf_counter() - start, **numbers, "damaged": damaged})
    return 0
