"""What stands where: the two pages, their groups and sections. Verified by tests/unit/test_workbench_contents.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from workbench import questions
from workbench.questions import question
from workbench.questions.question import Question
from workbench.questions.registry import questions_of
from workbench.study.model import Study

__all__ = ["EVIDENCE", "REPORT", "Group", "Page", "Section", "contents", "page_of", "section_titles"]

type Page = Literal["report", "evidence"]
REPORT: Page = "report"
EVIDENCE: Page = "evidence"
_FOLDER = Path(questions.__file__).parent
_TEMPLATES = {REPORT: "section.html.j2", EVIDENCE: "evidence.html.j2"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """One section: its name, its title in the contents, its template; whether the other page has one of this name."""

    name: str
    title: str
    template: str
    continued: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Sections under one heading of the contents."""

    title: str
    sections: Sequence[Section]


_LAST = Group(
    title="Behind the numbers",
    sections=tuple(
        Section(name=name, title=title, template=f"section_{name}.html.j2")
        for name, title in (
            ("checks", "All checks"),
            ("evidence", "Evidence"),
            ("files", "Curves and time series"),
            ("chosen", "Chosen and inferred"),
            ("origin", "Timings, provenance"),
            ("reading", "How to read this"),
        )
    ),
)
"""The evidence's own sections."""


def contents(study: Study, page: Page) -> list[Group]:
    """Groups of a page with the sections of the questions that the study asks, none empty; the evidence's own last."""
    found = []
    for title in get_args(question.Group):
        asked = [_section(one, page) for one in questions_of(study) if one.group == title and page in _pages(one)]
        if asked:
            found.append(Group(title=title, sections=asked))
    return [*found, *([_LAST] if page == EVIDENCE else [])]


def _section(one: Question, page: Page) -> Section:
    template = f"{one.name}/{_TEMPLATES[page]}"
    return Section(name=one.name, title=one.title, template=template, continued=len(_pages(one)) == 2)


def _pages(one: Question) -> list[Page]:
    """The report if the question has a budget there; the evidence if it has a template for that."""
    stands = {REPORT: one.budget > 0, EVIDENCE: (_FOLDER / one.name / _TEMPLATES[EVIDENCE]).exists()}
    return [page for page, does in stands.items() if does]


def page_of(study: Study) -> Mapping[str, Page]:
    """Section -> the page that a check of its question leads to: the report where it has a section there."""
    pages = {section.name: page for page in (EVIDENCE, REPORT) for g in contents(study, page) for section in g.sections}
    return {name: pages[name] for name in section_titles(study)}


def section_titles(study: Study) -> Mapping[str, str]:
    """Section -> its title in the contents: those of the report, then those that the evidence has beside them."""
    return {s.name: s.title for page in (REPORT, EVIDENCE) for group in contents(study, page) for s in group.sections}
