"""Two surfaces that may touch: which points of the slave meet which facets of the master, and with what force.

Verified by tests/unit/test_fe_inner_contact.py and tests/verification/test_fe_touching_parts.py.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from reference_fe.contact.facet_kernels import shape_values
from reference_fe.contact.inner_kernels import contact_blocks, nearest_contacts
from reference_fe.contact.surface import ContactSurface
from reference_fe.contact.surface_term import SurfaceForces, WildIterateError, joined

__all__ = ["InnerLaw", "TwoSides", "as_set"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SKIN = 3e-3
"""How far a node may move before the facets near each other are looked up anew [m]."""
_WILD = 5.0
"""Size of a facet over the largest before, above which an iterate is no state of any body [-]."""


class InnerLaw(Protocol):
    """Penalty stiffness [N/m^3] and lengths [m], see `reference_fe.contact.inner.InnerContact`."""

    @property
    def stiffness(self) -> float: ...
    @property
    def ramp(self) -> float: ...
    @property
    def least_gap(self) -> float: ...
    @property
    def depth(self) -> float: ...
    @property
    def reach(self) -> float: ...
    @property
    def overhang(self) -> float: ...


class TwoSides:
    """One pair of surfaces: search, law, blocks, for a share of the slave's facets."""

    def __init__(self, slave: ContactSurface, master: ContactSurface, X: Array, law: InnerLaw, share: slice) -> None:
        self.shared = _share_nodes(master)[share] if slave is master else None
        self.overhang = _overhang(slave, master, X, law.overhang)
        slave = replace(slave, facets=slave.facets[share], sides=slave.sides[share], widths=slave.widths[share])
        self.slave, self.master, self.law = slave, master, law
        _, _, areas = slave.frames(X)
        self.areas = areas * slave.weights * slave.widths[:, None]
        self.shape = shape_values(slave.lattice, slave.at)
        self._largest = _WILD * float(_balls(X, master.facets)[1].max(initial=0.0))
        self.known, self.touching = set[tuple[int, int]](), np.zeros((0, 2), dtype=np.int64)
        self.largest_penetration = 0.0
        self._near: tuple[Array, Index, tuple[Index, Index]] | None = None
        gap = self._nearest(X, law.least_gap, 0.0)[2]
        self.excluded = gap < law.least_gap

    def pairs(self) -> Index:
        """Pairs of facets in the pattern, (n, 2), ascending."""
        return np.array(sorted(self.known), dtype=np.int64).reshape(-1, 2)

    def couplings(self) -> Index:
        pairs = self.pairs()
        return np.hstack([self.slave.facets[pairs[:, 0]], self.master.facets[pairs[:, 1]]])

    def has_new_pairs(self) -> bool:
        return not as_set(self.touching) <= self.known

    def note_near(self, x: Array) -> None:
        """Take the pairs that touch or nearly do at the positions x (n_nodes, 3) [m] into the pattern."""
        facet, _, _ = self._nearest(x, self.law.reach, 0.2)
        rows, points = np.nonzero(facet >= 0)
        self.known |= as_set(np.column_stack([rows, facet[rows, points]])) | as_set(self.touching)

    def blocks(self, x: Array, dim: int) -> SurfaceForces:
        law = self.law
        facet, xi, gap = self._nearest(x, law.ramp, 1e-3)
        gap[self.excluded] = np.inf
        f, q = np.nonzero(gap < law.ramp)
        if not len(f):
            self.touching, self.largest_penetration = np.zeros((0, 2), dtype=np.int64), 0.0
            return joined([], dim)
        m, g = facet[f, q], gap[f, q]
        self.touching = np.unique(np.column_stack([f, m]), axis=0)
        self.largest_penetration = float(np.max(-g, initial=0.0))
        nodes = np.hstack([self.slave.facets[f], self.master.facets[m]])
        k = nodes.shape[1]
        force, stiffness = np.empty((len(f), k, dim)), np.empty((len(f), k, dim, k, dim))
        contact_blocks(
            x,
            (self.slave.facets[f], self.shape[q]),
            (self.master.facets[m], self.master.sides[m], self.master.lattice),
            np.ascontiguousarray(xi[f, q]),
            np.column_stack([g, self.areas[f, q]]),
            (law.stiffness, law.ramp),
            (force, stiffness),
        )
        return SurfaceForces(nodes=nodes, force=force, stiffness=stiffness)

    def _nearest(self, x: Array, above: float, margin: float) -> tuple[Index, Array, Array]:
        """Contacts of every slave point among the facets that are near."""
        slave, master = self.slave, self.master
        facet, xi, gap = _no_contacts(self.areas.shape)
        rows, candidates = self._candidates(x)
        if len(rows):
            positions, normals, _ = slave.frames(x, rows)
            mid_m, radius_m = _balls(x, master.facets)
            facet[rows], xi[rows], gap[rows] = nearest_contacts(
                x,
                positions,
                normals,
                candidates,
                (master.facets, master.sides, master.lattice),
                (mid_m, radius_m, master.middle_normals(x)),
                (above, self.law.depth),
                np.maximum(self.overhang, margin),
            )
        return facet, xi, gap

    def _candidates(self, x: Array) -> tuple[Index, tuple[Index, Index]]:
        """Slave facets with masters near, and those: row starts and facets; looked up anew where nodes moved far.

        Around each slave facet's middle; with room for nodes that move by `_SKIN`, so that the answer stays whole until
        one does (Verlet's list).
        """
        if self._near is None or np.abs(x - self._near[0]).max() > _SKIN / math.sqrt(3.0):
            mid_s, radius_s = _balls(x, self.slave.facets)
            mid_m, radius_m = _balls(x, self.master.facets)
            if not radius_m.max(initial=0.0) <= self._largest:
                raise WildIterateError("an iterate stretches a facet that may touch to more than five times its size")
            far = max(self.law.depth, self.law.reach) + radius_m.max(initial=0.0) + 2.0 * _SKIN
            found = cKDTree(mid_m).query_ball_point(mid_s, radius_s + far, return_sorted=True)
            kept = [
                c if self.shared is None else [m for m in c if m not in self.shared[f]] for f, c in enumerate(found)
            ]
            rows = np.array([f for f, c in enumerate(kept) if c], dtype=np.int64)
            lists = [kept[f] for f in rows]
            starts = np.cumsum([0, *map(len, lists)])
            self._near = x.copy(), rows, (starts, np.array([m for c in lists for m in c], dtype=np.int64))
        return self._near[1], self._near[2]


