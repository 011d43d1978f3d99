"""Curves of a folder in groups by model, for a list that is searched.

Verified by tests/unit/test_viewer_folder.py.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from workbench.viewer.folder import spoken

__all__ = ["OWN", "curve_choices"]

OWN = "your files"
"""Group of what a user adds."""
_ORDER = ("fe", "ancf", "brush", "section")
_OTHERS = "others"
_GROUP = 3
"""Curves that make a variant of a model, such as the ANCF wheel, a group of its own."""


def curve_choices(names: Iterable[str]) -> list[dict[str, str]]:
    """Value, text and group of each, groups together: a model's averages first, then by name.

    names : of files without their ending, such as ``fe_phi015``, ``ancf_wheel_average``
    """
    names = list(names)
    variants = Counter(_variant(name) for name in names)
    groups = {name: _group(name, variants) for name in names}
    return [
        {"value": name, "text": spoken(name), "group": groups[name]}
        for name in sorted(names, key=lambda name: (_place(name), groups[name], not name.endswith("_average"), name))
    ]


def _variant(name: str) -> str:
    return name.partition("_phi")[0].removesuffix("_average")


def _group(name: str, variants: Counter[str]) -> str:
    model, variant = name.split("_")[0], _variant(name)
    if model not in _ORDER:
        return _OTHERS
    return spoken(variant if variants[variant] >= _GROUP else model)


def _place(name: str) -> int:
    model = name.split("_")[0]
    return _ORDER.index(model) if model in _ORDER else len(_ORDER)
