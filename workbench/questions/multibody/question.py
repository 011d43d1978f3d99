"""Question: the multibody engine on the IFToMM problems A01 to A03, error against work for both kinds of steps.

Verified by tests/unit/test_workbench_multibody.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from contracts.records import Check, Role
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.multibody.figures import work_figures
from workbench.questions.multibody.results import MultibodyResults, WorkRow, problem_of
from workbench.questions.question import Question
from workbench.questions.verification.question import VERIFICATION
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_least, at_most

if TYPE_CHECKING:
    pass

__all__ = ["ALLOWED", "MULTIBODY"]


ALLOWED: Mapping[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "pendulum": ((1e-4, 1e-6, 1e-8, 1e-10), (1e-4, 1e-5, 1e-6)),
    "four_bar_2": ((1e-4, 1e-5, 1e-6, 1e-8), (1e-4, 1e-5, 1e-6)),
    "four_bar_40": ((1e-4, 1e-6), (1e-4,)),
    "andrews": ((1e-4, 1e-6, 1e-8, 1e-10), (1e-4, 1e-5, 1e-6)),
}
"""Problem -> errors allowed in explicit and in implicit steps; forty windows cost most, and have the fewest."""
SOURCE = "IFToMM library of multibody benchmarks, A01 to A03"


def _name(problem: str) -> str:
    return f"multibody_{problem}"


def _tasks(study: Study) -> Sequence[Task]:
    return [
        Task(
            name=_name(problem),
            function="workbench.questions.multibody.task:measure_work",
            inputs={"problem": problem, "explicit": list(explicit), "implicit": list(implicit)},
            cost=8.0 if problem == "four_bar_40" else 3.0,
        )
        for problem, (explicit, implicit) in ALLOWED.items()
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> MultibodyResults:
    from rover_dynamics.multibody.verification.work_precision import one_angle_error

    rows = [
        WorkRow(problem=problem, **row) for problem in ALLOWED for row in read_result(folders[_name(problem)])["rows"]
    ]
    return MultibodyResults(rows=tuple(rows), one_angle=one_angle_error(2, 1e-4))


def _claim(name: str, title: str, quantity: str, unit: str, role: Role = "gate") -> Claim:
    return Claim(id=f"multibody.{name}", title=title, quantity=quantity, unit=unit, role=role, source=SOURCE)


def _checks(study: Study, results: MultibodyResults) -> Sequence[Check]:
    checks = []
    for problem, allowed, limit in (
        ("pendulum", 1e-10, 1e-8),
        ("four_bar_2", 1e-8, 1e-5),
        ("four_bar_40", 1e-6, 1e-2),
        ("andrews", 1e-10, 1e-6),
    ):
        title = f"{problem_of(problem).title}, explicit steps of {allowed:g}"
        claim = _claim(problem, title, "largest error", problem_of(problem).unit)
        checks.append(at_most(claim, lambda p=problem, a=allowed: results.of(p, "explicit", a).error, limit))  # type: ignore[misc]
    for problem in ("pendulum", "andrews"):
        title = f"{problem_of(problem).title}, implicit steps: error at 1e-4 over that at 1e-6 a step"
        checks.append(at_least(_claim(f"{problem}_implicit", title, "ratio", "-"), _gained(results, problem), 5.0))
    drift = _claim("energy", "A02 four-bar, N = 40, explicit steps of 1e-6: energy over 10 s", "relative change", "-")
    checks.append(at_most(drift, lambda: results.of("four_bar_40", "explicit", 1e-6).energy or 0.0, 1e-4))
    title = "A02, N = 2, explicit steps of 1e-4: error over that of the equation of one angle"
    share = _claim("conditioning", title, "ratio", "-", "finding")
    checks.append(at_most(share, lambda: results.of("four_bar_2", "explicit", 1e-4).error / results.one_angle, 3.0))
    return checks


def _gained(results: MultibodyResults, problem: str) -> Callable[[], float]:
    return lambda: results.of(problem, "implicit", 1e-4).error / results.of(problem, "implicit", 1e-6).error


MULTIBODY = Question(
    name="multibody",
    title="Multibody engine",
    group="Solvers",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=work_figures,
    applies=VERIFICATION.applies,
)
