"""Shortest processor times of calls, the rows they go into, and the rate of multiply-adds of this core."""

from __future__ import annotations

import time
from collections.abc import Callable

import numba
import numpy as np
from numpy.typing import NDArray

__all__ = ["multiply_add_rate", "row", "shortest"]


def row(case: str, metric: str, unit: str, ours: float) -> dict[str, object]:
    """One line of the table; there is no peer."""
    return {"case": case, "metric": metric, "unit": unit, "ours": ours, "peer": None, "ratio": None}


def shortest(call: Callable[[], object], budget_s: float = 2.0) -> float:
    """Shortest processor time of a call in bursts of two milliseconds or more [us]."""
    call()
    burst = 1
    while (spent := _processor_seconds(call, burst)) < 2e-3:
        burst *= 2
    best, end = spent / burst, time.perf_counter() + budget_s
    while time.perf_counter() < end:
        best = min(best, _processor_seconds(call, burst) / burst)
    return 1e6 * best


def _processor_seconds(call: Callable[[], object], burst: int) -> float:
    begun = time.process_time()
    for _ in range(burst):
        call()
    return time.process_time() - begun


@numba.njit(fastmath=True)
def _multiply_add(a: NDArray[np.float64], rounds: int) -> float:
    """Eight chains of eight lanes each, in registers: 2 * 64 * rounds operations."""
    x = a.copy()
    for _ in range(rounds):
        for k in range(64):
            x[k] = x[k] * 0.999999 + 1e-7
    return float(x.sum())


def multiply_add_rate() -> float:
    """Floating point operations a second of one core that does nothing but multiply and add."""
    a, rounds = np.ones(64), 20000
    return 2.0 * 64.0 * rounds / (1e-6 * shortest(lambda: _multiply_add(a, rounds)))
