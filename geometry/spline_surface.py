"""Polynomial tensor-product B-spline surfaces, and their pieces as bicubic Bezier patches.

    r(u, v) = sum_ij N_i,p(u) N_j,q(v) P_ij                                  (Piegl & Tiller, The NURBS Book, eq. 3.11)

On a knot span the surface is one polynomial of degree (p, q); with p, q <= 3 its 4 x 4 Bezier control points follow
from its values at thirds of the span, which is knot insertion (Boehm 1980) and degree elevation in one step.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["SplineSurface", "bernstein", "bezier_surface"]

FloatArray = NDArray[np.float64]
_THIRDS = np.arange(4) / 3.0


def bernstein(u: FloatArray) -> FloatArray:
    """Cubic Bernstein polynomials (..., 4) at u (...) in 0..1: B_i = C(3, i) u^i (1 - u)^(3 - i)."""
    u = np.asarray(u, dtype=np.float64)
    return np.stack([comb(3, i) * u**i * (1.0 - u) ** (3 - i) for i in range(4)], axis=-1)


_TO_BEZIER = np.linalg.inv(bernstein(_THIRDS))
"""Values of a cubic at 0, 1/3, 2/3, 1 -> its Bezier control points."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SplineSurface:
    """A B-spline surface without weights.

    Attributes
    ----------
    name : what it is, e.g. ``"rim 0 upper"``; its name in a STEP file
    control_points : (n, m, 3) float [m], P_ij
    degrees : (p, q), each 1 or more
    knots : (n + p + 1,) and (m + q + 1,) float [-], not decreasing, each interior knot at most as often as the degree;
        the surface lives on knots[p] .. knots[n]: clamped or not

    Raises
    ------
    InputError
        For shapes, degrees or knots that do not make a continuous surface, or numbers that are not finite.

    Verified by tests/unit/test_geometry_spline_surface.py.
    """

    name: str
    control_points: FloatArray
    degrees: tuple[int, int]
    knots: tuple[FloatArray, FloatArray]

    def __post_init__(self) -> None:
        shape = self.control_points.shape
        if len(shape) != 3 or shape[2] != 3 or not np.all(np.isfinite(self.control_points)):
            raise InputError(f"{self.name}: control points", shape, "must be (n, m, 3) finite numbers", "check them")
        for axis, n, degree, knots in zip("uv", shape, self.degrees, self.knots, strict=False):
            what = f"{self.name}: knots along {axis}"
            if degree < 1 or n <= degree:
                rule = "must be 1 or more and less than the number of control points"
                raise InputError(f"{self.name}: degree along {axis}", degree, rule, "use 3 and 4 points or more")
            if knots.shape != (n + degree + 1,) or not np.all(np.isfinite(knots)) or np.any(np.diff(knots) < 0.0):
                rule = f"must be {n + degree + 1} finite numbers that do not decrease"
                raise InputError(what, knots, rule, "one more than control points and degree together")
            _, repeats = np.unique(knots[(knots > knots[degree]) & (knots < knots[n])], return_counts=True)
            if knots[degree] >= knots[n] or np.any(repeats > degree):
                rule = "must span a range and repeat an interior knot at most as often as the degree"
                raise InputError(what, knots, rule, "split a surface that is torn at a knot into two")

    @property
    def breaks(self) -> tuple[FloatArray, FloatArray]:
        """Distinct knots (n_u,) and (n_v,) [-] along u and v within the surface: the ends of its polynomial pieces."""
        pairs = zip(self.control_points.shape, self.degrees, self.knots, strict=False)
        u, v = (np.unique(knots[degree : n + 1]) for n, degree, knots in pairs)
        return u, v

    def value(self, parameters: FloatArray) -> FloatArray:
        """Points (k, 3) float [m] at the parameters (k, 2), (u, v) within the surface's knots."""
        from scipy.interpolate import NdBSpline

        spline = NdBSpline(self.knots, self.control_points, self.degrees, extrapolate=False)
        return np.asarray(spline(np.asarray(parameters, dtype=np.float64)), dtype=np.float64)

    def bezier_pieces(self, breaks: tuple[FloatArray, FloatArray] | None = None) -> FloatArray:
        """Bicubic Bezier control points of every piece, (n_u, n_v, 4, 4, 3) float [m]; exact.

        Parameters
        ----------
        breaks : ends of the pieces along u and v, the surface's own breaks among them; by default only these

        Raises
        ------
        InputError
            For a degree above 3, or breaks that leave one of the surface's own out.
        """
        from scipy.interpolate import BSpline

        if max(self.degrees) > 3:
            rule = "must be at most 3, the degree of an ANCF plate"
            raise InputError(f"{self.name}: degrees", self.degrees, rule, "approximate it by cubics first")
        for own, given in zip(self.breaks, breaks or self.breaks, strict=True):
            if not (np.isin(own, given).all() and given[0] == own[0] and given[-1] == own[-1]):
                rule = f"must hold the surface's own, {own}, and end with them"
                raise InputError(f"{self.name}: breaks", given, rule, "add break points, leave none out")
        u, v = ((b[:-1, None] + np.diff(b)[:, None] * _THIRDS).ravel() for b in breaks or self.breaks)
        rows = BSpline(self.knots[0], self.control_points, self.degrees[0])(u)
        values = BSpline(self.knots[1], np.swapaxes(rows, 0, 1), self.degrees[1])(v)
        pieces = values.reshape(len(v) // 4, 4, len(u) // 4, 4, 3)
        return np.asarray(np.einsum("ik,jl,blakx->abijx", _TO_BEZIER, _TO_BEZIER, pieces, optimize=True))


def bezier_surface(name: str, control_points: FloatArray) -> SplineSurface:
    """One bicubic Bezier patch, (4, 4, 3) control points [m], as a B-spline surface on 0..1 x 0..1."""
    ends = np.repeat([0.0, 1.0], 4)
    return SplineSurface(name=name, control_points=control_points, degrees=(3, 3), knots=(ends, ends))
