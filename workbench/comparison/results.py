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
from workbench.comparison.curves import CURVE, model_curves
from workbench.execution.result_files import read_result
from workbench.execution.store import Entry
from workbench.study.model import Study
from workbench.study.model_parameters import brush_parameters
from workbench.study.wheel_design import part_materials

__all__ = [
    "brush_curve",
    "mesh_numbers",
    "stiffness_curves",
    "task_timings",
    "yield_strengths",
]


def brush_curve(study: Study, folder: Path) -> StiffnessCurve:
    """The brush line of the task ``brush``, with the source that the study states for its parameters."""
    from rover_dynamics.tires.brush_tire import line_source

    return replace(read_curve(folder / CURVE, model="brush"), source=line_source(brush_parameters(study)))


def stiffness_curves(study: Study, model: str, folders: Mapping[str, Path]) -> list[StiffnessCurve]:
    """Curves of one model from its tasks' folders, in order of orientation, and behind them their average.

    The brush has one line at every orientation, its average.
    """
    if model == "brush":
        return [brush_curve(study, folders["brush"])]
    found = model_curves(model, folders)
    return [*found.by_orientation.values(), found.average]


def yield_strengths(study: Study) -> dict[str, float]:
    """Yield strength [Pa] of each part of the mesh."""
    return {part: study.materials[name].yield_strength for part, name in part_materials(study).items()}


def mesh_numbers(study: Study, folder: Path) -> dict[str, Any]:
    """Numbers of a mesh with the names that the study gives the wheel and its parts' materials."""
    numbers, materials = read_result(folder), part_materials(study)
    parts = {part: row | {"material": materials[part]} for part, row in numbers["parts"].items()}
    return numbers | {"design": study.name, "parts": parts}


def task_timings(entries: Mapping[str, Entry]) -> tuple[Timing, ...]:
    """Wall time of the computation behind each stored result, in the order of the graph."""
    return tuple(Timing(task=name, wall_s=entry.wall_s, dofs=entry.dofs) for name, entry in entries.items())
