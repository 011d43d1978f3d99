"""What ``make search`` keeps of its search: the plausible set for the report, the table for people.

``python -m workbench.questions.words.keeping FOLDER TABLE`` reads ``confirmed.json`` and ``sweep.csv`` of the folder
that `workbench sweep` filled. Verified by tests/unit/test_workbench_plausible.py.
"""

from __future__ import annotations

import csv
import json
import math
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from contracts.curves import read_curve
from contracts.errors import ConvergenceError, InputError
from contracts.text import for_json
from workbench.execution.task import Task
from workbench.questions.model_curves import CURVE
from workbench.questions.section.task import solve_orientation
from workbench.questions.words.graph import twin_tasks
from workbench.questions.words.plausible import RECORD, STRESS, TWIN_SPREAD, record_key
from workbench.questions.words.results import SPREAD_AT
from workbench.study.model import Study
from workbench.study.sweep_points import study_point

__all__ = ["keep", "kept_record"]

NEAREST = 10
"""Wheels that are kept where none satisfies every aim."""
_DROPPED = ("model", "wall_time_s", "task_key", "held_against", "relative_l2")
_DIGITS = 6
SPREAD = "spread_at_20mm"
ANNEALED, AGED = 880e6, 1100e6
"""Yield strength of Ti-6Al-4V, annealed and solution treated and aged [Pa] (MatWeb/ASM data sheets)."""
TWIN_ORIENTATIONS = 24
"""Over the 120 degrees after which three inner springs repeat themselves, as many as the wheels have."""


def kept_record(record: Mapping[str, Any]) -> dict[str, Any]:
    """The wheels of a search that satisfy every statement, in order of stress; if none does, those that miss least.

    The aim for the spread stands for statement 4 while searching; here each wheel is held against its own twin. That
    for the stress is the annealed alloy's strength; the set is that of the aged one.
    """
    loaded = [one for one in record["wheels"] if STRESS in one["numbers"]]
    wheels = [one for one in loaded if _largest_miss(one) <= 1.0 and one["numbers"][STRESS] <= AGED]
    nearest = sorted(loaded, key=_largest_miss)[:NEAREST]
    study = {key: value for key, value in record["study"].items() if key != "reference"}
    chosen = _varying_less_than_in_phase(study, sorted(wheels or nearest, key=lambda one: one["numbers"][STRESS]))
    kept: dict[str, Any] = {
        "study": study,
        "aims": record["aims"],
        "searched": record["searched"],
        "refused": record["refused"],
        "confirmed": len(record["wheels"]),
        "empty": not wheels,
        "strength": AGED,
        "annealed": sum(one["numbers"][STRESS] <= ANNEALED for one in chosen) if wheels else 0,
        "wheels": [_rounded(one) for one in chosen],
    }
    return {"key": record_key(kept), **kept}


def _largest_miss(wheel: Mapping[str, Any]) -> float:
    """Of the aims that are statements as they stand."""
    return float(max(miss for name, miss in wheel["misses"].items() if name not in (SPREAD, STRESS)))


def _varying_less_than_in_phase(study: Mapping[str, Any], wheels: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Those whose twin with all springs in phase varies more, with the twin's spread among their numbers."""
    studies = [study_point(RECORD, study, one["point"], one["values"]).study for one in wheels]
    with ProcessPoolExecutor() as pool:
        spreads = list(pool.map(_twin_spread, studies))
    told = [{**one, "numbers": one["numbers"] | {TWIN_SPREAD: s}} for one, s in zip(wheels, spreads, strict=True)]
    return [one for one in told if one["numbers"][TWIN_SPREAD] > one["numbers"][SPREAD]]


def _twin_spread(study: Study) -> float:
    """Largest less smallest load of the twin's orientations over their mean [-]; 0 where one does not come so far."""
    every = 2.0 * math.pi / 3.0 / TWIN_ORIENTATIONS
    around = tuple(every * i for i in range(TWIN_ORIENTATIONS))
    turned = study.model_copy(update={"fe": study.fe.model_copy(update={"orientations": around})})
    try:
        loads = [_load(task) for task in twin_tasks(turned)]
    except (InputError, ConvergenceError):
        return 0.0
    return (max(loads) - min(loads)) / (sum(loads) / len(loads))


def _load(task: Task) -> float:
    with TemporaryDirectory() as folder:
        solve_orientation(task.inputs, {}, Path(folder), lambda fraction: None)
        return float(read_curve(Path(folder) / CURVE).load_at(SPREAD_AT))


def keep(folder: Path, table: Path) -> None:
    """Write the record and the table."""
    record = kept_record(json.loads((folder / "confirmed.json").read_text(encoding="utf-8")))
    RECORD.write_text(for_json(json.dumps(record, allow_nan=False, ensure_ascii=False)) + "\n", encoding="utf-8")
    with (folder / "sweep.csv").open(encoding="utf-8", newline="") as stream:
        rows = [{k: _short(v) for k, v in row.items() if k not in _DROPPED} for row in csv.DictReader(stream)]
    with table.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _rounded(value: Any) -> Any:
    """Numbers with six digits, in any depth."""
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}")
    if isinstance(value, dict):
        return {key: one if key == "values" else _rounded(one) for key, one in value.items()}
    return [_rounded(one) for one in value] if isinstance(value, list) else value


def _short(cell: str) -> str:
    try:
        return f"{float(cell):.{_DIGITS}g}"
    except ValueError:
        return cell


if __name__ == "__main__":
    keep(Path(sys.argv[1]), Path(sys.argv[2]))
