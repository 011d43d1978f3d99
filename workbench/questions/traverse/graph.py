"""Tasks of `workbench traverse`. Verified by tests/unit/test_workbench_traverse.py."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from contracts.errors import InputError
from rover_dynamics.rover.scenarios.way import Way
from workbench.execution.task import Task
from workbench.questions.models.driving_brush import driving_inputs
from workbench.questions.models.wheel_tasks import solved_tire
from workbench.study.model import Study
from workbench.study.model_parameters import rover_on_brush
from workbench.study.strengths import yield_strengths

__all__ = ["TRAVERSE_TIRES", "Asked", "stretch_name", "traverse_tasks"]

TRAVERSE_TIRES = ("brush", "fe")
LONGEST = 20.0
"""Longest stretch [m]: so far nobody steers."""
NEAREST, FARTHEST = 0.1, 20000.0
"""[m]"""
_COSTS = {"brush": 0.8, "fe": 1.0}
"""Expected time by way [s/m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What is driven: distance [m] and speed [m/s], abundance of the rocks [-], their seed."""

    distance: float = 2000.0
    speed: float = 70.0 / 3600.0
    abundance: float = 0.06
    seed: int = 1

    def __post_init__(self) -> None:
        if not NEAREST <= self.distance <= FARTHEST:
            rule = f"must lie in [{NEAREST:g}, {FARTHEST:g}] m"
            raise InputError("distance", f"{self.distance:g} m", rule, "give metres, such as 2000")
        _ = self.way

    @property
    def stretches(self) -> int:
        """Number of stretches, all of one length."""
        return math.ceil(self.distance / LONGEST - 1e-9)

    @property
    def way(self) -> Way:
        """What they have in common."""
        length = self.distance / self.stretches
        return Way(length=length, speed=self.speed, abundance=self.abundance, seed=self.seed)


def stretch_name(tire: str, number: int) -> str:
    """Name of the task."""
    return f"traverse_{tire}_{number + 1:04d}"


def traverse_tasks(study: Study, tires: Sequence[str], asked: Asked) -> tuple[Task, ...]:
    """Every stretch on each of these tires, behind the tasks of the wheel they need.

    Raises
    ------
    InputError
        For a tire that is none of `TRAVERSE_TIRES`, or a study without [rover].
    """
    for tire in tires:
        if tire not in TRAVERSE_TIRES:
            raise InputError("tire of the traverse", repr(tire), "is not known", f"give {' or '.join(TRAVERSE_TIRES)}")
    if study.rover is None:
        hint = "copy it from studies/exomars.toml, if the wheel is of the rover's size"
        raise InputError("[rover]", "", "is missing: it says that a rover drives on the study's tires", hint)
    way, before, driven = asked.way, dict[str, Task](), list[Task]()
    given = {"length": way.length, "speed": way.speed, "abundance": way.abundance, "seed": way.seed}
    for tire in tires:
        own: dict[str, Any] = {"wheel": None, "strengths": None, **rover_on_brush(study)}
        needs: tuple[str, ...] = ()
        if tire == "fe":
            own["wheel"], tasks = solved_tire(study, tire)
            own["strengths"] = yield_strengths(study)
            before |= {task.name: task for task in tasks}
            needs = tuple(sorted({name for *_, name in (*own["wheel"]["curves"], *own["wheel"]["travels"])}))
        else:
            own |= driving_inputs(study)
        driven += [
            Task(
                name=stretch_name(tire, number),
                function="workbench.questions.traverse.task:drive_stretch",
                inputs={**given, **own, "stretch": number},
                needs=needs,
                cost=_COSTS[tire] * way.length,
            )
            for number in range(asked.stretches)
        ]
    return (*before.values(), *driven)
