"""Tasks of the wheel with its springs in phase, and of the hoops beside it.

Verified by tests/unit/test_workbench_thesis_words.py.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from workbench.execution.task import Task
from workbench.questions.section.graph import section_task, section_tasks, without_planar_model
from workbench.study.model import Study
from workbench.study.orientation import degrees, orientation_name
from workbench.study.reading import built_in_study, read_study

__all__ = ["HOOPS", "HOOPS_TWIN", "TWIN", "asked", "hoops", "hoops_tasks", "in_phase", "twin_tasks"]

TWIN, HOOPS, HOOPS_TWIN = "words_twin", "words_hoops", "words_hoops_twin"
DEFLECTIONS = (0.005, 0.010, 0.015, 0.020)
"""Of the twin's curves [m]: up to where spreads are compared."""


def asked(study: Study) -> bool:
    """Whether the wheel is the one the thesis speaks of, with the thesis' tires and more than one set of springs."""
    tires = study.ancf is not None and study.ancf.thesis_preset and study.brush is not None
    springs = without_planar_model(study) is None and len(study.parametric.springs) > 1
    return bool(study.of_the_thesis and tires and springs)


def in_phase(study: Study) -> Study:
    """The study with every set of springs at the phase of the first."""
    first, *others = study.parametric.springs
    springs = (first, *(one.model_copy(update={"phase": dict(first)["phase"]}) for one in others))
    return study.model_copy(update={"wheel": study.parametric.model_copy(update={"springs": springs})})


def twin_tasks(study: Study, name: str = TWIN) -> list[Task]:
    """The section model of the twin, ``words_twin_phi015``, at the study's orientations."""
    twin = in_phase(study)
    angles = [degrees(o) for o in study.fe.orientations]
    return [section_task(twin, orientation_name(name, o), o, DEFLECTIONS) for o in angles]


@cache
def hoops() -> Study:
    """The wheel that was built in before the search: its springs are hoops, which touch the rim."""
    return read_study(built_in_study().with_name("exomars_hoops.toml"))


def hoops_tasks() -> list[Task]:
    """The section model of the hoops, ``words_hoops_phi015``, and of their twin, ``words_hoops_twin_phi015``."""
    own = [replace(task, name=task.name.replace("section", HOOPS)) for task in section_tasks(hoops())]
    return [*own, *twin_tasks(hoops(), HOOPS_TWIN)]
