"""The page of a parameter study: one self-contained file. Verified by tests/end_to_end/test_sweep.py."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from string import Template

from contracts.text import for_html
from workbench.charts.interactive import plotly_source
from workbench.questions.sweep.figures import curves_figure, parallel_coordinates
from workbench.questions.sweep.likeness import unlike
from workbench.questions.sweep.results import Outcome
from workbench.questions.sweep.table import Cell, SweepTable
from workbench.questions.sweep.words import Column, told_columns

__all__ = ["points_page", "points_table", "sweep_page"]

_TEMPLATES = Path(__file__).parent / "templates"
_NAMES = {
    "fe": "solid model",
    "section": "section model",
    "ancf_wheel": "ANCF wheel",
    "ancf": "ANCF tire",
    "brush": "brush tire",
}


def sweep_page(title: str, table: SweepTable, found: Sequence[Outcome]) -> str:
    """The page as text: figures and scripts inside, nothing loaded from elsewhere."""
    models = dict.fromkeys(outcome.run.model for outcome in found)
    states = table.column("state")
    counts = ", ".join(f"{states.count(s)} {s}" for s in ("whole", "partial", "failed") if s in states)
    drawn = any(o.state != "failed" and o.run.point.number for o in found)
    curves = "".join(f"<h2>Curves of the {_NAMES[m]}</h2>{curves_figure(found, m)}" for m in models)
    points = len({o.run.point.number for o in found if o.run.point.number})
    mean = _mean(found) + (f" {told[0].upper()}{told[1:]}." if (told := unlike(found)) else "")
    body = Template((_TEMPLATES / "sweep.html").read_text(encoding="utf-8")).substitute(
        coordinates=parallel_coordinates(table) if drawn else "<p>No point has a curve.</p>",
        curves=curves,
        mean=for_html(mean),
        table=_table(table),
    )
    lead = f"{points} points; curves: {counts}. Varied: {', '.join(table.labels)}."
    return points_page(f"{title}: parameter study", lead, body)


def points_page(title: str, lead: str, body: str) -> str:
    """The frame of a page about points, with style and scripts; title and lead are text, the body is HTML."""
    return Template((_TEMPLATES / "points_page.html").read_text(encoding="utf-8")).substitute(
        title=for_html(title),
        lead=for_html(lead),
        style=(_TEMPLATES / "style.css.j2").read_text(encoding="utf-8"),
        plotly=plotly_source(),
        legend=(_TEMPLATES / "legend.js").read_text(encoding="utf-8"),
        body=body,
    )


def _mean(found: Sequence[Outcome]) -> str:
    """Which rows are means over orientations where others are not."""
    counts = {o.run.point.number: len(o.by_orientation) for o in found if o.by_orientation}
    several = counts.get(0, 1)
    if several < 2 or any(count != 1 for number, count in counts.items() if number):
        return ""
    rest = "each other point is at one, and is held against the study at that one."
    return f" Point 0, the study as it is, is the mean of {several} orientations; {rest}"


def _table(table: SweepTable) -> str:
    """What was varied and what is told of each point; a column without any text or number is left out."""
    told = dict(zip(table.inputs, table.labels, strict=True))
    columns = [Column(name="point", label="point", factor=1.0)]
    columns += [Column(name="model", label="model", factor=1.0)] if len(set(table.column("model"))) > 1 else []
    columns += [Column(name=name, label=label, factor=1.0) for name, label in told.items()]
    columns += told_columns(table)
    return points_table(table, columns)


def points_table(table: SweepTable, columns: list[Column]) -> str:
    """Rows of a table in these columns, with state and note where not every curve is whole; HTML."""
    if set(table.column("state")) != {"whole"}:
        columns = [*columns, *(Column(name=name, label=name, factor=1.0) for name in ("state", "note"))]
    head = "".join(f'<th class="n">{for_html(column.label)}</th>' for column in columns)
    rows = []
    for row, state in zip(table.rows, table.column("state"), strict=True):
        cells = "".join(_cell(row[table.names.index(column.name)], column.factor) for column in columns)
        rows.append(f'<tr class="{state}">{cells}</tr>')
    return f"<thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody>"


def _cell(cell: Cell, factor: float) -> str:
    if isinstance(cell, str):
        return f"<td>{for_html(cell)}</td>"
    return "<td></td>" if cell is None else f'<td class="n">{factor * cell:.4g}</td>'
