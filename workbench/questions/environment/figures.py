"""Figures of the question on temperature. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS
from workbench.charts.curves import named
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import INK, ORIENTATION_COLOURS

if TYPE_CHECKING:
    from workbench.questions.environment.results import Series
    from workbench.study.model import Study

__all__ = ["environment_figures"]


def environment_figures(study: Study, results: tuple[Series, ...]) -> dict[str, str]:
    """Load at each temperature, and its ratio to that at 20 C with what the modulus alone would give."""
    loads = empty_figure()
    ratios = empty_figure(y="load / load at 20 °C")
    ratios.update_yaxes(rangemode="normal", title_standoff=12)
    ratios.update_layout(margin_l=84)
    colours = iter(ORIENTATION_COLOURS * 4)
    for series in results:
        for run in series.runs:
            line = {"color": next(colours), "width": 2.0, "dash": "solid" if series is results[0] else "dash"}
            name = f"{series.label}, {run.temperature - KELVIN_AT_ZERO_CELSIUS:g} °C"
            x = run.curve.deflection * 1e3
            shown = named(name, run.curve)
            loads.add_scatter(x=x, y=run.curve.load, name=shown, mode="lines", line=line)
            if run is series.reference or not series.comparable(run):
                continue
            at, ratio = series.load_ratio(run)
            ratios.add_scatter(x=at * 1e3, y=ratio, name=name, mode="lines+markers", line=line)
            if run.modulus_ratio is not None:
                own = {"color": INK, "width": 1, "dash": "dot"}
                label = f"E ratio {run.modulus_ratio:.3f}"
                ratios.add_hline(y=run.modulus_ratio, line=own, annotation={"text": label})
    return {
        "temperature_loads": figure_html(loads, "temperature-loads"),
        "temperature_ratios": figure_html(ratios, "temperature-ratios"),
    }
