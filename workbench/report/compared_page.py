"""What ``workbench compare`` shows and writes: rows of a table, a page, JSON, CSV.

Verified by tests/unit/test_workbench_compared_page.py.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from contracts.csv_table import CsvTable, table_text
from contracts.text import for_html
from workbench.questions.two_curves.pair import CurvePair

__all__ = ["Row", "compared_html", "compared_rows", "compared_table", "compared_values", "sentence"]

_TEMPLATES = Path(__file__).parent / "templates"
_COLOURS = {"passed": "pass", "failed": "fail", "undecided": "error", "not judged": ""}
_NOTES = (
    "Compared at equal deflection over the range both curves share. Tangents: local regression (a parabola through the "
    "curve's own points within a tenth of the range, five at least). Energy: work under the piecewise linear curve. "
    "Uncertainty of the difference: both curves' stated intervals, combined as root of the sum of squares; its part in "
    "the relative L2 norm is the norm of it over the reference's."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A line of the table; empty where a column has no meaning."""

    quantity: str
    curve: str = ""
    reference: str = ""
    difference: str = ""


def compared_rows(pair: CurvePair) -> list[Row]:
    """The table, in the units a reader expects."""
    m, t, energies = pair.metrics, pair.tangents, pair.energies
    share = "" if t.share is None else f" ({100.0 * t.share:.2f} % of the reference's)"
    spread = "" if pair.judgement.uncertainty is None else f" ± {100.0 * pair.judgement.uncertainty:.3f} %"
    rows = [
        Row(quantity=f"range of {pair.reference.kind}", difference=f"{1e3 * m.start:.3f} .. {1e3 * m.end:.3f} mm"),
        Row(quantity="relative L2 difference", difference=f"{100.0 * m.relative_l2:.3f} %{spread}"),
        Row(quantity="largest difference", difference=f"{m.max_error:.3f} N at {1e3 * m.max_error_at:.2f} mm"),
        Row(
            quantity="mean slope",
            curve=f"{1e-3 * m.tangent:.4f} N/mm",
            reference=f"{1e-3 * m.tangent_reference:.4f} N/mm",
            difference=_percent(m.tangent - m.tangent_reference, m.tangent_reference),
        ),
        Row(
            quantity="largest difference of tangents",
            difference=f"{1e-3 * t.largest:.4f} N/mm at {1e3 * t.at:.2f} mm{share}",
        ),
    ]
    if t.relative_l2 is not None:
        rows.append(Row(quantity="tangents: relative L2 difference", difference=f"{100.0 * t.relative_l2:.3f} %"))
    if energies is not None:
        start = "" if energies.low == 0.0 else f" from {energies.low:.4g}"
        rows.append(
            Row(
                quantity=f"energy{start} to {energies.high:.4g} N",
                curve=f"{energies.work:.5g} J",
                reference=f"{energies.reference:.5g} J",
                difference=_percent(energies.work - energies.reference, energies.reference),
            )
        )
    if pair.iso_rating is not None:
        rating = "not defined" if math.isnan(pair.iso_rating) else f"{pair.iso_rating:.4f}"
        rows.append(Row(quantity="ISO/TS 18571 rating", difference=rating))
    return rows


def compared_values(pair: CurvePair) -> dict[str, Any]:
    """``compare.json``, schema 1; SI throughout. ``iso_rating`` is there if it was asked for, null if not defined."""
    asked = pair.iso_rating
    rating = {} if asked is None else {"iso_rating": None if math.isnan(asked) else asked}
    return {
        "schema": 1,
        "curve": {"name": pair.curve.curve.model, "source": pair.curve.curve.source},
        "reference": {"name": pair.reference.curve.model, "source": pair.reference.curve.source},
        "deformation": pair.reference.kind,
        "metrics": pair.metrics.as_dict() | rating,
        "tangents": asdict(pair.tangents),
        "energies": None if pair.energies is None else asdict(pair.energies),
        "judgement": asdict(pair.judgement),
    }


def compared_table(pair: CurvePair) -> str:
    """``compare.csv``: what the figure draws, in SI."""
    s = pair.samples
    columns = {
        "deflection_m": s.deflection,
        "load_N": s.load,
        "reference_load_N": s.reference,
        "difference_N": s.load - s.reference,
        "tangent_N_per_m": s.tangent,
        "reference_tangent_N_per_m": s.reference_tangent,
    }
    if s.uncertainty is not None:
        columns["difference_uncertainty_N"] = s.uncertainty
    source = f"{pair.curve.curve.model} against {pair.reference.curve.model}"
    values = np.column_stack(list(columns.values()))
    return table_text(CsvTable(names=tuple(columns), values=values, source=source, partial=False))


def compared_html(pair: CurvePair) -> str:
    """The page as text; nothing is loaded from elsewhere."""
    from workbench.charts.interactive import plotly_script
    from workbench.questions.two_curves.figures import compared_figure

    both = (pair.curve.curve, pair.reference.curve)
    partial = [f"{one.model} is partial: its run ended before its target." for one in both if one.partial]
    values = {
        "title": for_html(f"{both[0].model} against {both[1].model}"),
        "sources": for_html(" · ".join(f"{one.model}: {one.source or 'no source stated'}" for one in both)),
        "class": _COLOURS[pair.judgement.outcome],
        "outcome": pair.judgement.outcome,
        "sentence": for_html(sentence(pair)),
        "rows": "\n".join(_html_row(row) for row in compared_rows(pair)),
        "notes": for_html(" ".join([*partial, _NOTES])),
        "style": (_TEMPLATES / "style.css.j2").read_text(encoding="utf-8"),
        "plotly": plotly_script(),
        "figure": compared_figure(pair),
    }
    return Template((_TEMPLATES / "compared.html").read_text(encoding="utf-8")).substitute(values)


def sentence(pair: CurvePair) -> str:
    """The judgement in one sentence."""
    return f"Relative L2 difference {100.0 * pair.judgement.difference:.3f} %, {pair.judgement.why}."


def _html_row(row: Row) -> str:
    numbers = "".join(f'<td class="n">{for_html(text)}</td>' for text in (row.curve, row.reference, row.difference))
    return f"<tr><td>{for_html(row.quantity)}</td>{numbers}</tr>"


def _percent(difference: float, reference: float) -> str:
    return f"{100.0 * difference / reference:+.2f} %" if reference != 0.0 else ""
