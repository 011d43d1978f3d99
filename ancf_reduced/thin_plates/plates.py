"""A network of thin ANCF plates: energy, forces, tangent and mass of every state of its nodes.

Each plate has its reference in the nodes' first state, so that curved strips are free of stress there. Along a curved
axis two points of the membrane strain and three of the curvature do not lock (docs/theory/ancf_thin_plate.md). Verified
by tests/unit/test_ancf_thin_plates.py and tests/verification/test_ancf_thin_plate_strips.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from ancf_reduced.thin_plates.kernels import bending_terms, membrane_terms
from ancf_reduced.thin_plates.shape_functions import shape_tables
from contracts.errors import InputError
from contracts.materials import Material

__all__ = ["ThinPlates"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_MASS_POINTS = _FULL_POINTS = 4
HELD = 0.3
"""Times (thickness / length)^2: share of the membrane strain that is integrated at every point, see `ThinPlates`."""
FLAT = 1e-6
"""Curvature that counts as none [1/m]."""
_COORDINATES = 12
"""Of a node."""


class ThinPlates:
    """Plates of one material and thickness.

    Parameters
    ----------
    nodes : (n_nodes, 4, 3) r [m], r_1, r_2 [-], r_12 [1/m] of the reference, free of stress
    plates : (n, 4) nodes (i, j) of each plate at 2 i + j
    sizes : (n, 2) lengths of each plate's parameters [m]
    material : of all plates; plane stress
    thickness : of all plates [m]
    membrane_points, bending_points : Gauss points along both axes; two of the membrane strain along the one a strip is
        curved along, four along the other, or motions within the surface lose their stiffness

    In flat plates two points leave some motions within the surface without any, as r_1 longer at every node. A share
    `HELD` (t / length)^2 of the membrane strain at all points holds them (docs/theory/ancf_thin_plate.md has what that
    changes).

    Raises
    ------
    InputError
        For arrays that do not belong together, for a reference whose surface has no normal, and for one that is curved
        more along the axis with more points.
    """

    def __init__(
        self,
        nodes: Array,
        plates: Index,
        sizes: Array,
        material: Material,
        thickness: float,
        membrane_points: tuple[int, int] = (2, 4),
        bending_points: tuple[int, int] = (3, 3),
    ) -> None:
        if nodes.ndim != 3 or nodes.shape[1:] != (4, 3) or plates.shape != (len(sizes), 4):
            shapes = f"nodes {nodes.shape}, plates {plates.shape}, sizes {sizes.shape}"
            raise InputError("thin plates", shapes, "must be (n, 4, 3), (m, 4) and (m, 2)", "see the docstring")
        if not (np.isfinite(thickness) and thickness > 0.0):
            raise InputError("thickness", f"{thickness:g} m", "must be > 0", "give it in metres")
        self.thickness = thickness
        self.reference, self.plates, self.material = nodes.copy(), plates.astype(np.int64), material
        self._membrane = self._points(sizes, membrane_points)
        self._everywhere = self._points(sizes, (_FULL_POINTS, _FULL_POINTS))
        self._bending = self._points(sizes, bending_points)
        self._mass_points = self._points(sizes, (_MASS_POINTS, _MASS_POINTS))
        t = thickness
        held = np.minimum(1.0, HELD * (t / sizes.max(axis=1)) ** 2)
        self._membrane_given = self._both((1.0 - held, self._membrane), (held, self._everywhere))
        tables, area, metric, curvature, elastic = self._bending
        self._bending_given = (
            tables,
            (curvature, metric, _coupling(metric, curvature)),
            t**3 / 12.0 * area[..., None, None] * elastic,
        )
        _require_along(metric, curvature, membrane_points)
        numbers = (_COORDINATES * self.plates[:, :, None] + np.arange(_COORDINATES)).reshape(len(plates), -1)
        self._rows = np.repeat(numbers, numbers.shape[1], axis=1).ravel()
        self._columns = np.tile(numbers, (1, numbers.shape[1])).ravel()
        self._numbers = numbers

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.reference.size

    def energy(self, q: Array) -> float:
        """Strain energy at nodes q (n_nodes, 4, 3) [J]."""
        return self._all(q, tangent=False)[0]

    def force(self, q: Array) -> Array:
        """Derivative of the energy by every coordinate, (n_nodes, 4, 3)."""
        return self._all(q, tangent=False)[1]

    def tangent(self, q: Array) -> csc_array:
        """Second derivatives of the energy, (n_nodes * 12, n_nodes * 12), symmetric."""
        blocks = self._all(q, tangent=True)[2]
        return csc_array(coo_array((blocks.ravel(), (self._rows, self._columns)), shape=(self.size, self.size)))

    def mass(self) -> csc_array:
        """Consistent mass, the thickness' own inertia left out, (n_nodes * 12, n_nodes * 12)."""
        tables, area, *_ = self._mass_points
        weight = self.material.density * self.thickness * area
        one = np.einsum("ep,epk,epl->ekl", weight, tables[:, :, 0], tables[:, :, 0])
        blocks = np.einsum("ekl,ij->ekilj", one, np.eye(3))
        return csc_array(coo_array((blocks.ravel(), (self._rows, self._columns)), shape=(self.size, self.size)))

    def _both(self, *parts: tuple[Array, tuple[Array, Array, Array, Array, Array]]) -> tuple[Array, Array, Array]:
        """Tables, metrics and stiffness of several sets of points, each with its share of every plate (n,)."""
        t = self.thickness
        sets = [
            (tables, metric, t * (share[:, None] * area)[..., None, None] * elastic)
            for share, (tables, area, metric, _, elastic) in parts
        ]
        tables, metric, stiffness = (np.concatenate([one[k] for one in sets], axis=1) for k in range(3))
        return tables, metric, stiffness

    def _all(self, q: Array, *, tangent: bool) -> tuple[float, Array, Array]:
        n = len(self.plates)
        force = np.zeros((n, 16, 3))
        blocks = np.zeros((n if tangent else 0, 16, 3, 16, 3))
        energy = membrane_terms(q, self.plates, *self._membrane_given, force, blocks)
        energy += bending_terms(q, self.plates, *self._bending_given, force, blocks)
        return energy, self._gathered(force), blocks

    def _gathered(self, local: Array) -> Array:
        total = np.bincount(self._numbers.ravel(), weights=local.ravel(), minlength=self.size)
        return total.reshape(self.reference.shape)

    def _points(self, sizes: Array, counts: tuple[int, int]) -> tuple[Array, Array, Array, Array, Array]:
        """Tables, areas, metrics (A_11, A_22, 2 A_12), curvatures likewise, and elasticities of all plates' points."""
        (u, wu), (v, wv) = (np.polynomial.legendre.leggauss(n) for n in counts)
        at = np.stack(np.meshgrid(0.5 + 0.5 * u, 0.5 + 0.5 * v, indexing="ij"), axis=-1).reshape(-1, 2)
        weights = 0.25 * np.outer(wu, wv).ravel()
        tables = np.stack([shape_tables((float(a), float(b)), at[:, 0], at[:, 1]) for a, b in sizes])
        local = self.reference[self.plates].reshape(len(self.plates), 16, 3)
        parts = np.einsum("epdk,eki->epdi", tables, local)
        a1, a2 = parts[:, :, 1], parts[:, :, 2]
        normal = np.cross(a1, a2)
        ratio = np.linalg.norm(normal, axis=-1)
        if not (ratio > 0.0).all():
            raise InputError(
                "thin plates", "r_1 x r_2 = 0", "must have a normal everywhere", "give slopes along both axes"
            )
        normal /= ratio[..., None]
        metric = np.stack([(a * b).sum(-1) for a, b in ((a1, a1), (a2, a2), (a1, 2.0 * a2))], axis=-1)
        second = np.stack([parts[:, :, 3], parts[:, :, 5], 2.0 * parts[:, :, 4]], axis=-2)
        curvature = np.einsum("epki,epi->epk", second, normal)
        area = ratio * weights * (sizes[:, 0] * sizes[:, 1])[:, None]
        return tables, area, metric, curvature, self._elasticity(metric)

    def _elasticity(self, metric: Array) -> Array:
        """Plane-stress tensor by (11, 22, 12) in contravariant components, (..., 3, 3) [Pa]."""
        nu = self.material.poisson_ratio
        covariant = np.stack([metric[..., 0], 0.5 * metric[..., 2], 0.5 * metric[..., 2], metric[..., 1]], axis=-1)
        A = np.linalg.inv(covariant.reshape(*metric.shape[:-1], 2, 2))
        pairs = ((0, 0), (1, 1), (0, 1))
        full = np.stack(
            [
                np.stack(
                    [
                        nu * A[..., a, b] * A[..., c, d]
                        + 0.5 * (1.0 - nu) * (A[..., a, c] * A[..., b, d] + A[..., a, d] * A[..., b, c])
                        for c, d in pairs
                    ],
                    axis=-1,
                )
                for a, b in pairs
            ],
            axis=-2,
        )
        return np.asarray(self.material.young_modulus / (1.0 - nu**2) * full)


