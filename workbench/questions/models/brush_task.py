"""The task of the brush tire's static line. Verified by tests/unit/test_workbench_tasks.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.curves import write_curve
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, stiffness_curve

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve"]


def solve(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Static line of the brush tire by its radial stiffness: ``curve.csv``; its source is added by who shows it."""
    tire = replace(THESIS_BRUSH, radial_stiffness=inputs["radial_stiffness"], source="the study")
    write_curve(stiffness_curve(tire, inputs["max_deflection"]), out / "curve.csv")
    return 0
