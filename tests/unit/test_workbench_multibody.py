"""The question of the multibody engine: tasks, checks, figures, section."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from contracts.records import Check
from workbench.execution.result_files import read_result, write_result
from workbench.questions.multibody.question import ALLOWED, MULTIBODY, MultibodyResults
from workbench.questions.multibody.task import measure_work
from workbench.questions.registry import QUESTIONS
from workbench.report.page import TEMPLATES
from workbench.study.reading import built_in_study, read_study

MEASURED = {  # error and relative change of energy of the last run of the report
    ("pendulum", "explicit", 1e-10): (3.4e-10, 1.9e-10),
    ("four_bar_2", "explicit", 1e-4): (0.328, 3.0e-3),
    ("four_bar_2", "explicit", 1e-8): (6.2e-7, 2.1e-8),
    ("four_bar_40", "explicit", 1e-6): (5.0e-4, 1.4e-5),
    ("andrews", "explicit", 1e-10): (2.5e-8, None),
    ("pendulum", "implicit", 1e-4): (0.021, 5.1e-3),
    ("pendulum", "implicit", 1e-6): (1.7e-3, 1.4e-4),
    ("andrews", "implicit", 1e-4): (0.48, None),
    ("andrews", "implicit", 1e-6): (0.045, None),
}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> MultibodyResults:
    """As read from files that tasks would write."""
    folders = {}
    for problem, by_method in ALLOWED.items():
        rows = []
        for method, asked in zip(("explicit", "implicit"), by_method, strict=True):
            for allowed in asked:
                error, energy = MEASURED.get((problem, method, allowed), (1e-3, None))
                row = {"method": method, "allowed": allowed, "error": error, "energy": energy}
                rows.append({**row, "seconds": 0.1, "steps": 10, "evaluations": 100})
        folders[f"multibody_{problem}"] = tmp_path_factory.mktemp(problem)
        write_result(folders[f"multibody_{problem}"], {"rows": rows})
    found = MULTIBODY.read(read_study(built_in_study()), folders)
    assert isinstance(found, MultibodyResults)
    return found


def _checks(results: MultibodyResults) -> dict[str, Check]:
    checks = MULTIBODY.checks(read_study(built_in_study()), results)
    return {check.id: check for check in checks}


def test_a_task_measures_both_kinds_of_steps(tmp_path: Path) -> None:
    inputs = {"problem": "pendulum", "explicit": [1e-3, 1e-6], "implicit": [1e-3]}
    seen: list[float] = []
    assert measure_work(inputs, {}, tmp_path, seen.append) == 6
    rows = read_result(tmp_path)["rows"]
    assert [(row["method"], row["allowed"]) for row in rows] == [
        ("explicit", 1e-3),
        ("explicit", 1e-6),
        ("implicit", 1e-3),
    ]
    assert rows[1]["error"] < 1e-3 < rows[2]["error"]
    assert all(row["seconds"] > 0.0 and row["evaluations"] > row["steps"] for row in rows)
    assert rows[1]["energy"] < rows[0]["energy"]
    assert seen[-1] == 1.0


def test_a_task_for_each_problem_of_a_study_that_verifies() -> None:
    study = read_study(built_in_study())
    assert [task.name for task in MULTIBODY.tasks(study)] == [f"multibody_{problem}" for problem in ALLOWED]
    assert MULTIBODY in QUESTIONS
    assert MULTIBODY.applies(study)


def test_all_gates_hold(results: MultibodyResults) -> None:
    checks = _checks(results)
    assert {check.status for check in checks.values()} == {"pass"}
    assert [name for name, check in checks.items() if check.role == "finding"] == ["multibody.conditioning"]


@pytest.mark.parametrize("name", ["pendulum", "four_bar_2", "four_bar_40", "andrews"])
def test_a_motion_that_is_off_fails_its_gate(results: MultibodyResults, name: str) -> None:
    """Negative control."""
    rows = tuple(replace(row, error=1e5 * row.error) if row.problem == name else row for row in results.rows)
    assert _checks(replace(results, rows=rows))[f"multibody.{name}"].status == "fail"


def test_energy_that_is_lost_and_an_error_that_stays_are_seen(results: MultibodyResults) -> None:
    """Negative control."""
    rows = tuple(replace(row, energy=1e-3, error=0.1) for row in results.rows)
    checks = _checks(replace(results, rows=rows, one_angle=0.01))
    for name in ("energy", "pendulum_implicit", "andrews_implicit", "conditioning"):
        assert checks[f"multibody.{name}"].status == "fail", name


def test_a_row_that_is_missing_is_an_error(results: MultibodyResults) -> None:
    rows = tuple(row for row in results.rows if row.problem != "andrews")
    assert _checks(replace(results, rows=rows))["multibody.andrews"].status == "error"


def test_figures_of_the_section_exist(results: MultibodyResults) -> None:
    figures = MULTIBODY.figures(read_study(built_in_study()), results)
    text = (TEMPLATES[1] / "multibody" / "evidence.html.j2").read_text(encoding="utf-8")
    assert set(re.findall(r"figures\.(\w+)", text)) == set(figures)
    assert "A02 four-bar, N = 40, implicit" in figures["seconds"]
