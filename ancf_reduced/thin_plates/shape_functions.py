"""Bicubic Hermite functions of a four-node plate whose nodes hold r, r_1, r_2 and r_12.

The plate is the rectangle [0, a] x [0, b] of its two parameters; node (i, j) at (i a, j b) has the number 2 i + j, and
its four vectors the numbers 0 to 3. A function is the product of one cubic along each axis (Bogner, Fox & Schmit, Proc.
Conf. Matrix Methods in Structural Mechanics, Wright-Patterson, 1965, from memory), so that position and slope are
continuous from plate to plate. Verified by tests/unit/test_ancf_thin_plates.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import compiled

__all__ = ["DERIVATIVES", "hermite", "shape_rows", "shape_tables"]

Array = NDArray[np.float64]

DERIVATIVES = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
"""Rows of `shape_tables`: orders of differentiation along both axes."""


def hermite(u: Array, length: float) -> Array:
    """Cubics on [0, length] at u in [0, 1], (..., 3, 2, 2): order of differentiation, end, value (0) or slope (1)."""
    h, one = length, np.ones_like(u)
    values = [[1 - 3 * u**2 + 2 * u**3, h * (u - 2 * u**2 + u**3)], [3 * u**2 - 2 * u**3, h * (u**3 - u**2)]]
    first = [[(6 * u**2 - 6 * u) / h, 1 - 4 * u + 3 * u**2], [(6 * u - 6 * u**2) / h, 3 * u**2 - 2 * u]]
    second = [[(12 * u - 6) / h**2, (6 * u - 4) / h], [(6 - 12 * u) / h**2, (6 * u - 2) / h]]
    return np.moveaxis(
        np.array([[[f * one for f in end] for end in row] for row in (values, first, second)]), (0, 1, 2), (-3, -2, -1)
    )


def shape_tables(size: tuple[float, float] | Array, u: Array, v: Array) -> Array:
    """Shape functions of a plate and their derivatives, (n, 6, 16), rows as in `DERIVATIVES`.

    size : lengths a, b of the plate's parameters [m]; u, v : (n,) places in [0, 1] along both axes
    """
    along, across = hermite(u, size[0]), hermite(v, size[1])
    rows = []
    for p, q in DERIVATIVES:
        product = along[:, p, :, None, :, None] * across[:, q, None, :, None, :]  # n, end i, end j, slope 1, slope 2
        rows.append(np.stack([product[..., 0, 0], product[..., 1, 0], product[..., 0, 1], product[..., 1, 1]], axis=-1))
    return np.stack([row.reshape(len(u), 16) for row in rows], axis=1)


@compiled
def shape_rows(size: Array, place: Array, rows: Array) -> None:
    """As `shape_tables`, of one plate of lengths size (2,) at one place (2,), into rows (6, 16); compiled."""
    f = np.empty((2, 3, 2, 2))
    for axis in range(2):
        h, u = size[axis], place[axis]
        f[axis, 0, 0, 0], f[axis, 0, 0, 1] = 1.0 - u * u * (3.0 - 2.0 * u), h * u * (1.0 - u) * (1.0 - u)
        f[axis, 0, 1, 0], f[axis, 0, 1, 1] = u * u * (3.0 - 2.0 * u), h * u * u * (u - 1.0)
        f[axis, 1, 0, 0], f[axis, 1, 0, 1] = 6.0 * u * (u - 1.0) / h, 1.0 - u * (4.0 - 3.0 * u)
        f[axis, 1, 1, 0], f[axis, 1, 1, 1] = 6.0 * u * (1.0 - u) / h, u * (3.0 * u - 2.0)
        f[axis, 2, 0, 0], f[axis, 2, 0, 1] = (12.0 * u - 6.0) / (h * h), (6.0 * u - 4.0) / h
        f[axis, 2, 1, 0], f[axis, 2, 1, 1] = (6.0 - 12.0 * u) / (h * h), (6.0 * u - 2.0) / h
    for row in range(6):
        p = 1 if row == 1 or row == 4 else 2 if row == 3 else 0
        q = 1 if row == 2 or row == 4 else 2 if row == 5 else 0
        for node in range(4):
            for kind in range(4):
                value = f[0, p, node // 2, kind % 2] * f[1, q, node % 2, kind // 2]
                rows[row, 4 * node + kind] = value
