"""The report: one self-contained page, its verdict first. The one module that imports Jinja2.

Verified by tests/unit/test_workbench_outputs.py, tests/unit/test_workbench_page_figures.py,
tests/end_to_end/test_report.py and, in a browser, tests/end_to_end/test_report_browser.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from contracts.errors import InputError
from contracts.records import Timing
from contracts.text import for_html, one_line
from workbench import questions
from workbench.charts.interactive import plotly_source
from workbench.charts.packing import packed
from workbench.charts.palette import PART_COLOURS
from workbench.questions.comparison import Comparison
from workbench.questions.registry import questions_of
from workbench.report.chosen import chosen_groups
from workbench.report.contents import Section, contents, section_titles
from workbench.report.evidence import Evidence
from workbench.report.opening import check_groups, opening
from workbench.report.series import series_links
from workbench.study.model import Study
from workbench.verdict.number_format import displayed, displayed_reference, largest_by_unit, power_of_ten
from workbench.verdict.status import overall_status

__all__ = ["TEMPLATES", "PageContent", "Rendered", "joined_figures", "page_environment", "render", "rendered_sections"]


TEMPLATES = (Path(__file__).parent / "templates", Path(questions.__file__).parent)
"""The page's own, and the sections that lie with their questions."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PageContent:
    """What a page is made of.

    Attributes
    ----------
    study : the study, for titles and what is inferred
    found : the comparison
    timings : wall time of each task
    provenance : as in ``summary.json``
    evidence : every check with its links
    curves : link of each published curve by the name of its file
    """

    study: Study
    found: Comparison
    timings: Sequence[Timing]
    provenance: Mapping[str, Any]
    evidence: Sequence[Evidence]
    curves: Mapping[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rendered:
    """What the page and the PDF are made of.

    Attributes
    ----------
    sections : HTML by name
    printed : sections that paper has instead of some of the page's, by name; empty where it has none
    values : what templates are filled with
    """

    sections: Mapping[str, str]
    printed: Mapping[str, str]
    values: Mapping[str, Any]


def rendered_sections(content: PageContent) -> Rendered:
    """Fill in every section's template."""
    found, study = content.found, content.study
    figures, lacking = _page_figures(study, found, partial=bool(content.provenance["partial"]))
    values: dict[str, Any] = {
        "groups": contents(study),
        "study": study,
        "opening": opening(study, found),
        "status": overall_status(found.checks),
        "check_groups": check_groups(found, section_titles(study)),
        "figures": figures,
        "timings": content.timings,
        "provenance": content.provenance,
        "evidence": content.evidence,
        "curves": content.curves,
        "chosen": chosen_groups(study),
        "series": series_links(found.series),
        "colours": PART_COLOURS,
    }
    environment = page_environment()
    sections = [section for group in values["groups"] for section in group.sections]
    texts = {section.name: _section_text(environment, section, found, values, lacking) for section in sections}
    printed = {"checks": "", "evidence": environment.get_template("printed_evidence.html.j2").render(values)}
    return Rendered(sections=texts, printed=printed, values=values)


def render(rendered: Rendered) -> str:
    """The page as text: figures, pictures and scripts inside, nothing loaded from elsewhere."""
    template = page_environment().get_template("report.html.j2")
    return template.render(rendered.values, texts=rendered.sections, plotly=packed(plotly_source()))


def page_environment() -> jinja2.Environment:
    """The templates of the page with their filters."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        finalize=_finalized,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["number"] = displayed
    environment.filters["power"] = power_of_ten
    environment.filters["largest_by_unit"] = largest_by_unit
    environment.filters["reference"] = displayed_reference
    return environment


def _finalized(value: object) -> object:
    """What a template puts into the page: a text in one line, unless it is a piece of the page itself."""
    return one_line(value) if type(value) is str else value


def _section_text(
    environment: jinja2.Environment,
    section: Section,
    found: Comparison,
    values: Mapping[str, Any],
    lacking: Mapping[str, InputError],
) -> str:
    """One section; where a partial curve leaves it without a number or a figure, its title and what is missing."""
    asked = section.name in found.answers
    name = f"{section.name}/section.html.j2" if asked else f"section_{section.name}.html.j2"
    try:
        if section.name in lacking:
            raise lacking[section.name]
        return environment.get_template(name).render(values, results=found.answers.get(section.name))
    except (InputError, jinja2.UndefinedError) as error:
        if not values["provenance"]["partial"]:
            raise
        why = f"Not evaluated, because a curve is partial: {error}"
        return f'<section id="{section.name}"><h2>{section.title}</h2><p>{for_html(why)}</p></section>'


def _page_figures(study: Study, found: Comparison, *, partial: bool) -> tuple[dict[str, str], dict[str, InputError]]:
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
