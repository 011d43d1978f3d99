"""What a graph's tasks will take, by the unknowns they will have: wall time and memory, before anything is meshed.

The laws are fitted to our own runs on one machine. Memory: two wheels at 15 600 to 228 000 unknowns, without friction
and with it (`make bench NAME=foretold_memory`; benchmarks/README.md, "Memory foretold"); beyond, it is extrapolated.
They lie 1 to 5 % above what the first two points of a curve took, within 2 % of a whole one with its fields; what is
not thin takes more: 11 % on 85 000 unknowns of thick spirals. Time of an iteration: the wheel at 37 000, 92 000 and
227 000 unknowns (benchmarks/README.md), within 8 %; a machine of another speed scales all times alike, which
`RemainingTime` learns as it goes.
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

__all__ = ["foreseen", "modes_bytes", "own_bytes", "solve_bytes", "solve_seconds"]

_MESH, _SOLVE = "workbench.questions.wheel.mesh_task:build", "workbench.questions.fe.task:solve_orientation"
_TRAVEL = "workbench.questions.fe.travel_task:solve_travel"
_MODES = "workbench.questions.modes.fe_task:solve"
_OWN = "workbench.questions.wheel.own_mesh_task:read"
_SECTION = "workbench.questions.section.task:solve_orientation"

_TETRAHEDRA = 1.2
"""Memory of a solve on tetrahedra over that on strips of as many unknowns [-]: 1.14 and 1.16 at 106 000 and 147 000."""
_STANDING, _MODES_ALONE = 8, 2
"""What modes take as points of a curve: until the wheel stands under its load, and where it need not."""
ITERATIONS = 3.0
"""Factorisations for each point of a curve; counted on the built-in study's curves."""


def solve_seconds(unknowns: float, points: int) -> float:
    """Wall time of one curve [s]: each factorisation t = 1.54e-6 s n^1.11, after 4 s of preparation."""
    return 4.0 + ITERATIONS * points * 1.54e-6 * math.pow(unknowns, 1.11)


def solve_bytes(unknowns: float, *, rough: bool = False) -> float:
    """Largest memory of the process that solves a curve [byte]: 265 MB of libraries and 3.0 kB n^1.038.

    On ``rough`` ground, with friction, whose tangent is unsymmetric, 3.4 kB n^1.079: both triangles are kept.
    """
    return 265e6 + (3.4e3 * math.pow(unknowns, 1.0785) if rough else 3.0e3 * math.pow(unknowns, 1.0376))


def modes_bytes(unknowns: float) -> float:
    """Largest memory of the process that finds ten modes or so and draws them [byte].

    Measured at 15 600 to 228 000 unknowns, within 5 %; below some 25 000 the drawing takes most.
    """
    return max(870e6, 510e6 + 6.4e3 * math.pow(unknowns, 1.0768))


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
    rough = task.function == _TRAVEL or task.inputs["friction"] > 0.0
    memory = modes_bytes(unknowns) if task.function == _MODES else solve_bytes(unknowns, rough=rough)
    return replace(task, cost=cost, memory=memory * filled.get(name, 1.0), unknowns=unknowns)


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