def _require_along(metric: Array, curvature: Array, points: tuple[int, int]) -> None:
    """Refuse a reference that is curved more along the axis with more points of the membrane strain."""
    along, across = (float(np.abs(curvature[..., k] / metric[..., k]).max()) for k in (0, 1))
    if (points[0] < points[1] and across > along + FLAT) or (points[0] > points[1] and along > across + FLAT):
        rule = f"has curvatures of {along:.3g} and {across:.3g} 1/m and membrane points of {points[0]} and {points[1]}"
        hint = "give fewer points along the axis that is curved more, or turn the plates"
        raise InputError("thin plates", "the reference", rule, hint)


def _coupling(metric: Array, curvature: Array) -> Array:
    """What stretch alone adds to the curvatures (11, 22, 2 x 12), by E_11, E_22, 2 E_12, (..., 3, 3) [1/m].

    B_a^c E_cb + B_b^c E_ca: of r_,ab . n, what changes where lines are stretched and keep their curvature.
    """

    def square(three: Array) -> Array:
        half = 0.5 * three[..., 2]
        return np.stack([three[..., 0], half, half, three[..., 1]], axis=-1).reshape(*three.shape[:-1], 2, 2)

    mixed = np.linalg.solve(square(metric), square(curvature))  # A^cd B_da
    columns = []
    for unit in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]):
        product = np.swapaxes(mixed, -1, -2) @ square(np.array(unit))
        both = product + np.swapaxes(product, -1, -2)
        columns.append(np.stack([both[..., 0, 0], both[..., 1, 1], 2.0 * both[..., 0, 1]], axis=-1))
    return np.stack(columns, axis=-1)
