"""A scenario on the brush tire of a task's inputs. Verified by tests/unit/test_workbench_driving_brush.py."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rover_dynamics.rover.scenarios.ground import on_brush_tires
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.tires.brush_settings import Carcass
from workbench.study.brush_tire import brush_from

__all__ = ["on_given_brush"]


def on_given_brush(scenario: Scenario, inputs: Mapping[str, Any]) -> Scenario:
    """The same on six tires of ``brush``, see `brush_from`, on a ``carcass`` [N/m] if the inputs hold one."""
    carcass = Carcass(*inputs["carcass"]) if "carcass" in inputs else None
    return on_brush_tires(scenario, brush_from(inputs["brush"]), carcass)
