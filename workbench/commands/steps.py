"""Numbers typed as A:B:STEP, or one alone.

Verified by tests/unit/test_workbench_climb.py, tests/end_to_end/test_drawbar.py and test_climb.py.
"""

from __future__ import annotations

import math

import numpy as np

from contracts.errors import InputError

__all__ = ["steps_of"]

_DIGITS, _LEAST = 12, 1e-9
"""Numbers are rounded to so many digits, and rise by no smaller step."""


def steps_of(text: str, what: str, usual: str, most: int) -> tuple[float, ...]:
    """A, A + STEP and so on to B, which is included where the step meets it; at most so many, to 12 digits.

    Raises
    ------
    InputError
        For another form, and steps that do not rise.
    """
    parts = text.split(":")
    try:
        numbers = [float(one) for one in parts]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 3) or not all(math.isfinite(one) for one in numbers):
        raise InputError(what, repr(text), "must be A:B:STEP or a number", f"{usual} is usual")
    if len(numbers) == 1:
        return (round(numbers[0], _DIGITS),)
    first, last, step = numbers
    if not (step >= _LEAST and last >= first and (last - first) / step < most):
        raise InputError(what, repr(text), f"must rise by a step > 0, {most} at most", f"{usual} is usual")
    count = math.floor((last - first) / step + 1e-9) + 1
    return tuple((first + step * np.arange(count)).round(_DIGITS).tolist())
