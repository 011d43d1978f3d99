"""Statistics of samples: percentiles, and how the rank of an output goes with that of each input.

Verified by tests/unit/test_workbench_input_uncertainty.py against closed forms.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["FEWEST_RANKS", "LEVEL", "at_most_of_all", "percentiles", "rank_correlations", "told_apart"]

LEVEL = 0.05
"""Chance that an input without any effect is taken for one with an effect."""
FEWEST_RANKS = 4
"""Samples that a rank correlation needs."""

Array = NDArray[np.float64]


def percentiles(values: Array, of: tuple[float, ...] = (5.0, 50.0, 95.0)) -> Array:
    """Percentiles along the first axis, (len(of), ...): linear between the order statistics, type 7 of Hyndman and Fan.

    What is not a number is left out; not a number where nothing else is.
    """
    found = np.full((len(of), *values.shape[1:]), np.nan)
    some = np.isfinite(values).any(axis=0)
    if values.ndim == 1:
        return np.nanpercentile(values, of) if some else found
    found[:, some] = np.nanpercentile(values[:, some], of, axis=0)
    return found


def rank_correlations(inputs: Array, output: Array) -> Array:
    """Spearman's rank correlation of each input (n, k) with an output (n,), (k,) in [-1, 1].

    Samples without the output are left out; not a number where too few are left, or one of the two does not vary.
    """
    there = np.isfinite(output)
    if there.sum() < FEWEST_RANKS or np.ptp(output[there]) == 0.0:
        return np.full(inputs.shape[1], np.nan)
    return np.array([_spearman(column[there], output[there]) for column in inputs.T])


def _spearman(x: Array, y: Array) -> float:
    from scipy.stats import spearmanr  # a second of every command's start

    return math.nan if np.ptp(x) == 0.0 else float(spearmanr(x, y).statistic)


def told_apart(count: int, level: float = LEVEL) -> float:
    """Smallest magnitude of a rank correlation of ``count`` samples that differs from 0 at a level [-].

    By Student's t with n - 2 degrees of freedom, the usual approximation: r = t / sqrt(n - 2 + t^2).
    """
    from scipy.stats import t

    if count < FEWEST_RANKS:
        return math.nan
    quantile = float(t.ppf(1.0 - 0.5 * level, count - 2))
    return quantile / math.sqrt(count - 2 + quantile**2)


def at_most_of_all(found: int, count: int, level: float = LEVEL) -> float:
    """Share of all that are so at most, where ``found`` of ``count`` samples are, at a level [-] (Clopper, Pearson)."""
    from scipy.stats import beta

    return 1.0 if found >= count else float(beta.ppf(1.0 - level, found + 1, count - found))
