"""What is inferred or chosen, each number read from the one place that uses it, so that the page cannot go stale.

Verified by tests/unit/test_workbench_chosen.py.
"""

from __future__ import annotations

import importlib
import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from workbench.study.model import Study

__all__ = ["DATA", "Chosen", "ChosenGroup", "chosen_groups"]

DATA = Path(__file__).parents[1] / "data" / "chosen.toml"
_SCALES = {"mm": 1e3, "ms": 1e3, "mm/s": 1e3, "%": 100.0, "deg": 180.0 / math.pi, "N/mm": 1e-3}
"""Unit shown -> what an SI value is multiplied by; 1 for any other."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Chosen:
    """One number.

    Attributes
    ----------
    name : what it is
    value : text with unit
    kind : ``"inferred"`` from indirect evidence, or ``"chosen"``
    why, changes, source : why this one, what it changes, and where it comes from
    place : where it can be changed: key of the study or rover file, or constant
    """

    name: str
    value: str
    kind: str
    why: str
    changes: str
    source: str
    place: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ChosenGroup:
    """Numbers of one model."""

    title: str
    numbers: tuple[Chosen, ...]


def chosen_groups(study: Study, data: Path = DATA) -> tuple[ChosenGroup, ...]:
    """Every number that applies to a study, with the value this study has; groups without any are left out."""
    groups = []
    for row in tomllib.loads(data.read_text(encoding="utf-8"))["group"]:
        numbers = [one for one in row["number"] if _applies(study, row | one)]
        if numbers:
            groups.append(ChosenGroup(title=row["title"], numbers=tuple(_chosen(study, one) for one in numbers)))
    return tuple(groups)


def _applies(study: Study, row: Mapping[str, Any]) -> bool:
    asked = "section" not in row or getattr(study, row["section"]) is not None
    return asked and (study.of_the_thesis or not row.get("thesis_wheel", False))


def _chosen(study: Study, row: Mapping[str, Any]) -> Chosen:
    values, place = _looked_up(study, row)
    unit = row.get("unit", "")
    shown = ", ".join(_shown(value, unit) for value in values)
    texts = {name: row[name] for name in ("name", "kind", "why", "changes", "source")}
    return Chosen(value=f"{shown} {unit}".strip(), place=place, **texts)


def _looked_up(study: Study, row: Mapping[str, Any]) -> tuple[Sequence[Any], str]:
    """Values and where they stand; InputError for a row without exactly one place, or one that is not there."""
    (kind, *more) = [name for name in ("study", "rover", "code") if name in row] or [""]
    if not kind or more:
        raise InputError("number", row["name"], "must have one of study, rover, code", "see workbench/data/chosen.toml")
    paths = [row[kind]] if isinstance(row[kind], str) else list(row[kind])
    if kind == "code":
        return [_constant(path) for path in paths], f"{', '.join(paths)}"
    content = study.model_dump() if kind == "study" else _rover_file()
    return [_at(content, path) for path in paths], f"{kind} file: {', '.join(paths)}"


def _rover_file() -> dict[str, Any]:
    return tomllib.loads((files("rover_dynamics.rover") / "exomars_rover.toml").read_text(encoding="utf-8"))


def _at(content: Any, path: str) -> Any:
    """Follow a path; a table of an array is named by its ``name``."""
    for key in path.split("."):
        named = {row["name"]: row for row in content} if isinstance(content, list | tuple) else content
        if not isinstance(named, Mapping) or key not in named:
            raise InputError("number", path, f"is not there ({key})", "mend workbench/data/chosen.toml")
        content = named[key]
    return content


def _constant(path: str) -> Any:
    """``module:name`` or ``module:name.attribute``; of a class, the attribute an object has by default."""
    module, _, name = path.partition(":")
    found: Any = importlib.import_module(module)
    for part in name.split("."):
        found = getattr(found() if isinstance(found, type) else found, part)
    return found


def _shown(value: Any, unit: str) -> str:
    """Numbers in the unit shown, four digits; of several, one after the other."""
    if isinstance(value, Mapping):
        return " at ".join([f"{1e3 * value['low']:g} to {1e3 * value['high']:g}", f"{value['load']:g} N"])
    if isinstance(value, list | tuple):
        inner = [_shown(one, unit) for one in value]
        return f"({', '.join(inner)})" if any(isinstance(one, float) for one in value) else ", ".join(inner)
    if isinstance(value, bool | str) or value is None:
        return str(value).replace("_", " ")
    return f"{_SCALES.get(unit, 1.0) * value:.4g}"
