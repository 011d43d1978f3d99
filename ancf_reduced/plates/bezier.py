"""The linear map between a plate's coordinates and bicubic Bezier control points, both ways.

The surfaces zeta = const of a plate (thesis eqs. 2.11 to 2.13) are bicubic Bezier patches,

    r(xi, eta, zeta) = sum_ij B_i(xi) B_j(eta) b_ij,      i, j = 0..3.

Along an edge the plate (Mikkola & Shabana 2003) is the cubic Hermite curve of its nodes; gradients are differences of
control points, r_xi(0, 0) = 3 (b_10 - b_00) and so on (Sanborn & Shabana 2009; Lan & Shabana 2010): 12 coordinates, 12
boundary points. Eq. 2.13 has the 12 terms xi^i eta^j with i <= 1 or j <= 1, those of a bilinearly blended Coons patch.
So the mid-surface *is* the Coons patch of its edges, and the inner points follow from the boundary (h = i/3, k = j/3):

    b_ij = (1-k) b_i0 + k b_i3 + (1-h) b_0j + h b_3j - (1-h)(1-k) b_00 - h(1-k) b_30 - (1-h)k b_03 - h k b_33.

Plate to Bezier is exact. Bezier to plate keeps the boundary curves and loses only what the four inner points (four
twists) add to the Coons patch; `coons_residual` says how much that is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["bezier_to_plate", "coons_residual", "elevated", "plate_to_bezier"]

FloatArray = NDArray[np.float64]
_CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
"""(xi, eta) of the nodes, in the order of thesis eq. 2.15."""
_BLEND = np.column_stack([1.0 - np.arange(4) / 3.0, np.arange(4) / 3.0])
"""Linear blending at 0, 1/3, 2/3, 1: a linear function as a cubic."""
_INNER_WEIGHT = 9.0 / 16.0
"""Largest sum of the four inner B_i(xi) B_j(eta), at the centre of the patch."""


def elevated(corners: FloatArray) -> FloatArray:
    """Bicubic control points (..., 4, 4, 3) of the bilinear surface with corners (..., 2, 2, 3), [xi, eta]."""
    return np.asarray(np.einsum("ia,jb,...abx->...ijx", _BLEND, _BLEND, corners, optimize=True))


def _coons(b: FloatArray) -> FloatArray:
    """Control points of the Coons patch with the boundary of b, both (..., 4, 4, 3)."""
    along_xi = np.einsum("jb,...ibx->...ijx", _BLEND, b[..., :, ::3, :])
    along_eta = np.einsum("ia,...ajx->...ijx", _BLEND, b[..., ::3, :, :])
    return np.asarray(along_xi + along_eta - elevated(b[..., ::3, ::3, :]))


def plate_to_bezier(coordinates: FloatArray, zeta: float = 0.0) -> FloatArray:
    """Bezier control points of a plate's surface zeta = const; exact.

    Parameters
    ----------
    coordinates : (..., 16, 3) float [m], per node r, r_xi, r_eta, r_zeta: lengths a, b, t in the gradients
        (`PlateMesh.normalised`)
    zeta : x3/t [-], 0 for the mid-surface, -1/2 and +1/2 for the faces

    Returns
    -------
    control_points : (..., 4, 4, 3) float [m], first index along xi

    Verified by tests/unit/test_ancf_bezier.py.
    """
    nodes = coordinates.reshape(*coordinates.shape[:-2], 4, 4, 3)
    b = np.zeros((*nodes.shape[:-3], 4, 4, 3))
    director = np.empty((*nodes.shape[:-3], 2, 2, 3))
    for k, (i, j) in enumerate(_CORNERS):
        r, r_xi, r_eta, director[..., i, j, :] = np.moveaxis(nodes[..., k, :, :], -2, 0)
        b[..., 3 * i, 3 * j, :] = r
        b[..., 1 + i, 3 * j, :] = r + (1 - 2 * i) * r_xi / 3.0
        b[..., 3 * i, 1 + j, :] = r + (1 - 2 * j) * r_eta / 3.0
    b[..., 1:3, 1:3, :] = _coons(b)[..., 1:3, 1:3, :]
    return b + zeta * elevated(director)


def bezier_to_plate(middle: FloatArray, director: FloatArray) -> FloatArray:
    """Plate coordinates from the mid-surface's control points; the inverse of `plate_to_bezier`.

    Parameters
    ----------
    middle : (..., 4, 4, 3) float [m], control points at zeta = 0, [xi, eta]; the four inner ones do not count
    director : (..., 2, 2, 3) float [m], r_zeta = t r_x3 at the corners [xi, eta], from zeta = -1/2 to +1/2

    Returns
    -------
    coordinates : (..., 16, 3) float [m], per node r, r_xi, r_eta, r_zeta

    Verified by tests/unit/test_ancf_bezier.py.
    """
    nodes = np.empty((*middle.shape[:-3], 4, 4, 3))
    for k, (i, j) in enumerate(_CORNERS):
        r = middle[..., 3 * i, 3 * j, :]
        nodes[..., k, 0, :] = r
        nodes[..., k, 1, :] = 3.0 * (1 - 2 * i) * (middle[..., 1 + i, 3 * j, :] - r)
        nodes[..., k, 2, :] = 3.0 * (1 - 2 * j) * (middle[..., 3 * i, 1 + j, :] - r)
        nodes[..., k, 3, :] = director[..., i, j, :]
    return nodes.reshape(*middle.shape[:-3], 16, 3)


def coons_residual(control_points: FloatArray) -> FloatArray:
    """Upper bound of the distance between a Bezier patch and the plate with its boundary, (...) float [m].

    9/16 of the largest distance of an inner control point from its place on the Coons patch: reached, at the centre,
    when all four are moved alike. Zero if and only if the patch lies in the plate's space. ``control_points`` is
    (..., 4, 4, 3) float [m].

    Verified by tests/unit/test_ancf_bezier.py.
    """
    moved = (control_points - _coons(control_points))[..., 1:3, 1:3, :]
    return np.asarray(_INNER_WEIGHT * np.linalg.norm(moved, axis=-1).max(axis=(-2, -1)))
