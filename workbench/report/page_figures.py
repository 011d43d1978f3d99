"""All figures and scenes of the page by name. Verified by tests/unit/test_workbench_page_figures.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import read_rover
from workbench.comparison.comparison import Comparison
from workbench.figures.interactive import ancf_figure, fe_figure, models_figure, stress_figure
from workbench.figures.packing import picture_link
from workbench.study.model import Study
from workbench.tasks.orientation import orientation_name
from workbench.tasks.rover_still import ROVER_STILL
from workbench.topics.registry import topics_of

__all__ = ["joined_figures", "page_figures"]


def page_figures(
    study: Study, found: Comparison, results: Mapping[str, Path], *, partial: bool
) -> tuple[dict[str, str], dict[str, InputError]]:
    """Figures by name; and by topic, what a partial curve leaves without any.

    Parameters
    ----------
    study, found : what the report is about
    results : folder of each task's result by its name
    partial : a curve ended early, so that topics may lack their figures
    """
    first, *_ = [*found.fe.loaded.values(), found.fe.average]
    strengths = {p: study.materials[n["material"]].yield_strength for p, n in found.mesh["parts"].items()}
    figures = {
        "fe": fe_figure(found.fe, found.mesh_study, found.users, study.reference),
        "ancf": "" if found.ancf is None else ancf_figure(found.fe.average, found.ancf),
        "models": models_figure(
            found.fe.average,
            found.mesh_study,
            found.users,
            study.reference,
            ancf=None if found.ancf is None else found.ancf.average,
            brush=found.brush,
        ),
        "stress": stress_figure(first, strengths),
        **_scenes(found, results, min(strengths.values())),
    }
    lacking = {}
    for topic in topics_of(study):
        try:
            figures = joined_figures(figures, topic.figures(study, found.topics[topic.name]))
        except InputError as error:
            if not partial:
                raise
            lacking[topic.name] = error
    return figures, lacking


def _scenes(found: Comparison, results: Mapping[str, Path], yield_strength: float) -> dict[str, str]:
    """What turns: the wheel's parts, its shapes under load, the rover where the report has one."""
    from workbench.figures.rover_scene import rover_scene
    from workbench.figures.wheel_scene import parts_scene, stress_scene

    solved = {o: results[orientation_name("fe", o)] for o in found.fe.by_orientation}
    still = next(iter(sorted(results["pictures"].glob("deformed_*N.png"))), None)
    deformed = "" if still is None else picture_link(still)
    return {
        "parts_scene": parts_scene(results["mesh_whole"], picture_link(results["pictures"] / "wheel.png")),
        "stress_scene": stress_scene(results["mesh"], solved, yield_strength, deformed),
        "rover_scene": rover_scene(read_rover(), picture_link(results[ROVER_STILL] / "rover.png"))
        if ROVER_STILL in results
        else "",
    }


def joined_figures(figures: Mapping[str, str], more: Mapping[str, str]) -> dict[str, str]:
    """Both; a name that two topics give would let one section show the other's figure."""
    twice = sorted(figures.keys() & more.keys())
    if twice:
        raise ValueError(f"figures of two topics have the same name: {', '.join(twice)}")
    return {**figures, **more}
