"""Where a travel of the hub starts, for whatever model solves it. Verified by tests/unit/test_workbench_travels.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contracts.curves import read_curve
from contracts.hub_travel import HubTravel, Way
from workbench.questions.model_curves import CURVE

__all__ = ["APPROACH", "TRAVEL", "approach", "hub_travel"]

TRAVEL = "travel.csv"
"""In a task's folder."""
APPROACH = 5
"""Increments in which the wheel is pressed: friction depends on the way, and so on the steps."""


def hub_travel(inputs: Mapping[str, Any], needs: Mapping[str, Path]) -> HubTravel:
    """The travel from where the curve without friction bears the load asked for."""
    asked = inputs["travel"]
    curve = read_curve(needs[inputs["curve"]] / CURVE)
    return HubTravel(way=Way(asked["way"]), start=curve.deflection_at(asked["load"]), steps=tuple(asked["steps"]))


def approach(deflection: float) -> tuple[float, ...]:
    """Deflections up to that from which the hub moves [m]."""
    return (*(deflection * k / APPROACH for k in range(1, APPROACH)), deflection)
