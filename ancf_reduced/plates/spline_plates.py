"""B-spline surfaces become plates, one per polynomial piece, without meshing; plates become B-spline surfaces again.

Geometry and analysis in one: the control points of a piece are the coordinates of its plate (bezier), its corners the
nodes. The thickness direction comes from a second surface, or from the normals at the corners with a given thickness.
J0 = [r_xi/a, r_eta/b, r_zeta/t], and only J0 diag(a, b, t) enters the element (thesis eq. 2.10): the lengths a, b, t of
the straight configuration, here the mean lengths of opposite edges and of the directors, are a scale and nothing more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.bezier import bezier_to_plate, coons_residual, elevated, plate_to_bezier
from ancf_reduced.plates.mesh import PlateMesh, PlatePatch
from contracts.errors import InputError
from geometry.spline_surface import SplineSurface, bezier_surface

__all__ = ["FACES", "SplinePlates", "plate_surfaces", "plates_between", "plates_on_surface"]

FloatArray = NDArray[np.float64]
FACES = {"lower": -0.5, "middle": 0.0, "upper": 0.5}
"""Name of a plate's surface -> its zeta."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True, slots=True, kw_only=True)
class SplinePlates:
    """Plates on the pieces of a B-spline surface, v fastest; ready for `build_plate_mesh`.

    Attributes
    ----------
    patches : one plate per piece; x1 along u, x2 along v
    residual : (n_plates,) float [m], upper bound of the distance between the surface given and the plate's; zero (to
        rounding) in the element's space
    """

    patches: tuple[PlatePatch, ...]
    residual: FloatArray


def plates_on_surface(
    surface: SplineSurface,
    thickness: float,
    *,
    part: str,
    subdivisions: tuple[int, int] = (1, 1),
    tolerance: float = 1e-9,
) -> SplinePlates:
    """Plates of constant thickness whose mid-surface is a B-spline surface, directors along its normals r_u x r_v.

    Directors are unit normals at the nodes and interpolated bilinearly between them, as everywhere in this element.

    Parameters
    ----------
    surface : mid-surface of degree 3 or less
    thickness : t [m]
    part : name of the part
    subdivisions : each piece is cut into so many along u and v
    tolerance : largest residual accepted [m]; the residual falls with the fourth power of the pieces' size

    Raises
    ------
    InputError
        If the thickness is not above zero, the surface has no normal at a corner, or leaves the plate's space by more
        than ``tolerance``.

    Verified by tests/verification/test_ancf_spline_tire.py.
    """
    if not thickness > 0.0:
        raise InputError(
            f"{surface.name}: thickness", f"{thickness:g} m", "must be greater than zero", "check the unit"
        )
    middle = surface.bezier_pieces(_subdivided(surface.breaks, subdivisions)).reshape(-1, 4, 4, 3)
    r_u = 3.0 * np.stack([middle[:, 1] - middle[:, 0], middle[:, 3] - middle[:, 2]], axis=1)[:, :, ::3]
    r_v = 3.0 * np.stack([middle[:, :, 1] - middle[:, :, 0], middle[:, :, 3] - middle[:, :, 2]], axis=2)[:, ::3]
    normal = np.cross(r_u, r_v)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    if not length.min() > 0.0:
        rule = "must not be zero at the corner of a piece"
        raise InputError(f"{surface.name}: normal r_u x r_v", "zero", rule, "cut the surface before it degenerates")
    return _plates(surface.name, middle, thickness * normal / length, part, coons_residual(middle), tolerance)


def plates_between(
    lower: SplineSurface,
    upper: SplineSurface,
    *,
    part: str,
    subdivisions: tuple[int, int] = (1, 1),
    tolerance: float = 1e-9,
) -> SplinePlates:
    """Plates between two B-spline surfaces, the faces zeta = -1/2 and +1/2; points of equal (u, v) belong together.

    Parameters
    ----------
    lower, upper : faces of degree 3 or less over the same range of u and v; their own knots may differ
    part, subdivisions, tolerance : as `plates_on_surface`; the residual holds for both faces

    Raises
    ------
    InputError
        If the ranges differ, or a face leaves the plate's space by more than ``tolerance``.

    Verified by tests/unit/test_ancf_spline_plates.py.
    """
    u, v = (np.union1d(own, other) for own, other in zip(lower.breaks, upper.breaks, strict=True))
    breaks = _subdivided((u, v), subdivisions)
    faces = [surface.bezier_pieces(breaks).reshape(-1, 4, 4, 3) for surface in (lower, upper)]
    middle, across = 0.5 * (faces[0] + faces[1]), faces[1] - faces[0]
    director = across[:, ::3, ::3]
    bent = np.linalg.norm(across - elevated(director), axis=-1).max(axis=(-2, -1))
    residual = coons_residual(middle) + 0.5 * bent
    return _plates(f"{lower.name}, {upper.name}", middle, director, part, residual, tolerance)


