"""Plain files that tasks write and comparison reads: JSON with exact floats. Curves have their own module."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from contracts.errors import IncrementRecord

__all__ = [
    "FAILURE",
    "RESULT",
    "UNSTABLE",
    "early_ends",
    "increment_rows",
    "increments_of",
    "losses_of_stability",
    "read_record",
    "read_result",
    "write_result",
]

RESULT = "result.json"
FAILURE = "failure"
"""Key under which a run that ended before its target says why; null or absent in a run that reached it."""

UNSTABLE = "unstable"
"""Key under which a run whose wheel does not stand says where and how; null or absent elsewhere."""


def write_result(folder: Path, numbers: Mapping[str, Any]) -> None:
    """Write the numbers of a task; refuses NaN and infinity."""
    (folder / RESULT).write_text(json.dumps(numbers, indent=1, allow_nan=False), encoding="utf-8")


def read_result(folder: Path) -> dict[str, Any]:
    """Numbers of a task."""
    result: dict[str, Any] = json.loads((folder / RESULT).read_text(encoding="utf-8"))
    return result


def read_record[Record](folder: Path, kind: type[Record]) -> Record:
    """Numbers of a task as the dataclass whose fields it wrote."""
    from pydantic import TypeAdapter

    return TypeAdapter(kind).validate_python(read_result(folder))


def increment_rows(records: Iterable[IncrementRecord]) -> list[dict[str, Any]]:
    """Attempts as JSON values; null is the residual of an iterate that was refused and has none."""
    return [
        asdict(one) | {"residuals": [value if math.isfinite(value) else None for value in one.residuals]}
        for one in records
    ]


def increments_of(result: Mapping[str, Any]) -> tuple[IncrementRecord, ...]:
    """The attempts among a task's numbers; none where it made none."""
    rows = result.get("increments", ())
    refused = ((math.inf if value is None else value for value in row["residuals"]) for row in rows)
    return tuple(IncrementRecord(**row | {"residuals": tuple(r)}) for row, r in zip(rows, refused, strict=True))


def early_ends(folders: Mapping[str, Path]) -> dict[str, str]:
    """Task name -> why its run ended before its target, for those that did."""
    return _told(folders, FAILURE)


def losses_of_stability(folders: Mapping[str, Path]) -> dict[str, str]:
    """Task name -> where and how its wheel does not stand, for those that do not."""
    return _told(folders, UNSTABLE)


def _told(folders: Mapping[str, Path], key: str) -> dict[str, str]:
    reasons = {n: read_result(folder).get(key) for n, folder in folders.items() if (folder / RESULT).exists()}
    return {name: str(reason) for name, reason in reasons.items() if reason}
