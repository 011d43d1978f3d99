"""The page of a parameter study: one self-contained file. Verified by tests/end_to_end/test_sweep.py."""

from __future__ import annotations

from collections.abc import Sequence
from string import Template

from contracts.text import for_html
from workbench.charts.interactive import plotly_script
from workbench.questions.sweep.figures import curves_figure, parallel_coordinates
from workbench.questions.sweep.results import Outcome
from workbench.questions.sweep.table import Cell, SweepTable

__all__ = ["sweep_page"]

_NAMES = {"fe": "solid model", "section": "section model", "ancf": "ANCF tire", "brush": "brush tire"}
_PAGE = Template("""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
body { font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; color: #1a1a1a; margin: 0 auto;
  max-width: 1200px; padding: 1.5rem; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem; } h2 { font-size: 1.2rem; margin: 2rem 0 .3rem; }
p { margin: .3rem 0; max-width: 75ch; } .table { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { border-bottom: 1px solid #dadce0; padding: .25rem .6rem; text-align: right; white-space: nowrap; }
th { text-align: right; vertical-align: bottom; } td.text, th.text { text-align: left; }
tr.failed td { background: #fdecea; } tr.partial td { background: #fff8e1; }
</style><script>$plotly</script></head><body>
<h1>$title</h1><p>$lead</p>
<h2>Parallel coordinates</h2>
<p>One line for each point, coloured by its initial tangent. Drag along an axis to select a range, drag a title to move
the axis. Axes that some point has no number for are left out.</p>$coordinates
$curves
<h2>Table</h2><p>The same as in sweep.csv and sweep.parquet, with five digits and without keys of tasks.</p>
<div class="table"><table>$table</table></div>
</body></html>
""")


def sweep_page(title: str, table: SweepTable, found: Sequence[Outcome]) -> str:
    """The page as text: figures and scripts inside, nothing loaded from elsewhere."""
    models = dict.fromkeys(outcome.run.model for outcome in found)
    states = table.column("state")
    counts = ", ".join(f"{states.count(s)} {s}" for s in ("whole", "partial", "failed") if s in states)
    drawn = any(o.state != "failed" and o.run.point.number for o in found)
    curves = "".join(f"<h2>Curves of the {_NAMES[m]}</h2>{curves_figure(found, m)}" for m in models)
    points = len({o.run.point.number for o in found if o.run.point.number})
    return _PAGE.substitute(
        title=for_html(f"{title}: parameter study"),
        lead=for_html(f"{points} points; curves: {counts}. Varied: {', '.join(table.labels)}."),
        plotly=plotly_script(),
        coordinates=parallel_coordinates(table) if drawn else "<p>No point has a curve.</p>",
        curves=curves,
        table=_table(table),
    )


def _table(table: SweepTable) -> str:
    names = [name for name in table.names if name != "task_key"]
    head = "".join(f"<th>{for_html(name).replace('_', '_<wbr>')}</th>" for name in names)
    rows = []
    for i, state in enumerate(table.column("state")):
        cells = "".join(_cell(table.rows[i][table.names.index(name)]) for name in names)
        rows.append(f'<tr class="{state}">{cells}</tr>')
    return f"<thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody>"


def _cell(cell: Cell) -> str:
    if isinstance(cell, str):
        return f'<td class="text">{for_html(cell)}</td>'
    return "<td></td>" if cell is None else f"<td>{cell:.5g}</td>"
