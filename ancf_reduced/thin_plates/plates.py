"""A network of thin ANCF plates: energy, forces, tangent and mass of every state of its nodes.

Each plate has its reference in the nodes' first state, so that curved strips are free of stress there. Along a curved
axis two points of the membrane strain and three of the curvature do not lock (docs/theory/ancf_thin_plate.md). Verified
by tests/unit/test_ancf_thin_plates.py and tests/verification/test_ancf_thin_plate_strips.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from ancf_reduced.thin_plates.kernels import Points, add_terms, find_stress
from ancf_reduced.thin_plates.shape_functions import shape_tables
from contracts.errors import InputError
from contracts.materials import Material

__all__ = ["Layer", "ThinPlates"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_FULL = (4, 4)
"""Points of the mass and of the share of the membrane strain that is integrated at every point."""
HELD = 0.3
"""Times (thickness / length)^2: share of the membrane strain that is integrated at every point, see `ThinPlates`."""
FLAT = 1e-6
"""Curvature that counts as none [1/m]."""
_COORDINATES = 12
"""Of a node."""
_Fields = tuple[Array, Array, Array, Array]


@dataclass(frozen=True, slots=True, kw_only=True)
class Layer:
    """A sheet in a plate, or a rib along its second axis.

    Attributes
    ----------
    material : plane stress
    thickness : [m]
    height : of its middle above the plate's surface, along r_1 x r_2 [m]
    rib : width along the first axis of the rib that this is, or of which it is a piece [m]. Its flanks are free: it is
        stretched and bent along the second axis alone, and twisted as a rod. 0: a sheet
    foot : what a rib adds to the plate's rigidity against bending along the first axis, by width [N m]
    """

    material: Material
    thickness: float
    height: float = 0.0
    rib: float = 0.0
    foot: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.thickness) and self.thickness > 0.0):
            raise InputError("thickness", f"{self.thickness:g} m", "must be > 0", "give it in metres")


class ThinPlates:
    """Plates of one layer or several.

    Parameters
    ----------
    nodes : (n_nodes, 4, 3) r [m], r_1, r_2 [-], r_12 [1/m] of the reference, free of stress
    plates : (n, 4) nodes (i, j) of each plate at 2 i + j
    sizes : (n, 2) lengths of each plate's parameters [m]
    layers : of each plate, bonded to one another; one entry serves all plates
    membrane_points, bending_points : Gauss points along both axes; two of the membrane strain along the one a strip is
        curved along, four along the other, or motions within the surface lose their stiffness

    A layer at height z has the strain E - z K of its middle and the area (1 - z B_a^a + z^2 det B) dA.

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
        layers: Sequence[Sequence[Layer]],
        membrane_points: tuple[int, int] = (2, 4),
        bending_points: tuple[int, int] = (3, 3),
    ) -> None:
        if nodes.ndim != 3 or nodes.shape[1:] != (4, 3) or plates.shape != (len(sizes), 4):
            shapes = f"nodes {nodes.shape}, plates {plates.shape}, sizes {sizes.shape}"
            raise InputError("thin plates", shapes, "must be (n, 4, 3), (m, 4) and (m, 2)", "see the docstring")
        if len(layers) not in (1, len(plates)) or not all(layers):
            counts = f"{len(layers)} for {len(plates)} plates"
            raise InputError("layers", counts, "must be one or more of each plate", "give one entry, or one a plate")
        self.reference, self.plates, self.sizes = nodes.copy(), plates.astype(np.int64), sizes
        self.layers = [tuple(each) for each in layers] if len(layers) > 1 else [tuple(layers[0])] * len(plates)
        fields = {counts: self._fields(counts) for counts in (membrane_points, bending_points, _FULL)}
        _require_along(*fields[bending_points][1:3], membrane_points)
        self._fields_of_mass = fields[_FULL]
        self._points: list[Points] = []
        for depth in range(max(len(each) for each in self.layers)):
            which = np.array([k for k, each in enumerate(self.layers) if len(each) > depth])
            of = [self.layers[k][depth] for k in which]
            held = np.array(
                [min(1.0, HELD * (layer.thickness / sizes[k].max()) ** 2) for k, layer in zip(which, of, strict=True)]
            )
            for raised in (False, True):
                chosen = np.array([(layer.height != 0.0) is raised for layer in of])
                if chosen.any():
                    given = which[chosen], [layer for layer, c in zip(of, chosen, strict=True) if c]
                    self._points.append(_layer_points(fields[membrane_points], *given, 1.0 - held[chosen]))
                    self._points.append(_layer_points(fields[_FULL], *given, held[chosen]))
            self._points.append(_layer_points(fields[bending_points], which, of, None))
        numbers = (_COORDINATES * self.plates[:, :, None] + np.arange(_COORDINATES)).reshape(len(plates), -1)
        self.numbers = numbers

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.reference.size

    def energy(self, q: Array) -> float:
        """Strain energy at nodes q (n_nodes, 4, 3) [J]."""
        return self._all(q, None, tangent=False)[0]

    def force(self, q: Array) -> Array:
        """Derivative of the energy by every coordinate, (n_nodes, 4, 3)."""
        return self.gathered(self._all(q, None, tangent=False)[1])

    def tangent(self, q: Array) -> csc_array:
        """Second derivatives of the energy, (n_nodes * 12, n_nodes * 12), symmetric."""
        return self.assembled(self._all(q, None, tangent=True)[2])

    def terms(self, q: Array, stresses: Sequence[Array]) -> tuple[float, Array, Array]:
        """Energy [J]; forces (n, 16, 3) and tangents (n, 16, 3, 16, 3) of plates, with stresses from `stresses`."""
        return self._all(q, stresses, tangent=True)

    def stresses(self, q: Array, step: Array) -> list[Array]:
        """Stresses for the tangent after a step (n_nodes, 4, 3) from q, extrapolated as `kernels.find_stress` does."""
        found = []
        for points in self._points:
            out = np.empty(points[2].shape)
            find_stress(q, step, self.plates, points, out)
            found.append(out)
        return found

    def mass(self) -> csc_array:
        """Consistent mass, the thickness' own inertia left out, (n_nodes * 12, n_nodes * 12)."""
        tables, metric, curvature, area = self._fields_of_mass
        weight = np.zeros_like(area)
        for depth in range(max(len(each) for each in self.layers)):
            which = np.array([k for k, each in enumerate(self.layers) if len(each) > depth])
            of = [self.layers[k][depth] for k in which]
            mass = np.array([layer.material.density * layer.thickness for layer in of])
            ratio = _area_ratio(metric[which], curvature[which], np.array([layer.height for layer in of]))
            weight[which] += mass[:, None] * ratio * area[which]
        one = np.einsum("ep,epk,epl->ekl", weight, tables[:, :, 0], tables[:, :, 0])
        return self.assembled(np.einsum("ekl,ij->ekilj", one, np.eye(3)))

    def gathered(self, local: Array) -> Array:
        """Sum over plates of (n, 16, 3), at the nodes (n_nodes, 4, 3)."""
        total = np.bincount(self.numbers.ravel(), weights=local.ravel(), minlength=self.size)
        return total.reshape(self.reference.shape)

    def assembled(self, blocks: Array) -> csc_array:
        """Sum over plates of (n, 16, 3, 16, 3)."""
        count = self.numbers.shape[1]
        rows, columns = np.repeat(self.numbers, count, axis=1).ravel(), np.tile(self.numbers, (1, count)).ravel()
        return csc_array(coo_array((blocks.ravel(), (rows, columns)), shape=(self.size, self.size)))

    def _all(self, q: Array, mixed: Sequence[Array] | None, *, tangent: bool) -> tuple[float, Array, Array]:
        n = len(self.plates)
        force = np.zeros((n, 16, 3))
        blocks = np.zeros((n if tangent else 0, 16, 3, 16, 3))
        energy, none = 0.0, np.empty((0, 0, 3))
        for k, points in enumerate(self._points):
            energy += add_terms(q, self.plates, points, mixed[k] if mixed else none, force, blocks)
        return energy, force, blocks

    def _fields(self, counts: tuple[int, int]) -> _Fields:
        """Tables, metrics (A_11, A_22, 2 A_12), curvatures likewise, and areas of all plates' points."""
        (u, wu), (v, wv) = (np.polynomial.legendre.leggauss(n) for n in counts)
        at = np.stack(np.meshgrid(0.5 + 0.5 * u, 0.5 + 0.5 * v, indexing="ij"), axis=-1).reshape(-1, 2)
        weights = 0.25 * np.outer(wu, wv).ravel()
        tables = np.stack([shape_tables((float(a), float(b)), at[:, 0], at[:, 1]) for a, b in self.sizes])
        local = self.reference[self.plates].reshape(len(self.plates), 16, 3)
        parts = np.einsum("epdk,eki->epdi", tables, local)
        a1, a2 = parts[:, :, 1], parts[:, :, 2]
        normal = np.cross(a1, a2)
        ratio = np.linalg.norm(normal, axis=-1)
        if not (ratio > 0.0).all():
            rule, hint = "must have a normal everywhere", "give slopes along both axes"
            raise InputError("thin plates", "r_1 x r_2 = 0", rule, hint)
        normal /= ratio[..., None]
        metric = np.stack([(a * b).sum(-1) for a, b in ((a1, a1), (a2, a2), (a1, 2.0 * a2))], axis=-1)
        second = np.stack([parts[:, :, 3], parts[:, :, 5], 2.0 * parts[:, :, 4]], axis=-2)
        curvature = np.einsum("epki,epi->epk", second, normal)
        return tables, metric, curvature, ratio * weights * (self.sizes[:, 0] * self.sizes[:, 1])[:, None]


