"""What a graph's tasks will take, by the unknowns they will have: wall time and memory, before anything is meshed.

The laws are fitted to our own runs on one machine. Memory: the wheel at 23 000, 42 000, 80 000, 151 000, 227 000 and
329 000 unknowns with both triangles of the matrix kept; beyond, it is extrapolated. With friction they still are;
without, it is an upper bound, 7 to 10 % too much at 22 500 and 53 000 unknowns, half too much at 227 000. Time of an
iteration: the wheel at 37 000, 92 000 and 227 000 unknowns (benchmarks/README.md), within 8 %; a machine of another
speed scales all times
alike, which `RemainingTime` learns as it goes.
Verified by tests/unit/test_workbench_foresight.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from contracts.mesh import TaggedMesh
from geometry.build import mesh_size
from geometry.counting import MeshCount, count_planar, count_solid, require_buildable
from geometry.own_mesh.cell_checks import solid_cells
from geometry.own_mesh.file_counting import count_cells
from geometry.own_mesh.files import read_mesh_file
from geometry.own_mesh.step_files import STEP_ENDINGS
from workbench.execution.fingerprint import canonical_json
from workbench.execution.task import Task
from workbench.questions.travel_start import APPROACH, asked_steps
from workbench.questions.wheel.mesh_file import OWN_FILE
from workbench.study.wheel_design import design_from

__all__ = ["foreseen", "own_bytes", "solve_bytes", "solve_seconds"]

_MESH, _SOLVE = "workbench.questions.wheel.mesh_task:build", "workbench.questions.fe.task:solve_orientation"
_TRAVEL = "workbench.questions.fe.travel_task:solve_travel"
_MODES = "workbench.questions.modes.fe_task:solve"
_OWN = "workbench.questions.wheel.own_mesh_task:read"
_SECTION = "workbench.questions.section.task:solve_orientation"

_TETRAHEDRA = 1.3
"""Memory of a solve on tetrahedra over that on strips of as many unknowns [-]: 1.26 at 100 000 and 156 000."""
_UNSYMMETRIC = 2.0
"""Factors with friction over those without [-]: both triangles are kept."""
_STANDING, _MODES_ALONE = 8, 2
"""What modes take as points of a curve: until the wheel stands under its load, and where it need not."""
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
        If a mesh would have more cells than can be built, or its file cannot be read.
    """
    counts: dict[str, MeshCount] = {}
    filled: dict[str, float] = {}
    found = []
    for task in tasks:
        if task.function in (_MESH, _SECTION):
            inputs = {name: task.inputs[name] for name in ("wheel", "options")}
            counts[task.name] = _count(canonical_json(inputs), planar=task.function == _SECTION)
        elif task.function == _OWN and (own := _count_own(task)) is not None:
            counts[task.name], filled[task.name] = own
        found.append(_with_needs(task, counts, filled))
    return tuple(found)


def _with_needs(task: Task, counts: Mapping[str, MeshCount], filled: Mapping[str, float]) -> Task:
    if task.function in (_MESH, _OWN) and task.name in counts:
        count = counts[task.name]
        return replace(task, cost=mesh_seconds(count), memory=mesh_bytes(count))
    name, dim = (task.name, 2) if task.function == _SECTION else (next(iter(task.needs), ""), 3)
    if task.function not in (_SOLVE, _SECTION, _TRAVEL, _MODES) or name not in counts:
        return task
    unknowns = dim * counts[name].nodes
    points = len(task.inputs["deflections"])
    if task.inputs.get("unload"):
        points *= 2
    if task.function == _MODES:
        points = _STANDING if task.inputs["modes"]["state"] == "standing" else _MODES_ALONE
    if task.function == _TRAVEL:
        points = APPROACH + asked_steps(task.inputs["travel"])
    cost = solve_seconds(unknowns, points)
    memory = solve_bytes(unknowns) * (_UNSYMMETRIC if task.function == _TRAVEL else 1.0) * filled.get(name, 1.0)
    return replace(task, cost=cost, memory=memory, unknowns=unknowns)


def own_bytes(mesh: TaggedMesh, *, tetrahedra: bool) -> tuple[int, float]:
    """Unknowns of a wheel's own mesh, and the largest memory of the process that solves a curve on it [byte]."""
    unknowns = 3 * count_cells(mesh.cells).nodes
    return unknowns, solve_bytes(unknowns) * (_TETRAHEDRA if tetrahedra else 1.0)


def _count_own(task: Task) -> tuple[MeshCount, float] | None:
    """The mesh of a file from another program, and how much more memory its kind of cells takes than ours; None for
    solids that are yet to be meshed.
    """
    path = task.files[OWN_FILE]
    if path.suffix.lower() in STEP_ENDINGS:
        return None
    return _counted(path, task.inputs["sha256"], task.inputs["mesh"]["factor"])


@lru_cache(maxsize=16)
def _counted(path: Path, sha256: str, factor: int) -> tuple[MeshCount, float]:
    """Of one content of a file, whose hash is asked for so that another is counted anew."""
    cells, _ = solid_cells(read_mesh_file(path))
    return count_cells(cells, factor), _TETRAHEDRA if cells.shape[1] in (4, 10) else 1.0


@lru_cache(maxsize=64)
def _count(inputs: str, *, planar: bool) -> MeshCount:
    """The mesh that a task will make, from its inputs' JSON."""
    given: dict[str, Any] = json.loads(inputs)
    design, options = design_from(given["wheel"]), {"axial_size": None, "edge_size": None, **given["options"]}
    names = ("element_size", "axial_size", "thickness_elements", "refinement", "edge_size")
    size = replace(mesh_size(design, *(options[name] for name in names)), factor=options["factor"])
    if planar:
        count = count_planar(design, size, options["order"])
    else:
        count = count_solid(design, size, options["order"], options["parts"], half_width=options["half_width"])
    require_buildable(count, {"element_size": size.element_size, "axial_size": size.axial_size})
    return count
