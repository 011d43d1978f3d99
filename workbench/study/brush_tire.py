"""The brush tire as inputs of a task, and back. Verified by tests/unit/test_workbench_tasks.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from rover_dynamics.tires.brush_tire import BrushTireParameters

__all__ = ["brush_from", "brush_values"]


def brush_values(parameters: BrushTireParameters) -> dict[str, Any]:
    """A brush tire as inputs of a task: its numbers, without where they come from, on which no result depends.

    The lever is among them where it is not the usual one, so that what was kept before there was a choice still holds.
    """
    left_out = {"source", "lever"} if parameters.lever == "radius" else {"source"}
    return {name: value for name, value in asdict(parameters).items() if name not in left_out}


def brush_from(values: Mapping[str, Any]) -> BrushTireParameters:
    """The brush tire of a task's inputs, see `brush_values`."""
    return BrushTireParameters(**values, source="the study")
