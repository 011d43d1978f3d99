"""Figures of the rover's tires against the FE curves. Verified by tests/unit/test_workbench_rover_crosscheck.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import DASHES, MARKERS, add_area, add_plain
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS, ORIENTATION_COLOURS
from workbench.questions.rover_crosscheck.results import ALLOWED, CrossCheck, lattice

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["crosscheck_figures"]


def crosscheck_figures(study: Study, found: CrossCheck) -> dict[str, str]:
    """Deflection of the standing rover around the wheel, and the load sweep."""
    return {"crosscheck_around": _around(found), "crosscheck_sweep": _sweep(found)}


def _around(found: CrossCheck) -> str:
    """Deflection against orientation: FE at the rover's load, each tire under the rover."""
    figure = empty_figure("orientation [deg]", "deflection at the rover's wheel load [mm]")
    places = lattice(found.period)
    fe = [found.reference(o) for o in places]
    deflections = [1e3 * curve.deflection_at(found.static_load) for _, curve in fe]
    add_plain(figure, places, deflections, "FE", MODEL_COLOURS["fe"], width=3.0)
    solid = [i for i, (model, _) in enumerate(fe) if model == "solid"]
    x, y = [places[i] for i in solid], [deflections[i] for i in solid]
    style = {"color": MODEL_COLOURS["fe"], "size": 10}
    figure.add_scatter(x=x, y=y, name="FE, solid", mode="markers", marker=style)
    for k, tire in enumerate(tire for tire in found.stood if tire.points):
        y = [1e3 * d.point.deflection for d in found.around(tire, found.static_load)]
        name = f"ANCF, {tire.name.replace('_', ' ')}{', kept' if tire.name == found.kept else ''}"
        style = {"color": ORIENTATION_COLOURS[(k + 1) % 6], "width": 2.0, "dash": DASHES[k % 3]}
        figure.add_scatter(x=places, y=y, name=name, mode="lines+markers", line=style,
                           marker={"symbol": MARKERS[k % 3], "size": 6})  # fmt: skip
    figure.update_yaxes(rangemode="normal")
    return figure_html(figure, "crosscheck-around")


def _sweep(found: CrossCheck) -> str:
    """Load against deflection: every wheel of the kept tire, their mean, the FE average with what is allowed."""
    figure, average, tire = empty_figure(), found.average, found.best
    d, F = 1e3 * average.deflection, average.load
    width = F * (found.mesh_study.relative_uncertainty(average.deflection) + ALLOWED)
    add_area(figure, d, F + width, F - width, "FE average, uncertainty and 5 %")
    add_plain(figure, d, F, "FE average", MODEL_COLOURS["fe"], width=3.0)
    wheels = [(1e3 * p.deflection, p.load) for p in tire.points]
    x, y = zip(*wheels, strict=True)
    figure.add_scatter(x=x, y=y, name="wheels of the rover", mode="markers",
                       marker={"size": 5, "color": ORIENTATION_COLOURS[1], "opacity": 0.5})  # fmt: skip
    means = [found.on_average(tire, load).point for load in tire.loads]
    deflections, loads = [1e3 * p.deflection for p in means], [p.load for p in means]
    add_plain(figure, deflections, loads, "their mean", MODEL_COLOURS["ancf"], width=2.5, mode="lines+markers")
    figure.update_layout(hovermode="closest")
    return figure_html(figure, "crosscheck-sweep")
