"""Shape functions of the fully parametrised ANCF plate (thesis eq. 2.13) and their derivatives.

A plate has the material coordinates 0 <= x1 <= a, 0 <= x2 <= b, -t/2 <= x3 <= t/2; xi = x1/a, eta = x2/b, zeta = x3/t.
Nodes in the order (0, 0), (a, 0), (a, b), (0, b); at each node the coordinates r, r_x1, r_x2, r_x3 (thesis eq. 2.15).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["THESIS_SHAPE", "PlateShape", "gauss_points", "plate_shape", "plate_shape_gradient"]

FloatArray = NDArray[np.float64]


def plate_shape(xi: FloatArray, dimensions: FloatArray) -> FloatArray:
    """Sixteen shape functions s_1..s_16 of thesis eq. 2.13, as printed: r = sum_i s_i e_i (thesis eqs. 2.11, 2.12).

    Parameters
    ----------
    xi : (..., 3) float [-], (xi, eta, zeta); zeta = -1/2 and +1/2 are the faces
    dimensions : (3,) float [m], length a, width b, thickness t

    Returns
    -------
    shape : (..., 16) float, [-] for positions and [m] for gradients

    Verified by tests/unit/test_ancf_shape_functions.py, tests/verification/test_ancf_plate_reference.py.
    """
    a, b, t = dimensions
    u, v, z = np.moveaxis(np.asarray(xi, dtype=np.float64), -1, 0)
    return np.stack(
        [
            -(u - 1) * (v - 1) * (2 * v**2 - v + 2 * u**2 - u - 1),
            -a * u * (u - 1) ** 2 * (v - 1),
            -b * v * (v - 1) ** 2 * (u - 1),
            t * z * (u - 1) * (v - 1),
            u * (2 * v**2 - v - 3 * u + 2 * u**2) * (v - 1),
            -a * u**2 * (u - 1) * (v - 1),
            b * u * v * (v - 1) ** 2,
            -t * u * z * (v - 1),
            -u * v * (1 - 3 * u - 3 * v + 2 * v**2 + 2 * u**2),
            a * u**2 * v * (u - 1),
            b * u * v**2 * (v - 1),
            t * u * v * z,
            v * (u - 1) * (2 * u**2 - u - 3 * v + 2 * v**2),
            a * u * v * (u - 1) ** 2,
            -b * v**2 * (u - 1) * (v - 1),
            -t * v * z * (u - 1),
        ],
        axis=-1,
    )


def plate_shape_gradient(xi: FloatArray, dimensions: FloatArray) -> FloatArray:
    """Derivatives of thesis eq. 2.13 with respect to the material coordinates x1, x2, x3.

    Parameters
    ----------
    xi : (..., 3) float [-], (xi, eta, zeta)
    dimensions : (3,) float [m], length a, width b, thickness t

    Returns
    -------
    gradient : (..., 3, 16) float, [1/m] for positions and [-] for gradients; row k holds d s / d x_{k+1}

    Verified by tests/unit/test_ancf_shape_functions.py (finite differences).
    """
    a, b, t = dimensions
    u, v, z = np.moveaxis(np.asarray(xi, dtype=np.float64), -1, 0)
    by_x1 = np.stack(_d_xi(u, v, z, a, b, t), axis=-1) / a
    by_x2 = np.stack(_d_eta(u, v, z, a, b, t), axis=-1) / b
    none = np.zeros_like(u)
    corner = [t * (u - 1) * (v - 1), -t * u * (v - 1), t * u * v, -t * v * (u - 1)]
    by_x3 = np.stack([part for c in corner for part in (none, none, none, c)], axis=-1) / t
    return np.stack([by_x1, by_x2, by_x3], axis=-2)


def _d_xi(u: FloatArray, v: FloatArray, z: FloatArray, a: float, b: float, t: float) -> list[FloatArray]:
    """Derivatives of s_1..s_16 with respect to xi."""
    return [
        -(v - 1) * (2 * v**2 - v + 2 * u**2 - u - 1 + (u - 1) * (4 * u - 1)),
        -a * (v - 1) * (u - 1) * (3 * u - 1),
        -b * v * (v - 1) ** 2,
        t * z * (v - 1),
        (v - 1) * (2 * v**2 - v - 3 * u + 2 * u**2 + u * (4 * u - 3)),
        -a * (v - 1) * u * (3 * u - 2),
        b * v * (v - 1) ** 2,
        -t * z * (v - 1),
        -v * (1 - 3 * u - 3 * v + 2 * v**2 + 2 * u**2 + u * (4 * u - 3)),
        a * v * u * (3 * u - 2),
        b * v**2 * (v - 1),
        t * v * z,
        v * (2 * u**2 - u - 3 * v + 2 * v**2 + (u - 1) * (4 * u - 1)),
        a * v * (u - 1) * (3 * u - 1),
        -b * v**2 * (v - 1),
        -t * v * z,
    ]


def _d_eta(u: FloatArray, v: FloatArray, z: FloatArray, a: float, b: float, t: float) -> list[FloatArray]:
    """Derivatives of s_1..s_16 with respect to eta."""
    return [
        -(u - 1) * (2 * v**2 - v + 2 * u**2 - u - 1 + (v - 1) * (4 * v - 1)),
        -a * u * (u - 1) ** 2,
        -b * (u - 1) * (v - 1) * (3 * v - 1),
        t * z * (u - 1),
        u * (2 * v**2 - v - 3 * u + 2 * u**2 + (v - 1) * (4 * v - 1)),
        -a * u**2 * (u - 1),
        b * u * (v - 1) * (3 * v - 1),
        -t * u * z,
        -u * (1 - 3 * u - 3 * v + 2 * v**2 + 2 * u**2 + v * (4 * v - 3)),
        a * u**2 * (u - 1),
        b * u * v * (3 * v - 2),
        t * u * z,
        (u - 1) * (2 * u**2 - u - 3 * v + 2 * v**2 + v * (4 * v - 3)),
        a * u * (u - 1) ** 2,
        -b * v * (3 * v - 2) * (u - 1),
        -t * z * (u - 1),
    ]


def gauss_points(counts: tuple[int, int, int]) -> tuple[FloatArray, FloatArray]:
    """Tensor-product Gauss-Legendre rule on 0..1 x 0..1 x -1/2..1/2, the domain of (xi, eta, zeta).

    Parameters
    ----------
    counts : points along xi, eta, zeta

    Returns
    -------
    xi : (n, 3) float [-]
    weights : (n,) float [-], sum 1

    Verified by tests/unit/test_ancf_shape_functions.py.
    """
    rules = [np.polynomial.legendre.leggauss(n) for n in counts]
    starts = (0.5, 0.5, 0.0)
    axes = [start + 0.5 * rule[0] for start, rule in zip(starts, rules, strict=True)]
    xi = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.einsum("i,j,k->ijk", *(0.5 * rule[1] for rule in rules)).ravel()
    return xi, weights


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateShape:
    """The interpolation a plate model is built on; exchangeable so that a test can damage it.

    Attributes
    ----------
    value : as `plate_shape`
    gradient : as `plate_shape_gradient`
    """

    value: Callable[[FloatArray, FloatArray], FloatArray]
    gradient: Callable[[FloatArray, FloatArray], FloatArray]


THESIS_SHAPE = PlateShape(value=plate_shape, gradient=plate_shape_gradient)
"""Thesis eq. 2.13 as printed."""
