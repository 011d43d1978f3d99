"""A path of the hub as a user writes it: ``"radial 10 mm, lateral 5 mm + leaning 1 deg, lateral 0 mm"``.

Verified by tests/unit/test_workbench_hub_path.py.
"""

from __future__ import annotations

import math

from pydantic_core import PydanticCustomError

from contracts.errors import InputError
from contracts.hub_travel import HubTravel, Way
from workbench.study.quantities import to_si

__all__ = ["LONGEST_STEP", "hub_path"]

type Places = tuple[dict[Way, float], ...]
LONGEST_STEP = 1e-3
"""Of the hub along a path, or of what a turn moves at 50 mm [m]: friction depends on the steps."""
_MOST_STEPS = 500
_MOST = {False: 0.5, True: 0.5 * math.pi}
"""Farthest place, whether it turns [m; rad]."""
_EXAMPLE = "'radial 10 mm, lateral 5 mm, radial 8 mm, lateral 0 mm'"


def hub_path(text: str, deepest: float) -> Places:
    """Places in turn, each the ways that change and to where, absolute, from first touch [m; rad].

    deepest : largest deflection [m]

    Raises
    ------
    InputError
        For what is no path, a wheel that is not pressed first or not all the way, and a path of too many steps.
    """
    found = tuple(_place(part, deepest) for part in text.split(","))
    if found[0].keys() != {Way.RADIAL} or len(found) < 2:
        rule = "must begin with the radial way alone, and go on"
        raise InputError("path", repr(text.strip()), rule, f"press the wheel first, as {_EXAMPLE}")
    steps = len(HubTravel.through(found, LONGEST_STEP).controls)
    if steps > _MOST_STEPS:
        rule = f"takes {steps} steps of {1e3 * LONGEST_STEP:g} mm, more than {_MOST_STEPS}"
        raise InputError("path", repr(text.strip()), rule, "give shorter legs")
    return found


def _place(part: str, deepest: float) -> dict[Way, float]:
    """One place, the ways in it joined by ``+``."""
    place = dict[Way, float]()
    for one in part.split("+"):
        name, _, length = one.strip().partition(" ")
        if name not in tuple(Way):
            raise InputError("path", repr(part.strip()), "names no way", f"give {', '.join(Way)}, as {_EXAMPLE}")
        way = Way(name)
        if way in place:
            raise InputError("path", repr(part.strip()), f"names {way} twice", "leave one of them out")
        place[way] = _length(way, length.strip(), deepest)
    return place


def _length(way: Way, text: str, deepest: float) -> float:
    """The number of a way [m; rad]."""
    try:
        value = to_si(text, "rad" if way.turns else "m")
    except PydanticCustomError as error:
        context = error.context or {}
        raise InputError(f"path: {way}", repr(text), str(context["rule"]), str(context["hint"])) from error
    if way is Way.RADIAL and not 0.0 < value <= deepest:
        rule = f"must lie above zero and within fe.max_deflection, {1e3 * deepest:g} mm"
        raise InputError("path: radial", repr(text), rule, "the wheel stays pressed all the way")
    if abs(value) > _MOST[way.turns]:
        most = "90 deg" if way.turns else "500 mm"
        raise InputError(f"path: {way}", repr(text), f"must not exceed {most}", "check its unit")
    return value
