"""One proposal a batch from what is known: the linear programme of the points around the best one.

Structural optimisation's sequential linear programming: objective and logarithms of the limited numbers are fitted
linearly over the nearest points (masses go with thickness, stiffness with a power of it), and the programme is solved
within move limits, a box about the best point. Missed limits have the weight of the search's cost.
Verified by tests/unit/test_workbench_trade_offs.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from workbench.questions.optimise.judging import WEIGHT, Assessed, Limit, best, nearest
from workbench.study.optimise import Wish

__all__ = ["proposal"]

_WITHIN = 5e-4
"""How far inside its limits the programme stays [-], so that what a fit leaves out seldom breaks them."""


def proposal(
    points: Sequence[Assessed],
    places: Mapping[int, NDArray[np.float64]],
    limits: Sequence[Limit],
    wish: Wish,
    scale: float,
    reach: float,
) -> NDArray[np.float64] | None:
    """Where the linear programme says the best point lies, (d,) in [0, 1); None before there are points enough.

    Parameters
    ----------
    points : what is known, against the limits
    places : of each point by its number, (d,) in [0, 1)
    limits, wish : of the search
    scale : a usual size of the objective
    reach : half the box's side, as a part of the ranges
    """
    known = [point for point in points if point.number in places and _complete(point, limits)]
    if not known:
        return None
    centre = places[(best(known, wish) or nearest(known)).number]
    at = np.array([places[point.number] for point in known])
    wanted = 2 * at.shape[1] + 2
    if len(known) < wanted:
        return None
    near = np.argsort(np.abs(at - centre).max(axis=1), kind="stable")[:wanted]
    offsets = at[near] - centre
    rows = [[wish.sign * (known[i].objective or 0.0) / scale, *(_log(known[i], one) for one in limits)] for i in near]
    design = np.column_stack([np.ones(len(offsets)), offsets])
    fitted, *_ = np.linalg.lstsq(design, np.array(rows), rcond=1e-9)
    return _solved(fitted, limits, np.maximum(centre - reach, 0.0), np.minimum(centre + reach, 1.0), centre)


def _complete(point: Assessed, limits: Sequence[Limit]) -> bool:
    values = [point.objective, *(point.numbers.get(limit.column) for limit in limits)]
    return all(isinstance(value, float) and value > 0.0 for value in values)


def _log(point: Assessed, limit: Limit) -> float:
    value = point.numbers[limit.column]
    assert isinstance(value, float)
    return math.log(value)


def _solved(
    fitted: NDArray[np.float64],
    limits: Sequence[Limit],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    centre: NDArray[np.float64],
) -> NDArray[np.float64] | None:
    """Least objective with a slack for each limit; ``fitted`` (1 + d, 1 + limits): values and slopes at ``centre``."""
    from scipy.optimize import linprog  # a second of every command's start

    above, most, count = list[NDArray[np.float64]](), list[float](), len(limits)
    for j, limit in enumerate(limits):
        value, slopes = fitted[0, 1 + j], fitted[1:, 1 + j]
        slack = -np.eye(count)[j]
        if limit.high is not None:
            above.append(np.append(slopes, slack))
            most.append(math.log(limit.high * (1.0 - _WITHIN)) - value)
        if limit.low is not None:
            above.append(np.append(-slopes, slack))
            most.append(value - math.log(limit.low * (1.0 + _WITHIN)))
    cost = np.append(fitted[1:, 0], np.full(count, WEIGHT))
    bounds = [*zip(low - centre, high - centre, strict=True), *[(0.0, None)] * count]
    found = linprog(cost, A_ub=np.array(above), b_ub=np.array(most), bounds=bounds).x
    return None if found is None else np.clip(centre + found[: len(centre)], 0.0, np.nextafter(1.0, 0.0))
