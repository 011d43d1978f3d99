"""Topics of the report: each has its own tasks, names and template."""

from __future__ import annotations

from pathlib import Path

import pytest

import workbench.report.page
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.topics.registry import TOPICS, topics_of

TEMPLATES = Path(workbench.report.page.__file__).parent / "templates"


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def test_the_built_in_study_has_every_topic_once(study: Study) -> None:
    assert topics_of(study) == TOPICS
    names = [topic.name for topic in TOPICS]
    assert len(names) == len(set(names))


def test_every_topic_has_a_section_under_its_name() -> None:
    for topic in TOPICS:
        text = (TEMPLATES / f"section_{topic.name}.html.j2").read_text(encoding="utf-8")
        assert f'<section id="{topic.name}">' in text


def test_tasks_of_topics_do_not_meet(study: Study) -> None:
    names = [task.name for topic in TOPICS for task in topic.tasks(study)]
    assert len(names) == len(set(names))
