"""``--obstacle`` of ``workbench stiffness``: the ground of a study, given beside it.

Verified by tests/unit/test_workbench_obstacle_option.py and tests/end_to_end/test_obstacle_option.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from contracts.errors import InputError
from workbench.study.obstacle_words import obstacle_table

__all__ = ["USED_BY", "chosen_obstacle", "on_obstacle"]

USED_BY = ("fe", "section", "ancf_wheel")
"""Models that stand on what [fe] says."""


def chosen_obstacle(word: str | None, **sizes: str | None) -> dict[str, str] | None:
    """[fe.obstacle] by the options, None without ``--obstacle``.

    Parameters
    ----------
    word, sizes : see `obstacle_table`; None where an option is not given

    Raises
    ------
    InputError
        As `obstacle_table`, and for sizes without ``--obstacle``.
    """
    given = {name: value for name, value in sizes.items() if value is not None}
    if word is not None:
        return obstacle_table(word, given)
    for name, value in given.items():
        raise InputError(name.replace("_", " "), repr(value), "is that of an obstacle", "give --obstacle")
    return None


def on_obstacle(study: Mapping[str, Any], obstacle: Mapping[str, str], model: str) -> dict[str, Any]:
    """A study file's table whose [fe] has this obstacle; InputError for a model that does not stand on it."""
    if model not in USED_BY:
        rule = f"does not stand on what --obstacle says; {', '.join(USED_BY)} do"
        raise InputError("model", model, rule, "leave out --obstacle")
    fe = study.get("fe")
    return dict(study) | ({"fe": dict(fe) | {"obstacle": dict(obstacle)}} if isinstance(fe, Mapping) else {})
