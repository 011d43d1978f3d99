"""Topic: the finite elements on benchmarks with known answers, solved by the same calls as the wheel.

Verified by tests/unit/test_workbench_verification.py and tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.records import Check
from workbench.checks_verification import BENCHMARKS, benchmark_lines
from workbench.graph_fe import FE
from workbench.result_files import read_result
from workbench.study import Study
from workbench.task import Task
from workbench.topic import Topic
from workbench.verification_lines import Benchmark

if TYPE_CHECKING:
    from workbench.comparison import Comparison

__all__ = ["VERIFICATION", "Verification"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Verification:
    """Benchmarks in the order of the page, and the numbers of each task for the figures."""

    benchmarks: tuple[Benchmark, ...]
    numbers: Mapping[str, Mapping[str, Any]]

    @property
    def failed(self) -> list[Check]:
        """Checks that did not pass, those of the negative controls included."""
        return [check for b in self.benchmarks for check in b.checks if check.status != "pass"]

    @property
    def mesh_studies(self) -> dict[str, Mapping[str, float]]:
        """Title of each shell benchmark -> mesh -> difference at full load [-]."""
        titles = {b.name: b.title for b in self.benchmarks}
        return {titles[name]: numbers["meshes"] for name, numbers in self.numbers.items() if "meshes" in numbers}


def _tasks(study: Study) -> Sequence[Task]:
    function = "workbench.tasks_verification:run_benchmark"
    return [
        Task(name=_task_name(name), function=function, inputs={"benchmark": name}, cost=5.0, **FE)
        for name in BENCHMARKS
    ]


def _task_name(benchmark: str) -> str:
    return f"verify_{benchmark}"


def _read(study: Study, folders: Mapping[str, Path]) -> Verification:
    numbers = {name: read_result(folders[_task_name(name)]) for name in BENCHMARKS}
    return Verification(benchmarks=benchmark_lines(numbers), numbers=numbers)


def _checks(study: Study, found: Comparison, results: Verification) -> Sequence[Check]:
    return [check for benchmark in results.benchmarks for check in benchmark.checks]


def _figures(study: Study, results: Verification) -> Mapping[str, str]:
    from workbench.figures_verification import verification_figures

    return verification_figures(results.numbers)


def _applies(study: Study) -> bool:
    return study.verification.enabled


VERIFICATION = Topic(
    name="verification",
    title="Verification",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=_figures,
    applies=_applies,
)
