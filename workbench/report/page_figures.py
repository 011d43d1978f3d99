"""All figures and scenes of the page by name. Verified by tests/unit/test_workbench_page_figures.py."""

from __future__ import annotations

from collections.abc import Mapping

from contracts.errors import InputError
from workbench.questions.comparison import Comparison
from workbench.questions.registry import questions_of
from workbench.study.model import Study

__all__ = ["joined_figures", "page_figures"]


def page_figures(study: Study, found: Comparison, *, partial: bool) -> tuple[dict[str, str], dict[str, InputError]]:
    """Figures by name; and by question, what a partial curve leaves without any.

    Parameters
    ----------
    study, found : what the report is about
    partial : a curve ended early, so that questions may lack their figures
    """
    figures: dict[str, str] = {}
    lacking = {}
    for question in questions_of(study):
        try:
            figures = joined_figures(figures, question.figures(study, found.answers[question.name]))
        except InputError as error:
            if not partial:
                raise
            lacking[question.name] = error
    return figures, lacking


def joined_figures(figures: Mapping[str, str], more: Mapping[str, str]) -> dict[str, str]:
    """Both; a name that two questions give would let one section show the other's figure."""
    twice = sorted(figures.keys() & more.keys())
    if twice:
        raise ValueError(f"figures of two questions have the same name: {', '.join(twice)}")
    return {**figures, **more}
