"""How the hub travels, for whatever model solves it. Verified by tests/unit/test_workbench_travels.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contracts.curves import read_curve
from contracts.errors import InputError
from contracts.hub_travel import HubTravel, Way
from workbench.questions.model_curves import CURVE

__all__ = ["APPROACH", "PATH", "TRAVEL", "approach", "asked_steps", "hub_travel"]

TRAVEL, PATH = "travel.csv", "path.csv"
"""In a task's folder: of one way, and of a path."""
APPROACH = 5
"""Increments in which the wheel is pressed: friction depends on the way, and so on the steps."""


def hub_travel(inputs: Mapping[str, Any], needs: Mapping[str, Path]) -> HubTravel:
    """The path asked for, or one way from where the curve without friction bears the load asked for."""
    asked = inputs["travel"]
    if "path" in asked:
        return _through(asked)
    curve, load = read_curve(needs[inputs["curve"]] / CURVE), asked["load"]
    if load > (most := float(curve.load.max())):
        rule = (
            f"lies outside the curve without friction, which ends at {most:.4g} N, {1e3 * curve.deflection[-1]:.3g} mm"
        )
        raise InputError("load", f"{load:g} N", rule, "give less load, or raise fe.max_deflection")
    return HubTravel.along(way=Way(asked["way"]), start=curve.deflection_at(load), steps=tuple(asked["steps"]))


def asked_steps(asked: Mapping[str, Any]) -> int:
    """How many steps the travel of a task's inputs takes behind the approach."""
    return len(_through(asked).controls if "path" in asked else asked["steps"])


def _through(asked: Mapping[str, Any]) -> HubTravel:
    places = [{Way(name): value for name, value in place.items()} for place in asked["path"]]
    return HubTravel.through(places, asked["longest"])


def approach(deflection: float) -> tuple[float, ...]:
    """Deflections up to that from which the hub moves [m]."""
    return (*(deflection * k / APPROACH for k in range(1, APPROACH)), deflection)
