"""What stands where in the report: groups and their sections. Verified by tests/unit/test_workbench_contents.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import get_args

from workbench.questions import question
from workbench.questions.registry import questions_of
from workbench.study.model import Study

__all__ = ["Group", "Section", "contents", "section_titles"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """One section: its name, and its title in the contents."""

    name: str
    title: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Sections under one heading of the contents."""

    title: str
    sections: Sequence[Section]


_LAST = Group(
    title="Behind the numbers",
    sections=(
        Section(name="checks", title="All checks"),
        Section(name="evidence", title="Evidence"),
        Section(name="chosen", title="Chosen and inferred"),
        Section(name="origin", title="Timings, provenance"),
        Section(name="reading", title="How to read this"),
    ),
)
"""The report's own sections, ``templates/section_{name}.html.j2``."""


def contents(study: Study) -> list[Group]:
    """Groups with those of the questions that the study asks, none empty, and the report's own sections last."""
    found = []
    for title in get_args(question.Group):
        asked = [Section(name=one.name, title=one.title) for one in questions_of(study) if one.group == title]
        if asked:
            found.append(Group(title=title, sections=asked))
    return [*found, _LAST]


def section_titles(study: Study) -> Mapping[str, str]:
    """Section -> its title in the contents, of every section a study's report has, in the order of the page."""
    return {section.name: section.title for group in contents(study) for section in group.sections}
