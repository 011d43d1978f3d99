"""Numbers typed as A:B:STEP, or one alone.

Verified by tests/end_to_end/test_drawbar.py and tests/end_to_end/test_climb.py.
"""

from __future__ import annotations

import math

import numpy as np

from contracts.errors import InputError

__all__ = ["steps_of"]


def steps_of(text: str, what: str, usual: str, most: int) -> tuple[float, ...]:
    """A, A + STEP and so on, B included where the step meets it; at most so many.

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
        return tuple(numbers)
    first, last, step = numbers
    if not (step > 0.0 and last >= first and (last - first) / step < most):
        raise InputError(what, repr(text), f"must rise by a step > 0, {most} at most", f"{usual} is usual")
    return tuple(np.arange(first, last + 0.5 * step, step).round(12).tolist())
