"""What a wheel stands on, from a task's inputs. Verified by tests/unit/test_workbench_contact.py."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from reference_fe.contact.obstacles import Cleat, HalfRoundRock, Obstacle, Plane, StepEdge

__all__ = ["obstacle_of"]

_SHAPES: dict[str, Callable[..., Obstacle]] = {
    "plane": Plane,
    "step": StepEdge,
    "cleat": Cleat,
    "half_round_rock": HalfRoundRock,
}


def obstacle_of(values: Mapping[str, Any]) -> Obstacle:
    """Obstacle from ``fe.obstacle`` of a study: shape, lengths [m], yaw [rad]."""
    lengths = {name: value for name, value in values.items() if name not in ("shape", "yaw")}
    return _SHAPES[values["shape"]](**lengths, yaw_deg=math.degrees(values.get("yaw", 0.0)))
