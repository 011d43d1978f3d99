"""What an ANCF wheel stands on, from a task's inputs. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from contracts.terrain import Plane, Terrain
from contracts.terrain_ridges import Cleat, HalfRound, Step

__all__ = ["terrain_of"]


def terrain_of(values: Mapping[str, Any]) -> Terrain:
    """Terrain from ``fe.obstacle`` of a study: shape, lengths [m], yaw [rad]; its highest level is z = 0."""
    shapes: dict[str, Callable[[], Terrain]] = {
        "plane": Plane,
        "step": lambda: Step(
            rise=values["height"], edge_radius=values["edge_radius"], base=-values["height"], **_place(values)
        ),
        "cleat": lambda: Cleat(
            rise=values["height"],
            width=values["width"],
            edge_radius=values["edge_radius"],
            base=-values["height"],
            **_place(values),
        ),
        "half_round_rock": lambda: HalfRound(radius=values["radius"], base=-values["radius"], **_place(values)),
    }
    return shapes[values["shape"]]()


def _place(values: Mapping[str, Any]) -> dict[str, float]:
    return {"position": values["position"], "yaw": values["yaw"]}
