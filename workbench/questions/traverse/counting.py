"""Cycles of a wheel's load, counted for fatigue: turning points, then rainflow (ASTM E1049-85, 5.4.4).

The count is that of the package ``rainflow``. Verified by tests/unit/test_workbench_traverse_counting.py.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import rainflow  # type: ignore[import-untyped]
from numpy.typing import NDArray

__all__ = ["counted", "turning_points"]


def turning_points(series: NDArray[np.float64], gate: float) -> list[float]:
    """Extremes of a series (n,) between which it moves by ``gate`` or more, with its first value and the last extreme.

    What is left out are cycles of a smaller range: rainflow counts the others alike.
    """
    values = series.tolist()
    points, extreme, rises = [values[0]], values[0], None
    for value in values[1:]:
        if rises is None:
            if abs(value - extreme) >= gate:
                extreme, rises = value, value > extreme
        elif value == extreme or (value > extreme) == rises:
            extreme = value
        elif abs(value - extreme) >= gate:
            points.append(extreme)
            extreme, rises = value, not rises
    return [*points, extreme] if rises is not None else points


def counted(points: Iterable[float], width: float) -> list[float]:
    """Cycles whose range lies in [k width, (k + 1) width), k = 0, 1, ...; half cycles count half."""
    found: list[float] = []
    for size, _, number, *_ in rainflow.extract_cycles(points):
        k = int(size / width * (1.0 + 1e-12))
        found += [0.0] * (k + 1 - len(found))
        found[k] += number
    return found
