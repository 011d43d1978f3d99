"""Figures of the topics on strength and temperature. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

import numpy as np

from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS
from workbench.checks.environment import Series
from workbench.comparison.yielding import StrengthResults, utilisation
from workbench.figures.interactive import empty_figure, figure_html, named
from workbench.figures.palette import INK, ORIENTATION_COLOURS

__all__ = ["environment_figures", "strength_figures"]


def environment_figures(results: tuple[Series, ...]) -> dict[str, str]:
    """Load at each temperature, and its ratio to that at 20 C with what the modulus alone would give."""
    loads = empty_figure()
    ratios = empty_figure(y="load / load at 20 °C")
    ratios.update_yaxes(rangemode="normal", tickformat=".3f", title_standoff=12)
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


def strength_figures(results: StrengthResults) -> dict[str, str]:
    """Utilisation of the most stressed part at each orientation, and of each part at its worst orientation."""
    around = empty_figure("load on the wheel [N]", "largest stress / yield strength")
    for i, (orientation, curve) in enumerate(results.curves.items()):
        most = np.max(list(utilisation(curve, results.yield_strength).values()), axis=0)
        line = {"color": ORIENTATION_COLOURS[i % 6], "width": 2.0}
        around.add_scatter(x=curve.load, y=most, name=f"{orientation:g}°", mode="lines+markers", line=line)
    parts = empty_figure("load on the wheel [N]", "largest stress / yield strength")
    for i, (part, (orientation, _)) in enumerate(results.by_part.items()):
        curve = results.curves[orientation]
        name = f"{part.replace('_', ' ')}, {orientation:g}°"
        line = {"color": ORIENTATION_COLOURS[i % 6], "width": 2.5}
        used = utilisation(curve, results.yield_strength)[part]
        parts.add_scatter(x=curve.load, y=used, name=name, mode="lines", line=line)
    for figure in (around, parts):
        figure.add_hline(y=1.0, line={"color": INK, "width": 1, "dash": "dash"}, annotation={"text": "yield"})
    return {
        "yield_by_orientation": figure_html(around, "yield-by-orientation"),
        "yield_by_part": figure_html(parts, "yield-by-part"),
    }
