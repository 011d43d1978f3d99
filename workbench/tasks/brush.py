"""The brush tire of a task, and the task of its static line. Verified by tests/unit/test_workbench_tasks.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.curves import write_curve
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters, stiffness_curve

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["brush_from", "brush_values", "solve"]


def brush_values(parameters: BrushTireParameters) -> dict[str, float]:
    """A brush tire as inputs of a task: its numbers, without where they come from, on which no result depends."""
    return {name: value for name, value in asdict(parameters).items() if name != "source"}


def brush_from(values: Mapping[str, float]) -> BrushTireParameters:
    """The brush tire of a task's inputs, see `brush_values`."""
    return BrushTireParameters(**values, source="the study")


def solve(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Static line of the brush tire by its radial stiffness: ``curve.csv``; its source is added by who shows it."""
    tire = replace(THESIS_BRUSH, radial_stiffness=inputs["radial_stiffness"], source="the study")
    write_curve(stiffness_curve(tire, inputs["max_deflection"]), out / "curve.csv")
    return 0
