"""What a graph's tasks will take, by the unknowns they will have: wall time and memory, before anything is meshed.

The laws are fitted to our own runs on one machine. Memory: the wheel at 23 000, 42 000, 80 000, 151 000, 227 000 and
329 000 unknowns, met within 5 %; beyond, it is extrapolated. Time of an iteration: the wheel
at 37 000, 92 000 and 227 000 unknowns (benchmarks/README.md), within 8 %; a machine of another speed scales all times
alike, which `RemainingTime` learns as it goes.
Verified by tests/unit/test_workbench_foresight.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from geometry.build import mesh_size
from geometry.counting import MeshCount, count_planar, count_solid, require_buildable
from workbench.execution.fingerprint import canonical_json
from workbench.execution.task import Task
from workbench.questions.travel_start import APPROACH
from workbench.study.wheel_design import design_from

__all__ = ["foreseen", "solve_bytes", "solve_seconds"]

_MESH, _SOLVE = "workbench.questions.wheel.mesh_task:build", "workbench.questions.fe.task:solve_orientation"
_TRAVEL = "workbench.questions.fe.travel_task:solve_travel"
_SECTION = "workbench.questions.section.task:solve_orientation"

_UNSYMMETRIC = 2.0
"""Factors with friction over those without [-]: both triangles are kept."""
ITERATIONS = 3.0
"""Factorisations for each point of a curve; counted on the built-in study's curves."""


def solve_seconds(unknowns: float, points: int) -> float:
    """Wall time of one curve [s]: each factorisation t = 1.54e-6 s n^1.11, after 4 s of preparation."""
    return 4.0 + ITERATIONS * points * 1.54e-6 * math.pow(unknowns, 1.11)


def solve_bytes(unknowns: float) -> float:
    """Largest memory of the process that solves a curve [byte]: 280 MB of libraries and 2.55 kB n^1.066."""
    return 280e6 + 2.55e3 * math.pow(unknowns, 1.066)


def mesh_seconds(count: MeshCount) -> float:
    """Wall time of a mesh with its checks [s]."""
    return 1.0 + 3e-4 * count.cells


def mesh_bytes(count: MeshCount) -> float:
    """Largest memory of the process that makes a mesh [byte]."""
    return 245e6 + 5e3 * count.cells


def foreseen(tasks: Sequence[Task]) -> tuple[Task, ...]:
    """The same graph; meshes and what is solved on them with their expected wall time, memory and unknowns.

    Raises
    ------
    InputError
        If a mesh would have more cells than can be built.
    """
    counts: dict[str, MeshCount] = {}
    kept: dict[str, MeshCount] = {}
    found = []
    for task in tasks:
        if task.function in (_MESH, _SECTION):
            made_of = canonical_json({"function": task.function, **{n: task.inputs[n] for n in ("wheel", "options")}})
            if made_of not in kept:
                kept[made_of] = _count(task)
            counts[task.name] = kept[made_of]
        found.append(_with_needs(task, counts))
    return tuple(found)


def _with_needs(task: Task, counts: Mapping[str, MeshCount]) -> Task:
    if task.function == _MESH:
        count = counts[task.name]
        return replace(task, cost=mesh_seconds(count), memory=mesh_bytes(count))
    name, dim = (task.name, 2) if task.function == _SECTION else (next(iter(task.needs), ""), 3)
    if task.function not in (_SOLVE, _SECTION, _TRAVEL) or name not in counts:
        return task
    unknowns = dim * counts[name].nodes
    points = len(task.inputs["deflections"])
    if task.inputs.get("unload"):
        points *= 2
    if task.function == _TRAVEL:
        points = APPROACH + len(task.inputs["travel"]["steps"])
    cost = solve_seconds(unknowns, points)
    memory = solve_bytes(unknowns) * (_UNSYMMETRIC if task.function == _TRAVEL else 1.0)
    return replace(task, cost=cost, memory=memory, unknowns=unknowns)


def _count(task: Task) -> MeshCount:
    """The mesh that a task will make, from its inputs."""
    design = design_from(task.inputs["wheel"])
    options = dict[str, Any](task.inputs["options"])
    given: dict[str, Any] = {"axial_size": None, "edge_size": None, **options}
    names = ("element_size", "axial_size", "thickness_elements", "refinement", "edge_size")
    sizes = (given[name] for name in names)
    size = replace(mesh_size(design, *sizes), factor=options["factor"])
    if task.function == _SECTION:
        count = count_planar(design, size, options["order"])
    else:
        count = count_solid(design, size, options["order"], options["parts"], half_width=options["half_width"])
    require_buildable(count, {"element_size": size.element_size, "axial_size": size.axial_size})
    return count
