"""Figures of the mission on fitted ANCF tires. Verified by tests/unit/test_workbench_rover_mission.py."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.charts.curves import add_plain
from workbench.charts.interactive import empty_figure, figure_html
from workbench.charts.palette import MODEL_COLOURS
from workbench.questions.rover_mission.requirements import TITLES

if TYPE_CHECKING:
    from workbench.questions.rover_mission.results import Mission
    from workbench.study.model import Study

__all__ = ["mission_figures"]

_SIDES = ("front_left", "front_right", "rear_left", "rear_right")


def mission_figures(study: Study, results: Mission) -> dict[str, str]:
    """Of each run that moved, by name: the heaviest of four wheels' loads, and the speed ahead, on both tires."""
    return {
        f"mission_{name}_{column}": _both(results, name, column)
        for name, drive in results.fitted.items()
        if drive.series is not None
        for column in ("load", "place")
    }


def _both(results: Mission, name: str, column: str) -> str:
    label = "heaviest wheel load [N]" if column == "load" else "way of the body ahead [m]"
    figure = empty_figure("time [s]", label)
    for tire, drives in (("brush", results.brush), ("ancf", results.fitted)):
        series = drives[name].series if name in drives else None
        if series is None:
            continue
        way = series["body_x_m"] - series["body_x_m"][0]
        heaviest = series[f"{_SIDES[0]}_load_N"]
        for wheel in _SIDES[1:]:
            heaviest = heaviest.clip(min=series[f"{wheel}_load_N"])
        words = "brush tires" if tire == "brush" else "fitted ANCF tires"
        y = heaviest if column == "load" else way
        add_plain(figure, series.time, y, f"{words}, {TITLES[name]}", MODEL_COLOURS[tire])
    figure.update_yaxes(rangemode="normal")
    return figure_html(figure, f"mission-{name}-{column}".replace("_", "-"))
