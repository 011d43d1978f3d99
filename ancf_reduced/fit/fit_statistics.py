"""How well data determine the unknowns of a least-squares fit: covariance, intervals, correlation, conditioning.

With the Jacobian J and the residual r at the optimum, s^2 = r.r / (n - m) and C = s^2 (J^T J)^-1. Bounds that hold an
unknown take it out: it has no interval, and the others' hold with it fixed. Differences that no parameter can remove
count as scatter in s^2, although they are not random: intervals say what the data leave open under that reading.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student_t

__all__ = ["INDISTINGUISHABLE", "FitStatistics", "fit_statistics"]

FloatArray = NDArray[np.float64]
INDISTINGUISHABLE = 0.95
"""Two parameters whose correlation exceeds this [-] cannot be told apart: their combination is known, they are not."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FitStatistics:
    """Statistics of m unknowns; NaN for those at a bound.

    Attributes
    ----------
    unknowns : (m,) float, at the optimum
    inside : (m,) bool, False for an unknown that a bound holds
    standard_error : (m,) float, in the unknowns
    half_width : (m,) float, of the 95 % interval (Student's t with n - m degrees of freedom)
    correlation : (m, m) float [-], of the errors
    condition : largest over smallest singular value of J with columns of unit length [-]; above 30 the data hardly
        tell some combination of parameters (Belsley, Kuh and Welsch 1980)
    weakest : (m,) float [-], right singular vector of the smallest one: the combination known least
    residual_scale : s [-]
    degrees_of_freedom : n - m

    Verified by tests/unit/test_ancf_fit_statistics.py.
    """

    unknowns: FloatArray
    inside: NDArray[np.bool_]
    standard_error: FloatArray
    half_width: FloatArray
    correlation: FloatArray
    condition: float
    weakest: FloatArray
    residual_scale: float
    degrees_of_freedom: int

    def indistinguishable(self) -> list[tuple[int, int]]:
        """Pairs of unknowns with a correlation beyond `INDISTINGUISHABLE`."""
        strong = np.argwhere(np.triu(np.abs(np.nan_to_num(self.correlation)) > INDISTINGUISHABLE, k=1))
        return [(int(i), int(j)) for i, j in strong]


def fit_statistics(
    jacobian: FloatArray, residual: FloatArray, unknowns: FloatArray, inside: NDArray[np.bool_]
) -> FitStatistics:
    """Statistics from the Jacobian (n, m) and the residual (n,) at the optimum; a column of zeros has no interval.

    Verified by tests/unit/test_ancf_fit_statistics.py (a straight line, against its closed form).
    """
    n, m = jacobian.shape
    inside = inside & (np.linalg.norm(jacobian, axis=0) > 0.0)
    freedom = n - int(inside.sum())
    scale = float(np.sqrt(residual @ residual / freedom))
    error, half, weakest = np.full(m, np.nan), np.full(m, np.nan), np.full(m, np.nan)
    correlation, condition = np.full((m, m), np.nan), np.nan
    if inside.any():
        length = np.linalg.norm(jacobian[:, inside], axis=0)
        _, singular, rows = np.linalg.svd(jacobian[:, inside] / length, full_matrices=False)
        with np.errstate(divide="ignore"):
            condition = float(np.divide(singular[0], singular[-1]))
        inverse = (rows.T / np.maximum(singular, np.finfo(float).tiny ** 0.25) ** 2) @ rows
        spread = np.sqrt(np.diag(inverse))
        error[inside] = scale * spread / length
        half[inside] = student_t.ppf(0.975, freedom) * error[inside]
        correlation[np.ix_(inside, inside)] = inverse / np.outer(spread, spread)
        weakest[inside] = rows[-1]
    return FitStatistics(
        unknowns=unknowns,
        inside=inside,
        standard_error=error,
        half_width=half,
        correlation=correlation,
        condition=condition,
        weakest=weakest,
        residual_scale=scale,
        degrees_of_freedom=freedom,
    )
