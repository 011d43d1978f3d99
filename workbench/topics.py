"""The topics of the report, in the order of its page. Verified by tests/unit/test_workbench_topics.py."""

from __future__ import annotations

from workbench.study import Study
from workbench.topic import Topic

__all__ = ["TOPICS", "topics_of"]

TOPICS: tuple[Topic, ...] = ()


def topics_of(study: Study) -> tuple[Topic, ...]:
    """Those that apply to a study."""
    return tuple(topic for topic in TOPICS if topic.applies(study))
