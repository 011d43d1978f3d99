"""Plain files that tasks write and comparison reads: JSON with exact floats. Curves have their own module."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

__all__ = ["RESULT", "read_result", "write_result"]

RESULT = "result.json"


def write_result(folder: Path, numbers: Mapping[str, Any]) -> None:
    """Write the numbers of a task; refuses NaN and infinity."""
    (folder / RESULT).write_text(json.dumps(numbers, indent=1, allow_nan=False), encoding="utf-8")


def read_result(folder: Path) -> dict[str, Any]:
    """Numbers of a task."""
    result: dict[str, Any] = json.loads((folder / RESULT).read_text(encoding="utf-8"))
    return result
