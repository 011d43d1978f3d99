"""Reads stored results into typed records; the comparison and the report see nothing else.

Verified by tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve, read_curve
from contracts.records import Timing
from workbench.comparison.curves import CURVE
from workbench.execution.result_files import read_result
from workbench.execution.store import Entry
from workbench.study.model import Study
from workbench.study.model_parameters import brush_parameters
from workbench.study.wheel_design import part_materials

__all__ = [
    "brush_curve",
    "mesh_numbers",
    "task_timings",
]


def brush_curve(study: Study, folder: Path) -> StiffnessCurve:
    """The brush line of the task ``brush``, with the source that the study states for its parameters."""
    from rover_dynamics.tires.brush_tire import line_source

    return replace(read_curve(folder / CURVE, model="brush"), source=line_source(brush_parameters(study)))


def mesh_numbers(study: Study, folder: Path) -> dict[str, Any]:
    """Numbers of a mesh with the names that the study gives the wheel and its parts' materials."""
    numbers, materials = read_result(folder), part_materials(study)
    parts = {part: row | {"material": materials[part]} for part, row in numbers["parts"].items()}
    return numbers | {"design": study.name, "parts": parts}


def task_timings(entries: Mapping[str, Entry]) -> tuple[Timing, ...]:
    """Wall time of the computation behind each stored result, in the order of the graph."""
    return tuple(Timing(task=name, wall_s=entry.wall_s, dofs=entry.dofs) for name, entry in entries.items())
