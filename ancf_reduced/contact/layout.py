"""Where regular contact points lie on a face, and what share of it each stands for.

The thesis says only "100 points" (section 2.4.1). The layout is part of the model: see theory notes, section 6.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["ContactLayout", "regular_points"]

FloatArray = NDArray[np.float64]
ContactLayout = Literal["edges", "centres"]


def regular_points(counts: tuple[int, int], layout: ContactLayout) -> tuple[FloatArray, FloatArray]:
    """Points on the face zeta = +1/2.

    Parameters
    ----------
    counts : points along x1 and x2
    layout : ``"edges"``: at i/(n-1), so a row shared by two plates counts for both; ``"centres"``: at (i+1/2)/n

    Returns
    -------
    xi : (n_points, 3) float [-], (xi, eta, zeta)
    share : (n_points,) float [-], sum 1; with edges by the trapezoidal rule

    Raises
    ------
    InputError
        For fewer than two points along an edge, or none at all.

    Verified by tests/unit/test_ancf_contact_grid.py.
    """
    if min(counts) < (2 if layout == "edges" else 1):
        raise InputError("contact points", counts, "needs 2 or more along each edge", "give e.g. 10 x 10")
    if layout == "edges":
        axes = [np.linspace(0.0, 1.0, n) for n in counts]
        shares = [np.array([0.5, *[1.0] * (n - 2), 0.5]) / (n - 1) for n in counts]
    else:
        axes = [(np.arange(n) + 0.5) / n for n in counts]
        shares = [np.full(n, 1.0 / n) for n in counts]
    xi = np.stack(np.meshgrid(*axes, [0.5], indexing="ij"), axis=-1).reshape(-1, 3)
    return xi, np.outer(*shares).ravel()
