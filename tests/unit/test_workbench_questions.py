"""Questions of the report: each has its own folder with section and words, its own tasks and names."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import get_args

import pytest

from workbench import questions
from workbench.questions.question import Group
from workbench.questions.registry import QUESTIONS, questions_of
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

ROOT = Path(questions.__file__).parent


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def test_the_built_in_study_asks_every_question_once(study: Study) -> None:
    assert questions_of(study) == QUESTIONS
    names = [question.name for question in QUESTIONS]
    assert len(names) == len(set(names))


def test_every_question_has_a_folder_that_says_what_it_asks_and_its_section() -> None:
    for question in QUESTIONS:
        asked = (ROOT / question.name / "__init__.py").read_text(encoding="utf-8")
        assert re.fullmatch(r'"""[A-Z].*\?(.*\))?"""\n', asked), question.name
        parts = {name: ROOT / question.name / f"{name}.html.j2" for name in ("section", "evidence")}
        there = {name: path.read_text(encoding="utf-8") for name, path in parts.items() if path.exists()}
        assert there, question.name
        assert all(f'<section id="{question.name}">' in text for text in there.values()), question.name
        assert ("section" in there) == (question.budget > 0), f"{question.name}: a section of the report has a budget"
        assert (ROOT / question.name / "statements.toml").is_file()


def test_every_section_and_every_word_belongs_to_a_question() -> None:
    names = {question.name for question in QUESTIONS}
    assert {path.parent.name for path in ROOT.glob("*/*.html.j2")} == names
    assert {path.parent.name for path in ROOT.glob("*/statements.toml")} == names


def test_questions_stand_in_the_order_of_their_groups() -> None:
    groups = [question.group for question in QUESTIONS]
    assert sorted(groups, key=get_args(Group).index) == groups


def test_tasks_of_questions_do_not_meet(study: Study) -> None:
    names = [task.name for question in QUESTIONS for task in question.tasks(study)]
    assert len(names) == len(set(names))


ROOMS: dict[str, set[str]] = {
    "study": set(),
    "execution": set(),
    "charts": set(),
    "verdict": set(),
    "questions": {"study", "execution", "charts", "verdict"},
    "report": {"study", "execution", "charts", "verdict", "questions"},
    "viewer": {"study", "charts", "questions", "report"},
}
"""Room -> those it may import, at any depth of the code; the command line and `api` stand on all of them."""


def _arrows(package: Path) -> set[tuple[str, str]]:
    found = set()
    for room in ROOMS:
        for path in (package / room).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                named = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
                named += [one.name for one in node.names] if isinstance(node, ast.Import) else []
                others = {name.split(".")[1] for name in named if name.startswith("workbench.")} - {room}
                found |= {(room, other) for other in others}
    return found


def test_rooms_know_those_below_them_alone() -> None:
    assert {(room, other) for room, other in _arrows(ROOT.parent) if other not in ROOMS[room]} == set()


def test_negative_control_a_chart_that_knows_a_question_is_seen(tmp_path: Path) -> None:
    (tmp_path / "charts").mkdir()
    (tmp_path / "charts" / "a.py").write_text("def f():\n    from workbench.questions.fe import x\n", encoding="utf-8")
    assert _arrows(tmp_path) == {("charts", "questions")}
