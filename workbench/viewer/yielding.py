"""Where the von Mises stress exceeds the yield strength of the part.

Verified by tests/unit/test_viewer_yielding.py.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from workbench.viewer.wheel_surface import WheelSurface

__all__ = ["above_yield", "legend", "marked_share"]

FloatArray = NDArray[np.float64]
_MANY = 4
"""Parts of different strength from which on the legend gives the range alone."""


def above_yield(surface: WheelSurface, von_mises: FloatArray, strengths: Mapping[int, float]) -> NDArray[np.bool_]:
    """Points (n,) of the surface at which the stress at the mesh's nodes [Pa] exceeds yield.

    strengths : by tag of the part [Pa]; others do not yield. Where two parts meet that are drawn, the smaller counts.
    """
    of_quads = np.array([strengths.get(tag, np.inf) for tag in surface.parts.tolist()])
    limit = np.full(len(surface.nodes), np.inf)
    np.minimum.at(limit, surface.quads, of_quads[:, None])
    above: NDArray[np.bool_] = von_mises[surface.nodes] > limit
    return above


def marked_share(surface: WheelSurface, marked: NDArray[np.bool_]) -> float:
    """Of the undeformed area of the surface, a quadrangle counting by its marked corners [-]; 0 of no surface."""
    corners = surface.places[surface.quads]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    area = np.linalg.norm(normal, axis=1)
    return float(area @ marked[surface.quads].mean(axis=1) / area.sum()) if len(area) else 0.0


def legend(strengths: Mapping[str, float], share: float) -> str:
    """``above yield strength: 255 MPa (3.1 % of the surface)``, strengths [Pa] by the names of parts."""
    values = sorted(set(strengths.values()))
    if len(values) == 1:
        limits = _megapascal(values[0])
    elif len(values) < _MANY:
        limits = ", ".join(
            f"{_megapascal(value)} {' and '.join(name for name in strengths if strengths[name] == value)}"
            for value in values
        )
    else:
        limits = f"{_megapascal(values[0])} to {_megapascal(values[-1])}, by part"
    return f"above yield strength: {limits} ({100.0 * share:.2g} % of the surface)"


def _megapascal(value: float) -> str:
    return f"{1e-6 * value:.4g} MPa"
