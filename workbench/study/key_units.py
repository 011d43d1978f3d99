"""What the study says of one of its keys: the SI unit of its number, and whether it is a whole number.

Verified by tests/unit/test_workbench_sweep_points.py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, TypeAliasType, get_args

from pydantic import BeforeValidator

from workbench.study.model import Study
from workbench.study.quantities import InUnit
from workbench.study.section import Section

__all__ = ["is_whole_number", "parts_of", "unit_of"]

_PART = re.compile(r"\[(\d+)\]|([^.\[\]]+)")


def parts_of(key: str) -> list[str | int]:
    """``"wheel.springs[0].count"`` -> ``["wheel", "springs", 0, "count"]``."""
    return [int(number) if number else name for number, name in _PART.findall(key)]


def unit_of(key: str) -> str | None:
    """SI unit of a key in pint's spelling, ``""`` for a plain number, None where the key holds no quantity."""
    found = [
        part.func.unit for part in _types(key) if isinstance(part, BeforeValidator) and isinstance(part.func, InUnit)
    ]
    return found[0] if found else None


def is_whole_number(key: str) -> bool:
    """Whether the key counts something."""
    return int in list(_types(key)) and unit_of(key) is None


def _types(key: str) -> list[Any]:
    """Types and validators of a key, outermost first; none for a key that the study does not have."""
    found: list[Any] = [Study]
    for part in parts_of(key):
        sections = [kind for kind in found if isinstance(kind, type) and issubclass(kind, Section)]
        fields = [kind.model_fields[part] for kind in sections if isinstance(part, str) and part in kind.model_fields]
        if fields:
            found = [kind for field in fields for kind in (*_nested(field.annotation), *field.metadata)]
        elif isinstance(part, str) and sections and dict not in found:
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
