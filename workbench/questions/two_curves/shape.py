"""Tangent stiffness along a curve and the work under it. Verified by tests/unit/test_workbench_curve_pair.py."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve

__all__ = ["tangent_stiffness", "work_between"]

_NEIGHBOURS = 5


def tangent_stiffness(curve: StiffnessCurve, deflection: NDArray[np.float64], half_width: float) -> NDArray[np.float64]:
    """dF/dd by local regression: at each place the slope of a weighted least-squares parabola.

    A parabola b0 + b1 (x - d) + b2 (x - d)^2 is fitted to the curve's own points with the tricube weights
    (1 - (abs(x - d) / h)^3)^3; h is ``half_width``, or more where that holds less than five points. The slope is b1.
    It is exact for parabolas on any grid, up to the ends; a kink is spread over 2 h. Cleveland, Robust locally weighted
    regression, J. Am. Stat. Assoc. 74 (1979) 829-836.

    Parameters
    ----------
    curve : two or more points; two give their slope everywhere
    deflection : (n,) float [m], where
    half_width : smallest reach of the weights [m]

    Returns
    -------
    tangent : (n,) float [N/m]

    Verified by tests/unit/test_workbench_curve_pair.py.
    """
    return np.array([_slope_at(curve, float(d), half_width) for d in deflection])


def _slope_at(curve: StiffnessCurve, d: float, half_width: float) -> float:
    distance = np.abs(curve.deflection - d)
    nearest = min(_NEIGHBOURS, len(distance)) - 1
    reach = max(half_width, 1.1 * float(np.partition(distance, nearest)[nearest]))
    near = distance < reach
    t = (curve.deflection[near] - d) / reach
    root = np.sqrt((1.0 - np.abs(t) ** 3) ** 3)
    powers = np.column_stack([root, root * t, root * t**2][: min(3, len(t))])
    coefficients = np.linalg.lstsq(powers, root * curve.load[near], rcond=None)[0]
    return float(coefficients[1] / reach)


def work_between(curve: StiffnessCurve, low: float, high: float) -> float:
    """Work [J] under a curve from where it first reaches the load ``low`` to where it first reaches ``high`` [N].

    Exact for the piecewise linear curve; from zero load it is the energy an elastic wheel stores up to ``high``. Raises
    InputError if the curve does not reach one of them.

    Verified by tests/unit/test_workbench_curve_pair.py.
    """
    start, end = curve.deflection_at(low), curve.deflection_at(high)
    inside = curve.deflection[(curve.deflection > start) & (curve.deflection < end)]
    places = np.concatenate([[start], inside, [end]])
    return float(np.trapezoid(curve.load_at(places), places))
