"""A Newton step that finds the touching set: the wheel is linearised once, its contact is not.

With the wheel's residual R and tangent K, gaps g + G s after a step s and penalties k, s solves

    R + K s + G^T k min(g + G s, 0) = 0,

the minimum of a function that is quadratic in pieces; friction that grows with the pressure puts other rows H in the
place of the G in front. Newton's method on it changes the set of touching points; every
set's matrix differs from the one that was factorised by one product a changed point, so that a solve costs as many
solves with the factors as there are new points (Woodbury's formula). An exact line search along each direction keeps
the sets from cycling. Verified by tests/unit/test_ancf_wheel_static.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

__all__ = ["settle"]

Array = NDArray[np.float64]
_LIMIT = 60
_MOST_CHANGED = 2000
"""Points that may change from the factored set: each costs a solve and a row of unknowns."""


def settle(
    solve: Callable[[Array], Array],
    tangent: Callable[[Array], Array],
    residual: Array,
    contact: tuple[Array, csr_array, Array],
    factored: NDArray[np.bool_],
    push: csr_array | None = None,
) -> tuple[Array, Array] | None:
    """Step (n,) and forces of the contact points (m,); None where more points change than one factorisation serves.

    Parameters
    ----------
    solve : inverse of K + H_A^T k G_A, A the points ``factored`` (m,), of vectors (n,) or columns (n, j)
    tangent : K times a vector
    residual : R (n,)
    contact : gaps (m,), slopes G (m, n), penalties (m,)
    push : what a unit of force does at each contact, H (m, n); G without friction
    """
    gap, G, k = contact
    H = G if push is None else push
    columns = _Columns(solve, H)
    base = solve(-residual - H.T @ np.where(factored, k * gap, 0.0))
    base_gap = gap + G @ base
    step = base
    at = base_gap
    for _ in range(_LIMIT):
        changed = np.flatnonzero((at < 0.0) != factored)
        if len(changed) > _MOST_CHANGED or not np.isfinite(at).all():
            return None
        goal = _with_changes(columns, (base, base_gap), (G, k), changed, factored)
        if not np.array_equal(goal, step):
            share = _search(residual + tangent(step), tangent, goal - step, (at, G, k, H))
            step = step + share * (goal - step)
        new = gap + G @ step
        settled = np.array_equal(new < 0.0, at < 0.0) and np.abs(new - at).max(initial=0.0) <= 1e-9 * np.abs(gap).max(
            initial=0.0
        )
        at = new
        if settled:
            break
    return step, -k * np.minimum(at, 0.0)


class _Columns:
    """K_A^-1 H^T by points, each found when it is first asked for."""

    def __init__(self, solve: Callable[[Array], Array], slopes: csr_array) -> None:
        self._solve, self._slopes = solve, slopes
        self._row = np.full(slopes.shape[0], -1)
        self._found = np.empty((0, slopes.shape[1]))

    def of(self, points: NDArray[np.int64]) -> Array:
        """Rows (len(points), n)."""
        new = points[self._row[points] < 0]
        if len(new):
            self._row[new] = len(self._found) + np.arange(len(new))
            right = np.asfortranarray(self._slopes[new].toarray().T)
            self._found = np.concatenate([self._found, self._solve(right).T])
        return np.asarray(self._found[self._row[points]])


def _with_changes(
    columns: _Columns,
    base: tuple[Array, Array],
    contact: tuple[csr_array, Array],
    changed: NDArray[np.int64],
    factored: NDArray[np.bool_],
) -> Array:
    """The step of a touching set that differs from the factored one by the points ``changed``."""
    step, gap = base
    if not len(changed):
        return step
    G, k = contact
    X = columns.of(changed)
    signed = np.where(factored[changed], -k[changed], k[changed])
    y = np.linalg.solve(np.diag(1.0 / signed) + G[changed] @ X.T, gap[changed])
    return np.asarray(step - y @ X)


def _search(
    body: Array, tangent: Callable[[Array], Array], direction: Array, contact: tuple[Array, csr_array, Array, csr_array]
) -> float:
    """Share of a direction, at most 1, at which the work of all forces along it is zero, as an energy's slope is."""
    at, G, k, H = contact
    first, curvature, rate = float(direction @ body), float(direction @ tangent(direction)), G @ direction
    pushed = H @ direction

    def slope(share: float) -> float:
        return first + share * curvature + float((k * np.minimum(at + share * rate, 0.0)) @ pushed)

    low, high = 0.0, 1.0
    if slope(low) >= 0.0 or slope(high) <= 0.0:
        return 1.0
    ends = slope(low), slope(high)
    for _ in range(60):
        middle = low - ends[0] * (high - low) / (ends[1] - ends[0])
        if _ % 3 == 2:
            middle = 0.5 * (low + high)
        value = slope(middle)
        if abs(value) <= 1e-12 * abs(first) or high - low < 1e-14:
            break
        low, high, ends = (middle, high, (value, ends[1])) if value < 0.0 else (low, middle, (ends[0], value))
    return middle
