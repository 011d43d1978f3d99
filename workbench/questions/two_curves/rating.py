"""ISO/TS 18571 rating of two curves, for those who ask for it. Verified by tests/unit/test_workbench_rating.py."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["iso_18571_rating"]


def iso_18571_rating(signal: NDArray[np.float64], reference: NDArray[np.float64]) -> float:
    """ISO/TS 18571 overall rating of two equally sampled signals, 1 is best [-].

    The standard is written for time signals; deflection takes the place of time, which changes no part of the
    rating, because each part is relative. It can rank the worse of two models higher, so that no check rests on it. The
    library takes seconds to import: nothing else may import this.

    Parameters
    ----------
    signal, reference : (n,) float each, same unit

    Returns
    -------
    rating : NaN where it is not defined: its parts divide by the variation of both signals, so that a constant one
        has no rating
    """
    if any(float(np.ptp(values)) <= 1e-9 * float(np.abs(values).max()) for values in (signal, reference)):
        return math.nan
    import numba

    jit_was_off = numba.config.DISABLE_JIT  # type: ignore[attr-defined]
    numba.config.DISABLE_JIT = True  # type: ignore[attr-defined]  # compiling its loop takes longer than running it
    try:
        from objective_rating_metrics.rating import ISO18571  # type: ignore[import-untyped]
    finally:
        numba.config.DISABLE_JIT = jit_was_off  # type: ignore[attr-defined]
    axis = np.arange(len(signal)) * 1e-4
    pair = (np.column_stack([axis, values]) for values in (reference, signal))
    with np.errstate(all="ignore"):
        rating = float(ISO18571(*pair, dt=1e-4).overall_rating(ndigits=-1))
    return rating if math.isfinite(rating) else math.nan
