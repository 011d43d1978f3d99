"""Travels of the hub as their tasks leave them. Verified by tests/unit/test_workbench_ancf_fit_travel.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from contracts.hub_travel import Way
from contracts.travel_curve import TravelCurve, read_travel
from workbench.questions.travel_start import TRAVEL
from workbench.study.orientation import orientation_name

__all__ = ["travel_curves", "travel_name"]


def travel_curves(
    model: str,
    ways: Sequence[Way],
    orientations_deg: Sequence[float],
    folders: Mapping[str, Path],
    *,
    small: bool = False,
) -> list[TravelCurve]:
    """What the tasks found; a run that ended before its first step has none."""
    named = [
        (way, o, folders[travel_name(model, way, o, small=small)] / TRAVEL) for o in orientations_deg for way in ways
    ]
    return [read_travel(path, model, way, o) for way, o, path in named if path.exists()]


def travel_name(model: str, way: Way, orientation_deg: float, *, small: bool = False) -> str:
    """Name of the task of one travel, or of its small step alone."""
    return orientation_name(f"{model}_{way}_small" if small else f"{model}_{way}", orientation_deg)
