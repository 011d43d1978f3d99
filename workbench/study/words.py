"""Texts of a study file in one line each, so that no output meets a text it cannot show.

Verified by tests/unit/test_text.py.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from contracts.errors import InputError
from contracts.text import one_line

__all__ = ["in_one_line"]

_PATHS = ("file", "surfaces")
"""Keys whose texts name files; they stay as they are."""


def in_one_line(content: Any) -> Any:
    """The content of a study file with every text and every name in one line, see `contracts.text.one_line`.

    Raises InputError for two names of one table that are then the same.
    """
    if isinstance(content, Mapping):
        if twice := [name for name, times in Counter(map(one_line, content)).items() if times > 1]:
            raise InputError(
                "name", repr(twice[0]), "stands for two names that differ in what is not shown", "rename one"
            )
        return {one_line(k): v if k in _PATHS and isinstance(v, str) else in_one_line(v) for k, v in content.items()}
    if isinstance(content, list):
        return [in_one_line(one) for one in content]
    return one_line(content) if isinstance(content, str) else content
