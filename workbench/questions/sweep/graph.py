"""Tasks of a parameter study: those of every point and model in one graph, what is alike computed once.

Verified by tests/unit/test_workbench_sweep.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from workbench.execution.task import Task, bare_name
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.fe.graph import material_inputs
from workbench.study.own_mesh import materials_by_part
from workbench.study.sweep import SweptModel
from workbench.study.sweep_points import Point

__all__ = ["SweepGraph", "SweepRun", "sweep_graph"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepRun:
    """One model at one point: the tasks of its curves by their bare names, and every task that it needs."""

    point: Point
    model: SweptModel
    curves: dict[str, str]
    tasks: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepGraph:
    """Tasks in an order where each follows those it needs, the runs they belong to, and the key of each task."""

    tasks: tuple[Task, ...]
    runs: tuple[SweepRun, ...]
    keys: dict[str, str]


def sweep_graph(points: Sequence[Point], models: Sequence[SweptModel]) -> SweepGraph:
    """The graph of every point and model.

    A task is named ``p3/fe_phi015`` after the first point that has it; a task of another point with the same key is the
    same task. Keys are those of `workbench stiffness`, so that results are shared with it.

    Raises
    ------
    InputError
        If the wheel of a point has no planar model and that is asked for.
    """
    tasks: dict[str, Task] = {}
    keys: dict[str, str] = {}
    by_key: dict[str, str] = {}
    runs = []
    for point in points:
        for model in models:
            names: dict[str, str] = {}
            for task in _model_tasks(point, model):
                scoped = replace(task, name=f"p{point.number}/{task.name}", needs=tuple(names[n] for n in task.needs))
                key = scoped.key(keys)
                name = names[task.name] = by_key.setdefault(key, scoped.name)
                if name == scoped.name:
                    tasks[name], keys[name] = scoped, key
            curves = {bare_name(n): n for n in names.values() if bare_name(n).startswith((f"{model}_phi", "brush"))}
            runs.append(SweepRun(point=point, model=model, curves=curves, tasks=tuple(names.values())))
    return SweepGraph(tasks=tuple(tasks.values()), runs=tuple(runs), keys=keys)


def _model_tasks(point: Point, model: SweptModel) -> list[Task]:
    """Tasks of one model; at a temperature with the materials as they are then."""
    tasks = stiffness_tasks(point.study, model, ())
    if point.temperature is None:
        return list(tasks)
    cold = materials_by_part(point.study)
    warm = {"materials": material_inputs({part: m.at(point.temperature) for part, m in cold.items()})}
    return [replace(t, inputs={**t.inputs, **warm}) if t.name.startswith("fe_phi") else t for t in tasks]
