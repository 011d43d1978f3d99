"""What the study says of one of its keys: whether it is one, the SI unit of its number, whether it is a whole number.

Verified by tests/unit/test_workbench_sweep_points.py and tests/unit/test_workbench_chosen.py.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, TypeAliasType, get_args, get_origin

from pydantic import BeforeValidator

from contracts.ranges import dotted
from workbench.study.model import Study
from workbench.study.quantities import InUnit
from workbench.study.section import Section

__all__ = [
    "absent",
    "as_written",
    "is_key",
    "is_table",
    "is_whole_number",
    "nameless",
    "nearest_key",
    "parts_of",
    "unit_of",
    "words_of",
]

_WRITTEN = {"m": (1e3, "mm"), "rad": (180.0 / math.pi, "deg"), "Pa": (1e-6, "MPa")}
"""SI unit -> what a number is multiplied by, and the unit that it has then."""
_PART = re.compile(r'\[(\d{1,9})\]|"([^"]+)"|([^.\[\]]+)')


def parts_of(key: str) -> list[str | int]:
    """``"wheel.springs[0].count"`` -> ``["wheel", "springs", 0, "count"]``; quotes may hold a name, as in TOML."""
    return [int(number) if number else quoted or name for number, quoted, name in _PART.findall(key)]


def is_key(key: str) -> bool:
    """Whether a study may have the key."""
    return bool(_types(key))


def unit_of(key: str) -> str | None:
    """SI unit of a key in pint's spelling, ``""`` for a plain number, None where the key holds no quantity."""
    found = [
        part.func.unit for part in _types(key) if isinstance(part, BeforeValidator) and isinstance(part.func, InUnit)
    ]
    return found[0] if found else None


def is_whole_number(key: str) -> bool:
    """Whether the key counts something."""
    return int in list(_types(key)) and unit_of(key) is None


def is_table(key: str | Sequence[str | int]) -> bool:
    """Whether the key is that of a table, or of tables in a list."""
    return any(isinstance(kind, type) and issubclass(kind, Section) for kind in _types(key))


def nearest_key(key: Sequence[str | int]) -> str | None:
    """The key of the same section that is spelled most like this unknown one; None if none is."""
    sections = [kind for kind in _types(key[:-1]) if isinstance(kind, type) and issubclass(kind, Section)]
    names = [name for kind in sections for name in kind.model_fields]
    if key[-1] in names:  # of a table of another kind
        return None
    return next(iter(difflib.get_close_matches(str(key[-1]), names, n=1, cutoff=0.8)), None)


def as_written(key: str, value: float) -> str:
    """An SI number of a key with the unit that one writes it in."""
    unit = unit_of(key) or ""
    scale, shown = _WRITTEN.get(unit, (1.0, unit.replace("**", "^")))
    return f"{scale * value:g} {shown}".rstrip()


def absent(study: Study, key: Sequence[str | int]) -> str | None:
    """The shortest beginning of a key that the study does not have, e.g. a part of the wheel; None where it has it.

    ``*`` stands for any key of a table, and a list without a number for any of its tables. What may be left out and is
    has its key: the reason may be why.
    """
    found: list[Any] = [study]
    for end, part in enumerate(key, 1):
        found = [inner for one in found for inner in _inside(one, part)]
        if not found or (end < len(key) and all(one is None for one in found)):
            return dotted(tuple(key[:end]))
    return None


def _inside(value: Any, part: str | int) -> list[Any]:
    """What a table or a list has at one part of a key."""
    if isinstance(value, tuple):
        if isinstance(part, str):
            return [inner for one in value for inner in _inside(one, part)]
        return [value[part]] if part < len(value) else []
    table = value if isinstance(value, Mapping) else dict(value) if isinstance(value, Section) else {}
    return list(table.values()) if part == "*" else [table[part]] if part in table else []


def words_of(key: Sequence[str | int]) -> tuple[str, ...]:
    """The words that a key takes, of every kind of table that it may stand in."""
    return tuple(word for kind in _types(key) if get_origin(kind) is Literal for word in get_args(kind))


def nameless(study: Study) -> tuple[str, ...]:
    """Keys of [inferred] that name no key of the study, a line each; ``*`` stands for any key of a section."""
    told = []
    for key in study.inferred:
        named = next((("materials", name) for name in study.materials if key.startswith(f"materials.{name}.")), ())
        parts = [*named, *parts_of(key.removeprefix(".".join(named)))]  # a material may have a point in its name
        if not parts or not _types(parts):
            hint = "; correct its spelling, e.g. wheel.tire.thickness or wheel.*"
        elif missing := absent(study, parts):
            hint = f", which has no {missing}; remove it, or correct it"
        else:
            continue
        told.append(f"inferred.{key!r} names no key of the study{hint}")
    return tuple(told)


def _types(key: str | Sequence[str | int]) -> list[Any]:
    """Types and validators of a key, outermost first; none for a key that the study does not have."""
    found: list[Any] = [Study]
    for part in parts_of(key) if isinstance(key, str) else key:
        sections = [kind for kind in found if isinstance(kind, type) and issubclass(kind, Section)]
        fields = [field for kind in sections for name, field in kind.model_fields.items() if part in (name, "*")]
        if fields:
            found = [kind for field in fields for kind in (*_nested(field.annotation), *field.metadata)]
        elif isinstance(part, str) and dict not in found:
            return []
    return found


def _nested(annotation: Any) -> Iterator[Any]:
    """An annotation and everything inside it: members of unions, items of tuples, values of tables, validators."""
    if isinstance(annotation, TypeAliasType):
        annotation = annotation.__value__
    yield annotation
    if getattr(annotation, "__origin__", None) is dict:
        yield dict
    for part in get_args(annotation):
        yield from _nested(part)
