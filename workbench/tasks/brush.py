"""Task of the brush tire: its static line. Verified by tests/unit/test_workbench_tasks.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.curves import write_curve
from rover_dynamics.tires.brush_tire import BrushTireParameters, stiffness_curve

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve"]


def solve(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Static line of the brush tire: ``curve.csv``; where its parameters come from is added by who shows it."""
    parameters = BrushTireParameters(**inputs["parameters"], source="the study")
    write_curve(stiffness_curve(parameters, inputs["max_deflection"]), out / "curve.csv")
    return 0
