"""The report: one self-contained page, its verdict first. The one module that imports Jinja2.

Verified by tests/unit/test_workbench_outputs.py, tests/end_to_end/test_report.py and, in a browser,
tests/end_to_end/test_report_browser.py.
"""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from contracts.errors import InputError
from contracts.records import Timing
from workbench.comparison.comparison import Comparison, overall_status
from workbench.figures.interactive import plotly_source
from workbench.figures.packing import packed
from workbench.figures.palette import PART_COLOURS
from workbench.report.chosen import chosen_groups
from workbench.report.contents import Section, contents, section_titles
from workbench.report.evidence import Evidence
from workbench.report.number_format import displayed, displayed_reference, largest_by_unit, power_of_ten
from workbench.report.opening import check_groups, opening
from workbench.report.page_figures import page_figures
from workbench.report.series import series_links
from workbench.study.model import Study
from workbench.topics.registry import topics_of

__all__ = ["PageContent", "Rendered", "page_environment", "render", "rendered_sections"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PageContent:
    """What a page is made of.

    Attributes
    ----------
    study : the study, for titles and what is inferred
    found : the comparison
    results : folder of each task's result by its name
    timings : wall time of each task
    provenance : as in ``summary.json``
    evidence : every check with its links
    curves : link of each published curve by the name of its file
    """

    study: Study
    found: Comparison
    results: Mapping[str, Path]
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
    found, study, titles = content.found, content.study, section_titles(content.study)
    figures, lacking = page_figures(study, found, content.results, partial=bool(content.provenance["partial"]))
    values: dict[str, Any] = {
        "groups": contents(titles),
        "study": study,
        "found": found,
        "opening": opening(study, found.checks, found.agreements, titles),
        "status": overall_status(found.checks),
        "check_groups": check_groups(found.checks, titles),
        "figures": figures,
        "solver": [_solver_row(found, o) for o in found.fe.by_orientation],
        "timings": content.timings,
        "provenance": content.provenance,
        "evidence": content.evidence,
        "curves": content.curves,
        "chosen": chosen_groups(study),
        "metrics": _metric_rows(found),
        "agreements": found.agreements,
        "series": series_links([s for t in topics_of(study) for s in t.series(study, found.topics[t.name])]),
        "colours": PART_COLOURS,
    }
    environment = page_environment()
    sections = [section for group in values["groups"] for section in group.sections]
    texts = {section.name: _section_text(environment, section, values, lacking) for section in sections}
    printed = {"checks": "", "evidence": environment.get_template("printed_evidence.html.j2").render(values)}
    return Rendered(sections=texts, printed=printed, values=values)


def render(rendered: Rendered) -> str:
    """The page as text: figures, pictures and scripts inside, nothing loaded from elsewhere."""
    template = page_environment().get_template("report.html.j2")
    return template.render(rendered.values, texts=rendered.sections, plotly=packed(plotly_source()))


def page_environment() -> jinja2.Environment:
    """The templates of the page with their filters."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["number"] = displayed
    environment.filters["power"] = power_of_ten
    environment.filters["largest_by_unit"] = largest_by_unit
    environment.filters["reference"] = displayed_reference
    return environment


def _section_text(
    environment: jinja2.Environment, section: Section, values: Mapping[str, Any], lacking: Mapping[str, InputError]
) -> str:
    """One section; where a partial curve leaves it without a number or a figure, its title and what is missing."""
    topic = values["found"].topics.get(section.name)
    try:
        if section.name in lacking:
            raise lacking[section.name]
        return environment.get_template(f"section_{section.name}.html.j2").render(values, topic=topic)
    except (InputError, jinja2.UndefinedError) as error:
        if not values["provenance"]["partial"]:
            raise
        why = f"Not evaluated, because a curve is partial: {error}"
        return f'<section id="{section.name}"><h2>{section.title}</h2><p>{html.escape(why)}</p></section>'


def _solver_row(found: Comparison, orientation: float) -> dict[str, Any]:
    """One orientation's line in the table of increments."""
    curve, numbers = found.fe.by_orientation[orientation], found.fe.numbers[orientation]
    records = numbers["increments"]
    return {
        "orientation": orientation,
        "increments": sum(r["converged"] for r in records),
        "cuts": sum(not r["converged"] for r in records),
        "iterations": int(sum(len(r["residuals"]) - 1 for r in records)),
        "partial": curve.partial,
        "missing": curve.unloaded,
        "residual": max((r["residuals"][-1] for r in records if r["converged"]), default=None),
        "imbalance": float(abs(curve.columns["force_imbalance"]).max()),
        "moment_imbalance": float(abs(curve.columns["moment_imbalance"]).max()),
        "deflection": float(curve.deflection[-1]),
        "load": float(curve.load[-1]),
        "dofs": numbers["dofs"],
        "solve_s": numbers["solve_s"],
    }


def _metric_rows(found: Comparison) -> list[tuple[str, str, Mapping[str, Any]]]:
    """Pairs of curves: key, readable name, distances."""
    names = {"ancf_average": "ANCF average, FE average", "brush": "brush line, FE average"}
    names |= {f"user_{i}": f"FE, {user.label}" for i, user in enumerate(found.users)}
    rows = []
    for key, numbers in found.metrics.items():
        orientation = key.removeprefix("ancf_phi")
        name = names.get(key) or f"ANCF {orientation}°, FE {orientation}°"
        fe = found.fe.average if key in names else found.fe.by_orientation[float(orientation)]
        name += " (partial)" if fe.partial else ""
        rows.append((key, name, numbers))
    return rows
