"""Tasks of a parameter study: those of every point and model in one graph, what is alike computed once.

Verified by tests/unit/test_workbench_sweep.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from contracts.hub_travel import Way
from workbench.execution.task import Task, bare_name
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.fe.graph import material_inputs
from workbench.questions.travel_files import travel_name
from workbench.questions.travels import travel_tasks
from workbench.study.orientation import degrees
from workbench.study.own_mesh import materials_by_part
from workbench.study.sweep import MOVED, SweptModel
from workbench.study.sweep_points import Point

__all__ = ["SweepGraph", "SweepRun", "sweep_graph"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepRun:
    """One model at one point: the tasks of its curves by their bare names, and every task that it needs.

    ``travels`` : way -> task of its travel at each orientation [deg].
    """

    point: Point
    model: SweptModel
    curves: dict[str, str]
    tasks: tuple[str, ...]
    travels: dict[Way, dict[float, str]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepGraph:
    """Tasks in an order where each follows those it needs, the runs they belong to, and the key of each task."""

    tasks: tuple[Task, ...]
    runs: tuple[SweepRun, ...]
    keys: dict[str, str]


def sweep_graph(
    points: Sequence[Point], models: Sequence[SweptModel], travels: tuple[Sequence[Way], float] = ((), 0.0)
) -> SweepGraph:
    """The graph of every point and model; ``travels`` are ways of the hub from a load [N], of models that have them.

    A task is named ``p3/fe_phi015`` after the first point that has it; a task of another point with the same key is the
    same task. Keys are those of `workbench stiffness`, so that results are shared with it.

    Raises
    ------
    InputError
        If the wheel of a point has no planar model and that is asked for, or cannot be moved as it is asked to be.
    """
    tasks: dict[str, Task] = {}
    keys: dict[str, str] = {}
    by_key: dict[str, str] = {}
    runs = []
    for point in points:
        for model in models:
            names: dict[str, str] = {}
            ways = tuple(travels[0]) if model in MOVED else ()
            for task in _model_tasks(point, model, ways, travels[1]):
                scoped = replace(task, name=f"p{point.number}/{task.name}", needs=tuple(names[n] for n in task.needs))
                key = scoped.key(keys)
                name = names[task.name] = by_key.setdefault(key, scoped.name)
                if name == scoped.name:
                    tasks[name], keys[name] = scoped, key
            curves = {bare_name(n): n for n in names.values() if bare_name(n).startswith((f"{model}_phi", "brush"))}
            at = [degrees(o) for o in point.study.fe.orientations]
            moved = {way: {o: names[travel_name(model, way, o)] for o in at} for way in ways}
            tasks_of = tuple(names.values())
            runs.append(SweepRun(point=point, model=model, curves=curves, tasks=tasks_of, travels=moved))
    return SweepGraph(tasks=tuple(tasks.values()), runs=tuple(runs), keys=keys)


def _model_tasks(point: Point, model: SweptModel, ways: Sequence[Way], load: float) -> list[Task]:
    """Tasks of one model; at a temperature with the materials as they are then."""
    study = point.study
    tasks = travel_tasks(study, model, ways, load) if ways else stiffness_tasks(study, model, ())
    if point.temperature is None:
        return list(tasks)
    cold = materials_by_part(point.study)
    warm = {"materials": material_inputs({part: m.at(point.temperature) for part, m in cold.items()})}
    return [replace(t, inputs={**t.inputs, **warm}) if "materials" in t.inputs else t for t in tasks]
