"""Structural damage of a TOML document: types swapped, keys renamed, lost, doubled, numbers scaled. Repeatable by seed.

The document is changed as a tree and written anew, so that every case is sound TOML: what is tried is what the reader
makes of the content, not of the syntax (tests/mutations.py does that).
"""

from __future__ import annotations

import copy
import json
import math
import random
import re
from collections.abc import Iterator
from typing import Any

__all__ = ["Damage", "damaged", "paths_of", "scaled", "toml_text"]

type Path = tuple[str | int, ...]
type Damage = tuple[str, Path, object]
"""Kind of the change, where, and the value it left."""

_QUANTITY = re.compile(r"([+-]?\d[\d.eE+-]*)(\s*[^\d\s.].{0,14})?")
_OTHERS = (
    *(True, False, 0, 1, -1, 3, 10**6, 2**63 - 1, 0.0, -0.0, 0.5, 1e308, -1e308, 5e-324, math.nan, math.inf, -math.inf),
    *("", "x", "0", "1 m", "-3 mm", "nan mm", "inf deg", "1e400 mm", "15 deg", "30 %", "3 count", "3 ppm", "1 GPa"),
    *("mm", "é½٣", "\x00\x1b[31m", "a\nb", "\ufeff1 mm", "../../x", "x" * 20000, "[/red]", "1 mm" * 2000),
    *([], {}, [[]], [{}], [1, "a"], {"a": {"b": {"c": [1]}}}, ["1 mm"] * 3, ["1 mm", "2 mm"], [0.0] * 300),
)
_UNITS = ("mm", "m", "km", "kg", "N", "Pa", "GPa", "deg", "rad", "s", "K", "degC", "N/m", "%", "count", "ppm", "in", "")
_KEYS = ("", "x", "a.b", "name", "thickness", "Width", "ß", "\x07", "k" * 3000, "__class__", "density")


def toml_text(table: dict[str, Any]) -> str:
    """The document, every table written inline."""
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in table.items())


def _key(key: str) -> str:
    return json.dumps(key).replace("\x7f", "\\u007f")


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_value(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return _key(value) if isinstance(value, str) else repr(value)


def paths_of(value: object, path: Path = ()) -> Iterator[Path]:
    """Paths of everything inside, tables and lists included."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for part, content in inner:
        yield (*path, part)
        yield from paths_of(content, (*path, part))


def scaled(value: object, factor: float) -> object:
    """A number, or a string of a number and its unit, times ``factor``; None for anything else and for zero."""
    if isinstance(value, bool):
        return None
    if isinstance(value, int | float):
        return value * factor if value else None
    found = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if found is None or not float(found[1]):
        return None
    return f"{float(found[1]) * factor!r}{found[2] or ''}"


def damaged(source: random.Random, table: dict[str, Any]) -> tuple[dict[str, Any], Damage]:
    """The document with one structural change, and which."""
    table = copy.deepcopy(table)
    while True:
        path = source.choice(list(paths_of(table)))
        kind = source.choice(("scale", "scale", "swap", "rename", "delete", "double", "unit", "move", "nest"))
        at: Any = table
        for part in path[:-1]:
            at = at[part]
        last, value = path[-1], at[path[-1]]
        change = _changed(source, kind, value, table)
        if kind in ("rename", "delete", "double"):
            left = _restructured(source, kind, at, last)
            return table, (kind, path, left)
        if change is not None:
            at[last] = change
            return table, (kind, path, change)


def _changed(source: random.Random, kind: str, value: object, table: dict[str, Any]) -> object:
    if kind == "scale":
        return scaled(value, source.choice((1e12, 1e-12)))
    if kind == "swap":
        return copy.deepcopy(source.choice(_OTHERS))
    if kind == "unit" and isinstance(value, str) and (found := _QUANTITY.fullmatch(value)):
        return f"{found[1]} {source.choice(_UNITS)}"
    if kind == "move":
        other: Any = table
        for part in source.choice(list(paths_of(table))):
            other = other[part]
        return copy.deepcopy(other)
    if kind == "nest":
        return source.choice(([value], {"value": value}, [[value]], [value] * 200))
    return None


def _restructured(source: random.Random, kind: str, at: Any, last: str | int) -> object:
    if kind == "delete":
        return at.pop(last)
    if isinstance(at, list):
        at.insert(source.randint(0, len(at)), copy.deepcopy(at[int(last)]))
        return "one more"
    name = source.choice((*_KEYS, f"{last}s", str(last)[:-1], f" {last}", str(last).upper()))
    at[name] = copy.deepcopy(at[last]) if kind == "double" else at.pop(last)
    return name
