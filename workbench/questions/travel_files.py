"""Travels of the hub as their tasks leave them. Verified by tests/unit/test_workbench_ancf_fit_travel.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from contracts.hub_travel import Way
from contracts.path_curve import PathCurve, read_path
from contracts.travel_curve import TravelCurve, read_travel
from workbench.questions.travel_start import PATH, TRAVEL
from workbench.study.orientation import orientation_name

__all__ = ["path_curves", "path_name", "travel_curves", "travel_name"]


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


def path_curves(model: str, orientations_deg: Sequence[float], folders: Mapping[str, Path]) -> list[PathCurve]:
    """What the tasks of a path found; a run that ended before its first step has none."""
    named = [(o, folders[path_name(model, o)] / PATH) for o in orientations_deg]
    return [read_path(path, model, o) for o, path in named if path.exists()]


def path_name(model: str, orientation_deg: float) -> str:
    """Name of the task of a path."""
    return orientation_name(f"{model}_path", orientation_deg)


def travel_name(model: str, way: Way, orientation_deg: float, *, small: bool = False) -> str:
    """Name of the task of one travel, or of its small step alone."""
    return orientation_name(f"{model}_{way}_small" if small else f"{model}_{way}", orientation_deg)
