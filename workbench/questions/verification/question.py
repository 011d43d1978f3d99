"""Question: finite elements and ANCF plates on benchmarks with known answers, solved by the same calls as the wheel.

Verified by tests/unit/test_workbench_verification.py and tests/end_to_end/test_verification.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contracts.records import Check
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.question import Question
from workbench.questions.verification.checks import BENCHMARKS
from workbench.questions.verification.checks_ancf import ANCF_BENCHMARKS
from workbench.questions.verification.figures import ancf_verification_figures, verification_figures
from workbench.questions.verification.lines import Benchmark, Reader, benchmark_lines
from workbench.study.model import Study

__all__ = ["VERIFICATION", "ModelVerification", "Verification"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelVerification:
    """Benchmarks of one model in the order of the page, and the numbers of each task for the figures."""

    benchmarks: tuple[Benchmark, ...]
    numbers: Mapping[str, Mapping[str, Any]]

    @property
    def mesh_studies(self) -> dict[str, Mapping[str, float]]:
        """Title of each benchmark with several meshes -> mesh -> error [-]."""
        titles = {b.name: b.title for b in self.benchmarks}
        return {titles[name]: numbers["meshes"] for name, numbers in self.numbers.items() if "meshes" in numbers}


@dataclass(frozen=True, slots=True, kw_only=True)
class Verification:
    """Both models."""

    fe: ModelVerification
    ancf: ModelVerification

    @property
    def benchmarks(self) -> tuple[Benchmark, ...]:
        """All of them, in the order of the page."""
        return (*self.fe.benchmarks, *self.ancf.benchmarks)

    @property
    def failed(self) -> list[Check]:
        """Checks that did not pass, those of the negative controls included."""
        return [check for b in self.benchmarks for check in b.checks if check.status != "pass"]


def _tasks(study: Study) -> Sequence[Task]:
    return [
        *(_task(name, "workbench.questions.verification.task", 5.0) for name in BENCHMARKS),
        *(_task(name, "workbench.questions.verification.task_ancf", 2.0) for name in ANCF_BENCHMARKS),
    ]


def _task(benchmark: str, module: str, cost: float) -> Task:
    inputs = {"benchmark": benchmark}
    return Task(name=_task_name(benchmark), function=f"{module}:run_benchmark", inputs=inputs, cost=cost)


def _task_name(benchmark: str) -> str:
    return f"verify_{benchmark}"


def _read(study: Study, folders: Mapping[str, Path]) -> Verification:
    def of(readers: Mapping[str, Reader]) -> ModelVerification:
        numbers = {name: read_result(folders[_task_name(name)]) for name in readers}
        return ModelVerification(benchmarks=benchmark_lines(readers, numbers), numbers=numbers)

    return Verification(fe=of(BENCHMARKS), ancf=of(ANCF_BENCHMARKS))


def _checks(study: Study, results: Verification) -> Sequence[Check]:
    return [check for benchmark in results.benchmarks for check in benchmark.checks]


def _figures(study: Study, results: Verification) -> Mapping[str, str]:
    return verification_figures(results.fe.numbers) | ancf_verification_figures(results.ancf.numbers)


VERIFICATION = Question(
    name="verification",
    title="Verification",
    group="Solvers",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=_figures,
    applies=lambda study: study.verification is not None and study.verification.enabled,
)