def _no_contacts(shape: tuple[int, ...]) -> tuple[Index, Array, Array]:
    """What the search finds where there is nothing near."""
    return np.full(shape, -1, dtype=np.int64), np.zeros((*shape, 2)), np.full(shape, np.inf)


def as_set(pairs: Index) -> set[tuple[int, int]]:
    return {(int(f), int(m)) for f, m in pairs}


def _balls(x: Array, facets: Index) -> tuple[Array, Array]:
    """Middles (f, 3) and radii (f,) of balls around the facets' nodes [m]."""
    nodes = x[facets]
    middle = nodes.mean(axis=1)
    return middle, np.linalg.norm(nodes - middle[:, None], axis=-1).max(axis=1)


def _share_nodes(surface: ContactSurface) -> list[set[int]]:
    """Facets that share a node with each facet of one surface."""
    holders: dict[int, set[int]] = {}
    for m, nodes in enumerate(surface.facets.tolist()):
        for node in nodes:
            holders.setdefault(node, set()).add(m)
    return [set().union(*(holders[node] for node in nodes)) for nodes in surface.facets.tolist()]


def _overhang(slave: ContactSurface, master: ContactSurface, X: Array, length: float) -> Array:
    """``length`` [m] beyond the edges of master facets that the slave's surface has too, in local coordinates, (m, 4).

    Edges xi_1 = -1, +1, xi_2 = -1, +1; zero at the others, and everywhere where both surfaces are one.
    """
    out = np.zeros((len(master.facets), 4))
    if slave is master:
        return out
    grid = master.facets.reshape(-1, *master.lattice)
    shared = np.isin(grid, slave.facets)
    for axis in (0, 1) if master.lattice[1] > 1 else (0,):
        first, last = grid.take(0, axis=1 + axis), grid.take(-1, axis=1 + axis)
        half = 0.5 * np.linalg.norm(X[last] - X[first], axis=-1).mean(axis=1)
        for k, end in enumerate((0, -1)):
            junction = np.all(shared.take(end, axis=1 + axis), axis=1)
            out[junction, 2 * axis + k] = length / half[junction]
    return out
