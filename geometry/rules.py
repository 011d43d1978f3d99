"""Rules for single values: one function per kind of rule, each raising InputError with value, unit, hint and key.

Verified by tests/unit/test_geometry_validation.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from contracts.errors import InputError

__all__ = ["require_bands", "require_count", "require_name", "require_positive_length"]


def require_positive_length(what: str, value: float, key: str = "") -> None:
    """Raise InputError unless the length ``value`` [m] is finite and greater than zero."""
    if not (math.isfinite(value) and value > 0.0):
        rule = "must be finite and greater than zero"
        raise InputError(what, f"{value * 1e3:g} mm", rule, "give a length such as 2 mm", key=key)


def require_count(what: str, value: int, least: int = 1, key: str = "") -> None:
    """Raise InputError unless ``value`` is a whole number of at least ``least``."""
    if not isinstance(value, int) or isinstance(value, bool) or value < least:
        hint = f"give {least} or more, or leave the part out"
        raise InputError(what, value, f"must be a whole number >= {least}", hint, key=key)


def require_name(what: str, value: str, key: str = "") -> None:
    """Raise InputError unless ``value`` can name a part: letters, digits and underscores, a letter first."""
    if not (value.isidentifier() and value.isascii()):
        rule = "must be letters, digits and underscores"
        raise InputError(what, repr(value), rule, "give a name such as springs_outer", key=key)


def require_bands(what: str, bands: Sequence[tuple[float, float]], key: str = "") -> None:
    """Raise InputError unless the axial bands ``((y0, y1), ...)`` [m] are finite, rising and apart from each other."""
    if not bands:
        raise InputError(
            what, "no band", "needs at least one axial band", 'give one, in a study [["-20 mm", "20 mm"]]', key=key
        )
    for y0, y1 in bands:
        text = f"{y0 * 1e3:g}..{y1 * 1e3:g} mm"
        if not (math.isfinite(y0) and math.isfinite(y1)):
            raise InputError(what, text, "must have finite ends", "check their unit", key=key)
        if y1 <= y0:
            raise InputError(what, text, "must end after it begins", "give the smaller y first", key=key)
    ordered = sorted(bands)
    for (first, end), (start, last) in pairwise(ordered):
        if start < end:
            text = f"{first * 1e3:g}..{end * 1e3:g} and {start * 1e3:g}..{last * 1e3:g} mm"
            raise InputError(f"{what}s", text, "must not overlap", "shorten or join the bands", key=key)
