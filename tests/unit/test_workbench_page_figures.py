"""Figures of the page: each name belongs to one question."""

from __future__ import annotations

import pytest

from workbench.report.page import joined_figures


def test_figures_of_two_topics_are_joined() -> None:
    assert joined_figures({"a": "1"}, {"b": "2"}) == {"a": "1", "b": "2"}


def test_a_name_given_twice_is_refused() -> None:
    """As once with the rover on brush and on ANCF tires: the later figure stood in both sections."""
    with pytest.raises(ValueError, match="have the same name: a"):
        joined_figures({"a": "1"}, {"a": "2"})
