"""Tasks of the fit of the ANCF tire. Verified by tests/unit/test_workbench_ancf_fit.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

from contracts.hub_travel import Way
from workbench.execution.task import Task
from workbench.questions.travel_files import travel_name
from workbench.questions.travels import MESH_FULL, travel_tasks
from workbench.study.fit import FittedTireSection
from workbench.study.full import around, is_mirrored
from workbench.study.model import Study
from workbench.study.model_parameters import ancf_tire, fit_start
from workbench.study.orientation import degrees, orientation_name

__all__ = ["AS_IT_IS", "fit_name", "fit_tasks", "stand_name", "stand_task"]

AS_IT_IS = "ancf_as_it_is"
"""Task that holds the study's own tire against the FE curves."""


def fit_name(tire: str) -> str:
    """Name of the task that fits one of the study's tires."""
    return f"ancf_fit_{tire}"


def stand_name(tire: str) -> str:
    """Name of the task that asks whether it stands."""
    return f"ancf_stands_{tire}"


def stand_task(study: Study, tire: str) -> Task:
    """Whether a fitted tire stands at every orientation; the doubled mesh at the first and the middle one."""
    orientations = [degrees(o) for o in study.fe.orientations]
    doubled = list(dict.fromkeys([orientations[0], orientations[len(orientations) // 2]]))
    return Task(
        name=stand_name(tire),
        function="workbench.questions.ancf_fit.stand_task:stands",
        inputs={"doubled_at_deg": doubled},
        needs=(fit_name(tire),),
        cost=60.0,
    )


def fit_tasks(study: Study, tires: Sequence[FittedTireSection] | None = None) -> list[Task]:
    """The study's own tire as it is, and one fit for each tire of [ancf_fit], or of those given.

    Where it asks for stiffnesses against travel, also the FE runs that find them.
    """
    section = study.ancf_fit
    if section is None:
        return []
    orientations = [degrees(o) for o in study.fe.orientations]
    common = {
        "orientations_deg": orientations,
        "load_range": list(section.load_range),
        "mirrored": is_mirrored(study),
        "around": asdict(around(study)),
    }
    needs = tuple(orientation_name("fe", o) for o in orientations)
    travels = list[Task]()
    if section.travel is not None:
        ways = tuple(Way(name) for name in section.travel.ways)
        named = {travel_name("fe", way, o) for way in ways for o in orientations}
        travels = [t for t in travel_tasks(study, "fe", ways, section.travel.load) if t.name in {MESH_FULL, *named}]
        common["travel"] = section.travel.model_dump(mode="json")
        needs += tuple(t.name for t in travels if t.name in named)
    own = ancf_tire(study) | common
    evaluate = "workbench.questions.ancf_fit.task:evaluate"
    tasks = [*travels, Task(name=AS_IT_IS, function=evaluate, inputs=own, needs=needs, cost=5.0)]
    for tire in section.tires if tires is None else tires:
        inputs = common | {
            "preset": asdict(fit_start(study, tire)),
            "free": [[name, *getattr(section.bounds, name)] for name in tire.free],
            "phase_starts": tire.phase_starts,
            "points": section.points,
            "average_weight": section.average_weight,
        }
        name, function = fit_name(tire.name), "workbench.questions.ancf_fit.task:fit"
        tasks.append(Task(name=name, function=function, inputs=inputs, needs=needs, cost=30.0))
    return tasks
