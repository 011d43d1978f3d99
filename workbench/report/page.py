"""The report and its evidence: two self-contained pages. The one module that imports Jinja2.

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
from workbench.questions.rover_mission.requirements import plainly
from workbench.report.chosen import chosen_groups
from workbench.report.contents import EVIDENCE, REPORT, Group, Page, Section, contents, page_of, section_titles
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
    """What the pages and the PDF are made of.

    Attributes
    ----------
    sections : HTML by page and name
    groups : contents by page
    values : what templates are filled with
    """

    sections: Mapping[Page, Mapping[str, str]]
    groups: Mapping[Page, Sequence[Group]]
    values: Mapping[str, Any]


def rendered_sections(content: PageContent) -> Rendered:
    """Fill in every section's template, of both pages from the same values."""
    found, study = content.found, content.study
    figures, lacking = _page_figures(study, found, partial=bool(content.provenance["partial"]))
    values: dict[str, Any] = {
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
        "links": {name: f"{page}.html#{name}" for name, page in page_of(study).items()},
    }
    environment = page_environment()
    groups = {page: contents(study, page) for page in (REPORT, EVIDENCE)}
    texts = {
        page: {s.name: _section_text(environment, s, page, found, values, lacking) for g in held for s in g.sections}
        for page, held in groups.items()
    }
    return Rendered(sections=texts, groups=groups, values=values)


def render(rendered: Rendered, page: Page) -> str:
    """A page as text: figures, pictures and scripts inside, nothing loaded from elsewhere.

    Templates write every link with its page (``evidence.html#checks``); one to the page itself loses it here.
    """
    template = page_environment().get_template("page.html.j2")
    own = {"page": page, "groups": rendered.groups[page], "texts": rendered.sections[page]}
    text = template.render(rendered.values, **own, plotly=packed(plotly_source()))
    return text.replace(f'href="{page}.html#', 'href="#')


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
    environment.filters["plainly"] = plainly
    return environment


def _finalized(value: object) -> object:
    """What a template puts into the page: a text in one line, unless it is a piece of the page itself."""
    return one_line(value) if type(value) is str else value


def _section_text(
    environment: jinja2.Environment,
    section: Section,
    page: Page,
    found: Comparison,
    values: Mapping[str, Any],
    lacking: Mapping[str, InputError],
) -> str:
    """One section; where a partial curve leaves it without a number or a figure, its title and what is missing."""
    try:
        if section.name in lacking:
            raise lacking[section.name]
        text = environment.get_template(section.template).render(values, results=found.answers.get(section.name))
    except (InputError, jinja2.UndefinedError) as error:
        if not values["provenance"]["partial"]:
            raise
        why = f"Not evaluated, because a curve is partial: {error}"
        text = f'<section id="{section.name}"><h2>{section.title}</h2><p>{for_html(why)}</p></section>'
    return _continued(text, section, page) if section.continued else text


def _continued(text: str, section: Section, page: Page) -> str:
    """A section that stands on both pages, with a link to the other part: at its end, or below its title."""
    other, words = (EVIDENCE, "More: evidence") if page == REPORT else (REPORT, "In short: report")
    link = f'<p class="more"><a href="{other}.html#{section.name}">{words}, {section.title}</a></p>'
    if page == REPORT:
        body, end, _ = text.rpartition("</section>")
        return f"{body}{link}\n{end}"
    title, end, body = text.partition("</h2>")
    return f"{title}{end}\n{link}{body}"


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
