"""The page of an optimisation: one self-contained file. Verified by tests/end_to_end/test_optimise.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from string import Template

from contracts.text import for_html
from workbench.charts.interactive import Figure, figure_html
from workbench.questions.optimise.judging import STABILITY, Assessed, Confirmed, limits_of
from workbench.questions.optimise.words import (
    limited,
    told_buckling,
    told_difference,
    told_limits,
    told_number,
    told_verdict,
)
from workbench.questions.sweep.table import SweepTable
from workbench.questions.sweep.words import Column, column_of
from workbench.report.sweep_page import points_page, points_table
from workbench.study.optimise import OptimiseSection

__all__ = ["optimise_page"]

_TEMPLATES = Path(__file__).parent / "templates"
_MOST_ROWS = 40


def optimise_page(
    title: str,
    section: OptimiseSection,
    table: SweepTable,
    figures: Sequence[tuple[Confirmed, Figure]],
    trade: Figure,
    answer: Assessed | None,
    sentences: Sequence[str],
) -> str:
    """The page as text: figures and scripts inside, nothing loaded from elsewhere.

    Parameters
    ----------
    table : every point
    figures : of the confirmed points, which are shown with how far both models differ
    trade : figure of the trade-off
    answer : the point that is recommended; None where there is none
    sentences : what was found, told first
    """
    told = "".join(f"<p>{for_html(sentence)}</p>" for sentence in sentences)
    values = {} if answer is None else answer.outcome.run.point.values
    rows = "".join(f"<tr><td>{for_html(key)}</td><td>{for_html(str(value))}</td></tr>" for key, value in values.items())
    names = dict.fromkeys([section.objective.column, *limited(section), section.trade.column])
    found = [told_number(name, answer.numbers.get(name)) for name in names] if answer is not None else []
    dimensions = f'<table class="dense"><tbody>{rows}</tbody></table>' if rows else ""
    heading = f"<h2>{'The wheel' if answer is not None else 'No wheel'}</h2>"
    body = Template((_TEMPLATES / "optimise.html").read_text(encoding="utf-8")).substitute(
        answer=f"{heading}{told}{dimensions}<p>{for_html('; '.join(found))}</p>",
        trade=figure_html(trade, "trade-off"),
        confirmed="".join(_confirmed(one, figure, section) for one, figure in figures),
        table=_table(table, section),
    )
    wish = "most" if section.objective.sign < 0.0 else "least"
    lead = f"The {wish} {column_of(section.objective.column).label} with {told_limits(limits_of(section))}."
    return points_page(f"{title}: optimisation", lead, body)


def _confirmed(one: Confirmed, figure: Figure, section: OptimiseSection) -> str:
    difference = told_difference(one, section)
    words = f"{section.model} against solid model at the same orientations: {difference}." if difference else ""
    buckling = f" The solid model {told}." if (told := told_buckling(one.solid, section)) else ""
    head = f"Point {one.found} by the solid model: {told_verdict(one.solid)}"
    words = f"{words}{buckling}"
    return f"<h2>{for_html(head)}</h2><p>{for_html(words)}</p>{figure_html(figure, f'confirmed-{one.found}')}"


def _table(table: SweepTable, section: OptimiseSection) -> str:
    """Feasible rows by their objective, those of the solid model first."""
    place = {name: i for i, name in enumerate(table.names)}
    known = [row for row in table.rows if row[place["confirms"]] is not None or row[place["feasible"]] == 1]

    def order(row: tuple[object, ...]) -> tuple[bool, float]:
        value = row[place[section.objective.column]]
        return row[place["confirms"]] is None, section.objective.sign * (value if isinstance(value, float) else 0.0)

    shown = replace(table, rows=tuple(sorted(known, key=order)[:_MOST_ROWS]))
    labels = {"point": "point", "model": "model", "confirms": "confirms", "feasible": "feasible"}
    columns = [Column(name=name, label=label, factor=1.0) for name, label in labels.items()]
    columns += [Column(name=n, label=label, factor=1.0) for n, label in zip(table.inputs, table.labels, strict=True)]
    numbers = dict.fromkeys([section.objective.column, *limited(section), section.trade.column])
    buckling = Column(name=f"miss_{STABILITY}", label="load lacking to stability", factor=1.0)
    return points_table(shown, [*columns, *(column_of(name) for name in numbers), buckling])