def _layer_points(fields: _Fields, which: Index, layers: Sequence[Layer], share: Array | None) -> Points:
    """Points of a layer of each plate in ``which``: of E - z K with a share of each, or (None) of its own bending."""
    tables, metric, curvature, area = (f[which] for f in fields)
    z, t = (np.array([getattr(layer, name) for layer in layers]) for name in ("height", "thickness"))
    beta, size = (-z, t * share) if share is not None else (np.ones(len(t)), t**3 / 12.0)
    stretch = (share is not None) * np.eye(3) - beta[:, None, None, None] * _coupling(metric, curvature)
    find = _elasticity if share is not None else _bending_elasticity
    elastic = np.stack([find(layer, one) for layer, one in zip(layers, metric, strict=True)])
    weight = size[:, None] * area * _area_ratio(metric, curvature, z)
    return which, tables, metric, curvature, stretch, beta, weight[..., None, None] * elastic


def _area_ratio(metric: Array, curvature: Array, height: Array) -> Array:
    """Area at a height (n,) over that of the surface, (n, p)."""
    A, B = _square(metric), _square(curvature)
    shape = np.linalg.solve(A, B)
    z = height[:, None]
    return np.asarray(1.0 - z * np.trace(shape, axis1=-2, axis2=-1) + z**2 * np.linalg.det(shape))


