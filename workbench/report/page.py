"""The report: one self-contained page. The one module that imports Jinja2.

Verified by tests/unit/test_workbench_outputs.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from contracts.errors import InputError
from contracts.records import Check, Timing
from workbench.comparison.comparison import Comparison, overall_status
from workbench.figures.interactive import ancf_figure, fe_figure, models_figure, plotly_script, stress_figure
from workbench.figures.palette import PART_COLOURS
from workbench.report.chosen import chosen_groups
from workbench.report.evidence import Evidence
from workbench.report.number_format import displayed, displayed_reference
from workbench.report.series import series_links
from workbench.study.model import Study
from workbench.topics.registry import topics_of

__all__ = ["PageContent", "joined_figures", "render", "verdict"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PageContent:
    """What a page is made of.

    Attributes
    ----------
    study : the study, for titles and what is inferred
    found : the comparison
    pictures : folder with ``wheel.png`` and ``deformed_*N.png``
    timings : wall time of each task
    provenance : as in ``summary.json``
    evidence : every check with its links
    curves : link of each published curve by the name of its file
    """

    study: Study
    found: Comparison
    pictures: Path
    timings: Sequence[Timing]
    provenance: Mapping[str, Any]
    evidence: Sequence[Evidence]
    curves: Mapping[str, str]


def render(content: PageContent) -> str:
    """The page as text: figures, pictures and scripts inside, nothing loaded from elsewhere."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["number"] = displayed
    environment.filters["reference"] = displayed_reference
    found, study = content.found, content.study
    figures, lacking = _figures(content)
    values: dict[str, Any] = {
        "sections": _sections(study),
        "study": study,
        "found": found,
        "verdict": verdict(found.checks),
        "status": overall_status(found.checks),
        "counts": _counts(found.checks),
        "plotly": plotly_script(),
        "figures": figures,
        "wheel": _data_uri(content.pictures / "wheel.png"),
        "deformed": [(p.stem.removeprefix("deformed_"), _data_uri(p)) for p in _deformed(content.pictures)],
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
    texts = {section.name: _section_text(environment, section, values, lacking) for section in values["sections"]}
    return environment.get_template("report.html.j2").render(values, texts=texts)


def _section_text(
    environment: jinja2.Environment, section: _Section, values: Mapping[str, Any], lacking: Mapping[str, InputError]
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


def verdict(checks: Sequence[Check]) -> str:
    """One sentence: what the gates say, and how many findings lie outside or are unknown."""
    gates = [c for c in checks if c.role == "gate"]
    findings = [c for c in checks if c.role == "finding"]
    bad = sum(c.status != "pass" for c in gates)
    outside, unknown = (sum(c.status == s for c in findings) for s in ("fail", "error"))
    first = f"All {len(gates)} gates passed" if not bad else f"{bad} of {len(gates)} gates did not pass"
    if not outside + unknown:
        return f"{first}; every finding lies inside its limits."
    second = f"{outside or 'no'} finding{'s' if outside > 1 else ''} outside {'their' if outside > 1 else 'its'} limits"
    return f"{first}; {second}{f', {unknown} not evaluated' if unknown else ''}."


@dataclass(frozen=True, slots=True, kw_only=True)
class _Section:
    """One section of the page: ``templates/section_{name}.html.j2`` and its title in the navigation."""

    name: str
    title: str


_FIRST = {"checks": "Checks", "wheel": "Wheel", "models": "Models compared", "fe": "Finite elements", "ancf": "ANCF"}
_LAST = {
    "numerics": "Mesh and solver",
    "evidence": "Evidence",
    "chosen": "Chosen and inferred",
    "origin": "Timings, provenance",
    "reading": "How to read this",
}


def _sections(study: Study) -> list[_Section]:
    """Sections in the order of the page: the models, the topics, then what is for reference."""
    titles = _FIRST | {topic.name: topic.title for topic in topics_of(study)} | _LAST
    return [_Section(name=name, title=title) for name, title in titles.items()]


def _counts(checks: Sequence[Check]) -> list[tuple[str, str, int]]:
    """(role, status, number) in a fixed order, without empty ones."""
    pairs = [(r, s) for r in ("gate", "finding") for s in ("pass", "fail", "error")]
    counted = [(r, s, sum(c.role == r and c.status == s for c in checks)) for r, s in pairs]
    return [row for row in counted if row[2]]


def _figures(content: PageContent) -> tuple[dict[str, str], dict[str, InputError]]:
    """Figures by name; and by topic, what a partial curve leaves without any."""
    found, study = content.found, content.study
    first, *_ = [*found.fe.loaded.values(), found.fe.average]
    parts = found.mesh["parts"]
    strengths = {p: study.materials[n["material"]].yield_strength for p, n in parts.items()}
    figures = {
        "fe": fe_figure(found, study.reference),
        "ancf": ancf_figure(found),
        "models": models_figure(found, study.reference),
        "stress": stress_figure(first, strengths),
    }
    lacking = {}
    for topic in topics_of(study):
        try:
            figures = joined_figures(figures, topic.figures(study, found.topics[topic.name]))
        except InputError as error:
            if not content.provenance["partial"]:
                raise
            lacking[topic.name] = error
    return figures, lacking


def joined_figures(figures: Mapping[str, str], more: Mapping[str, str]) -> dict[str, str]:
    """Both; a name that two topics give would let one section show the other's figure.

    Verified by tests/unit/test_workbench_page_figures.py.
    """
    twice = sorted(figures.keys() & more.keys())
    if twice:
        raise ValueError(f"figures of two topics have the same name: {', '.join(twice)}")
    return {**figures, **more}


def _deformed(pictures: Path) -> list[Path]:
    return sorted(pictures.glob("deformed_*N.png"), key=lambda p: float(p.stem.removeprefix("deformed_")[:-1]))


def _data_uri(path: Path) -> str:
    return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")


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
