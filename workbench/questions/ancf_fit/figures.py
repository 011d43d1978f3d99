"""Figures of the fitted ANCF tires. Verified by tests/end_to_end/test_report.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import DASHES, MARKERS, add_plain
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS, ORIENTATION_COLOURS

if TYPE_CHECKING:
    from workbench.questions.ancf_fit.results import AncfFits
    from workbench.study.model import Study

__all__ = ["fit_figures"]


def fit_figures(study: Study, fits: AncfFits) -> dict[str, str]:
    """Averages of all tires with the FE's, and the kept tire at each orientation with the FE's points."""
    best, averages, fe = fits.best, empty_figure(), fits.fe.average
    add_plain(averages, 1e3 * fe.deflection, fe.load, "FE average", MODEL_COLOURS["fe"], width=5.0)
    for i, tire in enumerate(fits.all):
        preset, curve = tire.numbers.preset, tire.average
        label = f"{preset.spokes} spokes, {preset.circumferential_plates} rim plates"
        averages.add_scatter(
            x=1e3 * curve.deflection,
            y=curve.load,
            name=f"study's own: {label}" if tire is fits.own else f"fitted: {label}",
            mode="lines",
            line={"color": ORIENTATION_COLOURS[i % 6], "width": 2.2, "dash": DASHES[i % 6]},
            hovertemplate="%{y:.1f} N",
        )
    each = empty_figure()
    for i, (orientation, curve) in enumerate(best.curves.items()):
        solid, colour = fits.fe.by_orientation[orientation], ORIENTATION_COLOURS[i % 6]
        each.add_scatter(x=1e3 * curve.deflection, y=curve.load, name=f"fitted {orientation:g}°", mode="lines",
                         line={"color": colour, "width": 2.0, "dash": DASHES[i % 6]})  # fmt: skip
        each.add_scatter(x=1e3 * solid.deflection, y=solid.load, name=f"FE {orientation:g}°", mode="markers",
                         marker={"symbol": MARKERS[i % 6], "size": 7, "color": colour})  # fmt: skip
    return {
        "ancf_fit_averages": figure_html(averages, "ancf-fit-averages"),
        "ancf_fit_orientations": figure_html(each, "ancf-fit-orientations"),
    }