def _bending_elasticity(layer: Layer, metric: Array) -> Array:
    """As `_elasticity` times 12 / t^3 of rigidities; of a rib with its foot's, and with a rod's against twist."""
    elastic, A = _elasticity(layer, metric), np.linalg.inv(_square(metric))
    if layer.rib > 0.0:
        shear = layer.material.young_modulus / (2.0 * (1.0 + layer.material.poisson_ratio))
        rod = _torsion_constant(layer.rib, layer.thickness)
        elastic[..., 0, 0] = 12.0 * layer.foot / layer.thickness**3 * A[..., 0, 0] ** 2
        elastic[..., 2, 2] = 3.0 * shear * rod / (layer.rib * layer.thickness**3) * A[..., 0, 0] * A[..., 1, 1]
    return elastic


def _torsion_constant(width: float, height: float) -> float:
    """Of a rectangle, within 4 % [m^4] (Roark's Formulas for Stress and Strain, from memory)."""
    a, b = max(width, height), min(width, height)
    return a * b**3 * (1.0 / 3.0 - 0.21 * b / a * (1.0 - b**4 / (12.0 * a**4)))


def _elasticity(layer: Layer, metric: Array) -> Array:
    """Tensor by (11, 22, 12) in contravariant components, (..., 3, 3) [Pa]: plane stress, or a rib's own axis alone."""
    material = layer.material
    nu, A = material.poisson_ratio, np.linalg.inv(_square(metric))
    if layer.rib > 0.0:
        along = np.zeros((*metric.shape[:-1], 3, 3))
        along[..., 1, 1] = material.young_modulus * A[..., 1, 1] ** 2
        return along
    pairs = ((0, 0), (1, 1), (0, 1))
    rows = [
        [
            nu * A[..., a, b] * A[..., c, d]
            + 0.5 * (1.0 - nu) * (A[..., a, c] * A[..., b, d] + A[..., a, d] * A[..., b, c])
            for c, d in pairs
        ]
        for a, b in pairs
    ]
    full = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    return np.asarray(material.young_modulus / (1.0 - nu**2) * full)


def _require_along(metric: Array, curvature: Array, points: tuple[int, int]) -> None:
    """Refuse a reference that is curved more along the axis with more points of the membrane strain."""
    along, across = (float(np.abs(curvature[..., k] / metric[..., k]).max()) for k in (0, 1))
    if (points[0] < points[1] and across > along + FLAT) or (points[0] > points[1] and along > across + FLAT):
        rule = f"has curvatures of {along:.3g} and {across:.3g} 1/m and membrane points of {points[0]} and {points[1]}"
        hint = "give fewer points along the axis that is curved more, or turn the plates"
        raise InputError("thin plates", "the reference", rule, hint)


def _square(three: Array) -> Array:
    """Symmetric matrices (..., 2, 2) of their entries 11, 22 and 2 x 12, (..., 3)."""
    half = 0.5 * three[..., 2]
    return np.stack([three[..., 0], half, half, three[..., 1]], axis=-1).reshape(*three.shape[:-1], 2, 2)


def _coupling(metric: Array, curvature: Array) -> Array:
    """What stretch alone adds to the curvatures (11, 22, 2 x 12), by E_11, E_22, 2 E_12, (..., 3, 3) [1/m].

    B_a^c E_cb + B_b^c E_ca: of r_,ab . n, what changes where lines are stretched and keep their curvature.
    """

    mixed = np.linalg.solve(_square(metric), _square(curvature))  # A^cd B_da
    columns = []
    for unit in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]):
        product = np.swapaxes(mixed, -1, -2) @ _square(np.array(unit))
        both = product + np.swapaxes(product, -1, -2)
        columns.append(np.stack([both[..., 0, 0], both[..., 1, 1], 2.0 * both[..., 0, 1]], axis=-1))
    return np.stack(columns, axis=-1)
