"""What a named command found for a study: kept beside the study's file, told apart once it no longer holds.

``studies/exomars.toml`` has its records in ``studies/exomars.kept/NAME.json``. Each holds the key of the tasks it is
about: of what they are given, and of the sources they can reach. Verified by tests/unit/test_workbench_kept.py.
"""

from __future__ import annotations

import datetime
import json
import math
import os
import platform
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Literal

from contracts.errors import InputError
from contracts.input_file import input_bytes
from contracts.text import for_json
from workbench.execution.fingerprint import canonical_json, text_sha256
from workbench.execution.task import Task, task_keys
from workbench.study.model import Study

__all__ = [
    "OF_ANOTHER",
    "Kept",
    "State",
    "keep",
    "kept",
    "keys_of",
    "replaced",
    "require_numbers",
    "require_place",
    "rounded",
]

OF_ANOTHER = "the kept record is of another study"
"""Why nothing follows from the numbers of a stale record."""
State = Literal["current", "older sources", "stale"]
_DIGITS, _WORDS, _MOST, _LONGEST, _HUGE = 16, 200, 50_000_000, 1e10, 1e300


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """One record.

    Attributes
    ----------
    command : what makes it anew, as a user types it
    inputs, sources : keys of what its tasks were given, and of that with the sources and libraries they reach
    date, machine, wall_s : when, where and how long it ran [s]
    found : the results, JSON values [SI]
    """

    command: str
    inputs: str
    sources: str
    date: str
    machine: str
    wall_s: float
    found: Mapping[str, Any]

    def state(self, tasks: Sequence[Task]) -> State:
        """Whether it is about these tasks: as they are; as they were given, by older sources; or about others."""
        inputs, sources = keys_of(tasks)
        if self.inputs != inputs:
            return "stale"
        return "current" if self.sources == sources else "older sources"

    def state_of(self, plan: Callable[[], Sequence[Task]]) -> State:
        """The same of tasks that a changed study may not have any more: stale where they cannot be planned."""
        try:
            tasks = plan()
        except InputError:
            return "stale"
        return self.state(tasks)


def keys_of(tasks: Sequence[Task]) -> tuple[str, str]:
    """Key of the functions and inputs of tasks, in any order, and key of these with all sources and libraries."""
    given = sorted(canonical_json({"function": task.function, "inputs": task.inputs}) for task in tasks)
    sources = sorted(task_keys(tuple(tasks)).values())
    return text_sha256("\n".join(given))[:_DIGITS], text_sha256("\n".join(sources))[:_DIGITS]


def kept(study: Study, name: str, understand: Callable[[Mapping[str, Any]], object] = len) -> Kept | None:
    """The record of this name; None where there is none. ``understand`` reads its ``found`` and raises what it likes.

    Raises
    ------
    InputError
        For a file that is no such record, and for a folder or link in its place.
    """
    if study.kept is None:
        return None
    path = study.kept / f"{name}.json"
    for place, wanted in ((study.kept, Path.is_dir), (path, Path.is_file)):
        if os.path.lexists(place) and not wanted(place):
            raise InputError("kept record", place, "is not what it should be", "move it away")
    if not path.exists():
        return None
    try:
        content = input_bytes(path, "kept record", _MOST)
        record = _record(json.loads(content, parse_float=_finite, parse_constant=_finite))
        understand(record.found)
    except (OSError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError, RecursionError) as error:
        rule = f"cannot be read ({type(error).__name__}: {str(error)[:_WORDS]})"
        raise InputError("kept record", str(path), rule, "move it away, and make it anew") from error
    return record


def require_numbers(values: Iterable[object]) -> None:
    """Raise ValueError for a value of a record that is no number in ±1e300: JSON has texts, truths and longer ones."""
    for value in values:
        if isinstance(value, bool) or not isinstance(value, int | float) or not -_HUGE < value < _HUGE:
            raise ValueError(f"{str(value)[:_WORDS]!r} is no number that can be")


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is no finite number")
    return number


def _record(content: Any) -> Kept:
    names = [one.name for one in fields(Kept)]
    if not isinstance(content, dict) or set(content) != set(names):
        raise ValueError(f"a record holds {', '.join(names)}, and nothing else")
    record = Kept(**content)
    words = record.command, record.inputs, record.sources, record.date, record.machine
    if not (
        all(isinstance(w, str) for w in words) and isinstance(record.found, dict) and 0.0 <= record.wall_s < _LONGEST
    ):
        raise ValueError("command, inputs, sources, date and machine are texts, found a table, wall_s seconds")
    return record


def require_place(study: Study, name: str) -> Path:
    """Make sure before any computing that a record can be kept, where there is none or over one; gives its path.

    Raises
    ------
    InputError
        For a study that was read from no file, a folder that cannot be written, and a file that is no record: it may
        be somebody's.
    """
    if study.kept is None:
        raise InputError("study", study.name, "was read from no file", "read it with read_study")
    kept(study, name)
    folder = study.kept if study.kept.exists() else study.kept.absolute().parent
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError("folder of kept records", folder, "cannot be written", "copy the study into one of yours")
    return study.kept / f"{name}.json"


def rounded(value: Any) -> Any:
    """JSON values with floats to six digits, in any depth."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {name: rounded(one) for name, one in value.items()}
    return [rounded(one) for one in value] if isinstance(value, list) else value


def replaced(study: Study, name: str, command: str, tasks: Sequence[Task]) -> list[str]:
    """What is to be said before a record of another command and of other tasks is replaced: nothing or a sentence."""
    old = kept(study, name)
    if old is None or old.command == command or old.state(tasks) != "stale":
        return []
    where = f"{study.kept}/{name}.json"
    return [f"this will replace the kept record of `{old.command}`, {where}; to keep that, run on a copy of the study"]


def keep(study: Study, name: str, command: str, tasks: Sequence[Task], wall_s: float, found: Mapping[str, Any]) -> Path:
    """Write a record beside the study's file, whole or not at all; gives its path. Raises what `require_place` does."""
    path = require_place(study, name)
    inputs, sources = keys_of(tasks)
    record = {
        "command": command,
        "inputs": inputs,
        "sources": sources,
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="minutes"),
        "machine": f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}",
        "wall_s": round(wall_s, 1),
        "found": dict(found),
    }
    text = json.dumps(record, allow_nan=False, ensure_ascii=False, indent=1)
    path.parent.mkdir(exist_ok=True)
    fresh = path.with_name(f".{name}-{os.getpid()}.json")
    try:
        fresh.write_text(for_json(text) + "\n", encoding="utf-8")
        fresh.replace(path.resolve())
    finally:
        fresh.unlink(missing_ok=True)
    return path
