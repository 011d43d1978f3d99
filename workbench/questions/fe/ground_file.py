"""What a wheel stands on where that is no level plane, as a small file beside its fields.

Verified by tests/unit/test_viewer_ground.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.foreign_folder import read_json
from contracts.terrain import Terrain
from workbench.questions.ancf_wheel.ground import terrain_of

__all__ = ["GROUND_FILE", "ground_text", "read_ground"]

GROUND_FILE = "ground.json"
"""In the folder of the fields."""
_HINT = "run the report again, or take the file out of the folder"
_FARTHEST = 10.0
"""Largest length or angle in the file [m, rad]."""


def ground_text(obstacle: Mapping[str, Any], camber: float) -> str:
    """Text of `GROUND_FILE`: [fe.obstacle] in metres and radians, and the ground's camber [rad]."""
    content = {"schema": 1, "obstacle": dict(obstacle), "camber_rad": camber}
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def read_ground(path: Path) -> tuple[str, Terrain, float]:
    """Shape, terrain whose highest level is z = 0, and camber [rad], as `ground_text` has them.

    Raises
    ------
    InputError
        If the file is no such file.
    """
    found = read_json(path, "ground file", _HINT)
    try:
        obstacle, camber = dict(found["obstacle"]), float(found["camber_rad"])
        shape = obstacle.pop("shape")
        sizes = {name: float(value) for name, value in obstacle.items()}
        if not all(math.isfinite(one) and abs(one) <= _FARTHEST for one in (camber, *sizes.values())):
            raise ValueError(f"lengths and angles must lie within {_FARTHEST:g} m or rad")
        return shape, terrain_of({"shape": shape, **sizes}), camber
    except (KeyError, TypeError, ValueError) as error:
        reason = f"must hold an obstacle and a camber_rad ({type(error).__name__}: {str(error)[:120]})"
        raise InputError("ground file", path, reason, _HINT) from error
