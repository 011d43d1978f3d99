"""What the parts of a wheel can bear, as a small file beside its fields.

Verified by tests/unit/test_viewer_yielding.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path

from contracts.errors import InputError
from contracts.foreign_folder import read_json

__all__ = ["PARTS_FILE", "parts_text", "read_parts"]

PARTS_FILE = "parts.json"
"""In the folder of the fields."""
_HINT = "run the report again, or take the file out of the folder"


def parts_text(yield_strength: Mapping[str, float]) -> str:
    """Text of `PARTS_FILE`: yield strengths [Pa] of the parts that have one, by name."""
    content = {"schema": 1, "yield_strength_Pa": dict(yield_strength)}
    return json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False) + "\n"


def read_parts(path: Path) -> dict[str, float]:
    """Yield strengths [Pa] by the name of the part, as `parts_text` has them.

    Raises
    ------
    InputError
        If the file is no such file.
    """
    found = read_json(path, "parts file", _HINT).get("yield_strength_Pa")
    numbers = isinstance(found, dict) and all(
        isinstance(value, (int, float)) and not isinstance(value, bool) and 0.0 < value < math.inf
        for value in found.values()
    )
    if not isinstance(found, dict) or not numbers:
        raise InputError("parts file", path, "must hold positive yield strengths in yield_strength_Pa", _HINT)
    return {name: float(value) for name, value in found.items()}