def _subdivided(breaks: tuple[FloatArray, FloatArray], counts: tuple[int, int]) -> tuple[FloatArray, FloatArray]:
    """Every interval cut into so many equal ones; the old breaks stay bit by bit."""
    if min(counts) < 1:
        raise InputError("subdivisions", counts, "must be 1 or more along u and v", "give (1, 1)")
    u, v = (
        np.append((b[:-1, None] + np.diff(b)[:, None] * np.arange(n) / n).ravel(), b[-1])
        for b, n in zip(breaks, counts, strict=True)
    )
    return u, v


def _plates(
    name: str, middle: FloatArray, director: FloatArray, part: str, residual: FloatArray, tolerance: float
) -> SplinePlates:
    """Plates from mid-surfaces (n, 4, 4, 3) and directors t r_x3 (n, 2, 2, 3), if the residual allows."""
    if residual.max() > tolerance:
        rule = f"must be at most {tolerance:.3g} m: the surface lies outside the space of the ANCF plate"
        hint = "raise subdivisions (twice as many leave 1/16), or accept the nearest plates with a larger tolerance"
        raise InputError(f"{name}: residual", f"{residual.max():.3g} m", rule, hint)
    coordinates = bezier_to_plate(middle, director)
    return SplinePlates(patches=tuple(_patch(e, part) for e in coordinates), residual=residual)


def _patch(coordinates: FloatArray, part: str) -> PlatePatch:
    """The plate with the normalised coordinates (16, 3), its lengths taken from its edges and directors."""
    middle = plate_to_bezier(coordinates)
    nodes = coordinates.reshape(4, 4, 3)
    lengths = [0.5 * (_length(edge[0]) + _length(edge[1])) for edge in (np.swapaxes(middle, 0, 1)[::3], middle[::3])]
    dimensions = np.array([*lengths, np.linalg.norm(nodes[:, 3], axis=1).mean()])
    gradients = np.swapaxes(nodes[:, 1:], 1, 2) / dimensions
    return PlatePatch(corners=nodes[:, 0], gradients=gradients, dimensions=dimensions, part=part)


def _length(curve: FloatArray) -> float:
    """Length [m] of a cubic Bezier curve (4, 3), by eight Gauss points."""
    u = 0.5 + 0.5 * _POINTS[:, None]
    hodograph = 3.0 * np.diff(curve, axis=0)
    velocity = (1 - u) ** 2 * hodograph[0] + 2 * u * (1 - u) * hodograph[1] + u**2 * hodograph[2]
    return float(0.5 * _WEIGHTS @ np.linalg.norm(velocity, axis=1))


def plate_surfaces(mesh: PlateMesh, coordinates: FloatArray) -> tuple[SplineSurface, ...]:
    """Lower face, mid-surface and upper face of every plate as B-spline surfaces; exact, deformed or not.

    Parameters
    ----------
    mesh : plates
    coordinates : (n_nodes, 4, 3) float [m, -], structure coordinates p

    Returns
    -------
    surfaces : three per plate, on 0..1 x 0..1, (u, v) = (xi, eta); named ``"{part} {number in the mesh} {face}"``

    Verified by tests/verification/test_ancf_spline_step.py.
    """
    e = mesh.normalised(coordinates, mesh.gradients * mesh.dimensions[:, None, None, :])
    pieces = {face: plate_to_bezier(e, zeta) for face, zeta in FACES.items()}
    return tuple(
        bezier_surface(f"{part} {j} {face}", points[j])
        for j, part in enumerate(mesh.parts)
        for face, points in pieces.items()
    )
