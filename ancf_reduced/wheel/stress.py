"""Stress on the faces of an ANCF wheel's springs, where the solid model has its linearised stress.

Membrane strain is taken from the two points along a strip at which it is integrated, curvature from the three: between
them both are polynomials through these. A place counts from one thickness off a weld's end on, and four off a free edge
(at most half way to the strip's middle), as in the solid model (docs/theory/finite_elements.md). Verified by
tests/unit/test_ancf_wheel_stress.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer
from ancf_reduced.thin_plates.shape_functions import shape_tables
from ancf_reduced.wheel.closest import neighbours
from ancf_reduced.wheel.hub import HUB_PARTS
from ancf_reduced.wheel.mesh import AncfWheel

__all__ = ["largest_spring_stress"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_FROM_WELD, _FROM_EDGE = 1.0, 4.0
"""Distances of places that count, in thicknesses, as in the solid model's linearised stress."""
_ALONG, _ACROSS = 9, 5
"""Places of a plate along both axes."""


def largest_spring_stress(wheel: AncfWheel, q: Array) -> dict[str, float]:
    """Largest von Mises stress [Pa] on both faces of each spring set's legs, at nodes q (n_nodes, 4, 3)."""
    strips = wheel.strips
    springs = (strips.strip != 0) & ~np.isin(wheel.parts, HUB_PARTS)
    beside = neighbours(wheel.plates.plates, np.flatnonzero(springs))
    found = dict[str, float]()
    for part in dict.fromkeys(wheel.parts[springs].tolist()):
        worst = [
            _largest(wheel, q, np.flatnonzero(strips.strip == k), beside)
            for k in np.unique(strips.strip[(wheel.parts == part) & springs])
        ]
        found[str(part)] = max(worst)
    return found


def _largest(wheel: AncfWheel, q: Array, which: Index, beside: Index) -> float:
    plates = wheel.plates
    layer = plates.layers[which[0]][0]
    y = plates.reference[plates.plates[which], 0, 1]
    width = float(plates.sizes[which, 1][beside[which, 0] < 0].sum())
    inwards = min(_FROM_EDGE * layer.thickness, 0.25 * width)
    free = beside[which][:, 2:] < 0
    free[:, 0] &= ~((wheel.sides > 1.0) & (np.abs(y[:, 0]) < 1e-12))
    ends = beside[which][:, :2] < 0
    u = _between(plates.sizes[which, 0], ends, _FROM_WELD * layer.thickness, _ALONG)
    v = _between(plates.sizes[which, 1], free, inwards, _ACROSS)
    A, B = _forms(wheel, plates.reference, which, u, v)
    a, b = _forms(wheel, q, which, u, v)
    return max(float(_von_mises((A, B), (a, b), layer, 0.5 * side * layer.thickness).max()) for side in (1.0, -1.0))


def _between(lengths: Array, cut: NDArray[np.bool_], distance: float, count: int) -> Array:
    """Places (n, count) in [0, 1] that keep a distance [m] from the ends that are cut."""
    low, high = (np.where(cut[:, k], np.minimum(0.5, distance / lengths), 0.0) for k in (0, 1))
    return np.asarray(low[:, None] + (1.0 - low - high)[:, None] * np.linspace(0.0, 1.0, count))


def _forms(wheel: AncfWheel, q: Array, which: Index, u: Array, v: Array) -> tuple[Array, Array]:
    """Metric and curvature (n, along, across, 2, 2) at places u and v, from the points along the strip."""
    membrane, bending = (0.5 + 0.5 * np.polynomial.legendre.leggauss(n)[0] for n in (2, 3))
    local = q[wheel.plates.plates[which]].reshape(len(which), 16, 3)
    sizes = wheel.plates.sizes[which]

    def at(points: Array) -> list[Array]:
        """Derivatives (n, g, across, 3) of r at the points along the strip and places across it."""
        n, g, c = len(which), len(points), v.shape[1]
        places = np.broadcast_to(points[None, :, None], (n, g, c)), np.broadcast_to(v[:, None], (n, g, c))
        rows = shape_tables(np.repeat(sizes, g * c, axis=0).T, places[0].ravel(), places[1].ravel())
        parts = np.einsum("ngcdk,nki->dngci", rows.reshape(n, g, c, 6, 16), local)
        return list(parts[1:])

    a1, a2 = at(membrane)[:2]
    metric = _square(*((x * y).sum(-1) for x, y in ((a1, a1), (a1, a2), (a2, a2))))
    a1, a2, r11, r12, r22 = at(bending)
    normal = np.cross(a1, a2)
    normal /= np.linalg.norm(normal, axis=-1)[..., None]
    curvature = _square(*((x * normal).sum(-1) for x in (r11, r12, r22)))
    return (
        np.einsum("nug,ngcij->nucij", _lagrange(membrane, u), metric),
        np.einsum("nug,ngcij->nucij", _lagrange(bending, u), curvature),
    )


def _lagrange(points: Array, u: Array) -> Array:
    """Values (..., n) at u of the polynomials that are 1 at one of n points and 0 at the others."""
    factors = [
        np.prod([(u - other) / (one - other) for other in points if other != one], axis=0) for one in points.tolist()
    ]
    return np.stack(factors, axis=-1)


def _square(one: Array, both: Array, two: Array) -> Array:
    return np.stack([np.stack([one, both], axis=-1), np.stack([both, two], axis=-1)], axis=-2)


def _von_mises(reference: tuple[Array, Array], now: tuple[Array, Array], layer: Layer, height: float) -> Array:
    """Cauchy's stress in the plane, of St. Venant and Kirchhoff's law with free faces, at a height [m]."""
    G, g = (_raised(*forms, height) for forms in (reference, now))
    nu, inverse = layer.material.poisson_ratio, np.linalg.inv(G)
    strain = 0.5 * (g - G)
    raised = inverse @ strain @ inverse
    trace = np.einsum("...ij,...ij", inverse, strain)
    stress = (
        layer.material.young_modulus / (1.0 - nu**2) * (nu * trace[..., None, None] * inverse + (1.0 - nu) * raised)
    )
    thicker = np.sqrt(1.0 - 2.0 * nu / (1.0 - nu) * trace)
    stress /= (np.sqrt(np.linalg.det(g) / np.linalg.det(G)) * thicker)[..., None, None]
    mixed = stress @ g
    return np.asarray(
        np.sqrt(1.5 * np.einsum("...ij,...ji", mixed, mixed) - 0.5 * np.trace(mixed, axis1=-2, axis2=-1) ** 2)
    )


def _raised(metric: Array, curvature: Array, height: float) -> Array:
    """Metric of the surface at a height [m] over one with this metric and curvature."""
    return np.asarray(metric - 2.0 * height * curvature + height**2 * curvature @ np.linalg.inv(metric) @ curvature)
