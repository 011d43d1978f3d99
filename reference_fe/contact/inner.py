"""Frictionless contact between parts of the deforming body: springs against rim, hub and each other.

Points on the slave faces are held off the master faces along the master's normal at the closest point (points to
surface, Gauss points of the slave's undeformed facets). The penalty law is that of `contact.law` with the normal gap to
the master, so that the contact has a potential and a symmetric stiffness. docs/theory.md 2.4 has the equations.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.contact.inner_kernels import contact_blocks, nearest_contacts, shape_values
from reference_fe.contact.surface import ContactSurface, contact_surface, node_positions
from reference_fe.contact.surface_term import SurfaceForces, TermState
from reference_fe.problem.domain import Domain

__all__ = ["ContactPair", "InnerContact", "InnerContactTerm"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactPair:
    """Two face groups that may touch; they may be one and the same (self-contact).

    Attributes
    ----------
    slave : face group whose points are held off
    master : face group they are held off from
    across : parts of a planar mesh whose joints with the master's part count as its surface, see `contact_surface`
    """

    slave: str
    master: str
    across: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class InnerContact:
    """Penalty contact between face groups of one mesh.

    Attributes
    ----------
    pairs : what may touch what
    stiffness : penalty stiffness per undeformed area of the slave [N/m^3]
    ramp : gap at which the pressure begins, and beyond which (negative) it is linear [m]
    least_gap : points that start closer to the master than this are left out, e.g. beside a weld [m]
    depth : how far behind the master's surface a point is still found [m]
    reach : gap below which facets get room in the matrix before they touch [m]
    overhang : how far a master facet goes on, straight, beyond an edge it shares with the slave's surface [m]: where a
        spring is welded to a rim, the rim's face goes on within the weld, and no point can slip off its end
    gauss_points : slave points along each axis of a facet
    """

    pairs: tuple[ContactPair, ...]
    stiffness: float
    ramp: float = 5e-6
    least_gap: float = 10e-6
    depth: float = 5e-3
    reach: float = 1.5e-3
    overhang: float = 1e-3
    gauss_points: int = 5

    def __post_init__(self) -> None:
        if not (np.isfinite(self.stiffness) and self.stiffness > 0.0):
            raise InputError("inner contact stiffness", f"{self.stiffness:g} N/m^3", "must be > 0", "1e11 suits metal")
        if not 0.0 < self.ramp <= self.least_gap < self.reach:
            lengths = f"{self.ramp:g}, {self.least_gap:g}, {self.reach:g} m"
            raise InputError("ramp, least gap and reach", lengths, "must be > 0 and not fall", "keep the defaults")

    def build(self, domain: Domain, V: api.Expr) -> InnerContactTerm:
        """The term on this mesh and displacement space."""
        return InnerContactTerm(self, domain, V)


_SKIN = 3e-3
"""How far a node may move before the facets near each other are looked up anew [m]."""


class InnerContactTerm:
    """Inner contact while it is being solved; its only history is which facets have room in the matrix.

    Attributes
    ----------
    reference_positions : (n_nodes, 3) of the displacement space's nodes [m]
    pattern_version : changes when facets meet that had no room in the matrix
    largest_penetration : at the last evaluation [m]
    whole_body : its nodes have the numbers over all processes; each process searches for its share of the slave facets,
        and all hear of what was found

    Verified by tests/unit/test_fe_inner_contact.py and tests/verification/test_fe_touching_parts.py.
    """

    def __init__(self, description: InnerContact, domain: Domain, V: api.Expr) -> None:
        self._law, self._dim = description, int(V.dofmap.index_map_bs)
        self._comm = domain.mesh.comm
        self.whole_body = self._comm.size > 1
        self.reference_positions = node_positions(domain, V)
        wanted = {(p.slave, ()) for p in description.pairs} | {(p.master, p.across) for p in description.pairs}
        points = description.gauss_points
        made = {key: contact_surface(domain, V, key[0], points, key[1]) for key in sorted(wanted)}
        self._sides = [
            _TwoSides(
                made[pair.slave, ()],
                made[pair.master, pair.across],
                self.reference_positions,
                description,
                self._share(),
            )
            for pair in description.pairs
        ]
        self.pattern_version, self.largest_penetration = 0, 0.0
        for side in self._sides:
            side.note_near(self.reference_positions)

    def couplings(self) -> Index:
        """Nodes of every pair of facets that touches, or nearly did when the pattern was last laid out, (m, k)."""
        own = [side.couplings() for side in self._sides]
        groups = [group for share in self._of_all(own) for group in share]
        width = max((g.shape[1] for g in groups), default=0)
        out = np.full((sum(map(len, groups)), width), -1, dtype=np.int64)
        row = 0
        for group in groups:
            out[row : row + len(group), : group.shape[1]] = group
            row += len(group)
        return out

    def set_control(self, control: float) -> None:
        """Nothing: both sides belong to the body."""

    def evaluate(self, u: Array, lag: float) -> SurfaceForces:
        """Forces at u (n_nodes * dim,) [m]; no lag, as both sides stand still between two increments."""
        x = self.reference_positions.copy()
        x[:, : self._dim] += u.reshape(-1, self._dim)
        batches = [side.blocks(x, self._dim) for side in self._sides]
        if any(self._of_all(any(side.has_new_pairs() for side in self._sides))):
            for side in self._sides:
                side.note_near(x)
            self.pattern_version += 1
        deepest = max((side.largest_penetration for side in self._sides), default=0.0)
        self.largest_penetration = float(max(self._of_all(deepest)))
        return _joined([batch for share in self._of_all(batches) for batch in share if len(batch.nodes)], self._dim)

    def _share(self) -> slice:
        """This process' slave facets."""
        return slice(self._comm.rank, None, self._comm.size)

    def _of_all[T](self, mine: T) -> list[T]:
        """The value of every process."""
        return [mine] if self._comm.size == 1 else self._comm.allgather(mine)

    def resultant(self) -> Array:
        """Zero, (dim,) [N]: action is reaction."""
        return np.zeros(self._dim)

    def augment(self) -> bool:
        """Penalty only."""
        return False

    def accept(self) -> None:
        """Nothing to commit: a pair once in the pattern stays there."""

    def state(self) -> TermState:
        """Pairs of facets in the pattern, so that a resumed run eliminates and adds up in the same order."""
        return {f"pairs_{k}": side.pairs().astype(np.float64) for k, side in enumerate(self._sides)}

    def restore(self, state: TermState) -> None:
        """Go back to a pattern."""
        for k, side in enumerate(self._sides):
            known = _as_set(state[f"pairs_{k}"].astype(np.int64))
            if known != side.known:
                side.known, self.pattern_version = known, self.pattern_version + 1


class _TwoSides:
    """One pair of surfaces: search, law, blocks, for a share of the slave's facets."""

    def __init__(
        self, slave: ContactSurface, master: ContactSurface, X: Array, law: InnerContact, share: slice
    ) -> None:
        self.shared = _share_nodes(master)[share] if slave is master else None
        self.overhang = _overhang(slave, master, X, law.overhang)
        slave = replace(slave, facets=slave.facets[share], sides=slave.sides[share], widths=slave.widths[share])
        self.slave, self.master, self.law = slave, master, law
        _, _, areas = slave.frames(X)
        self.areas = areas * slave.weights * slave.widths[:, None]
        self.shape = shape_values(slave.lattice, slave.at)
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
        return not _as_set(self.touching) <= self.known

    def note_near(self, x: Array) -> None:
        """Take the pairs that touch or nearly do at the positions x (n_nodes, 3) [m] into the pattern."""
        facet, _, _ = self._nearest(x, self.law.reach, 0.2)
        rows, points = np.nonzero(facet >= 0)
        self.known |= _as_set(np.column_stack([rows, facet[rows, points]])) | _as_set(self.touching)

    def blocks(self, x: Array, dim: int) -> SurfaceForces:
        law = self.law
        facet, xi, gap = self._nearest(x, law.ramp, 1e-3)
        gap[self.excluded] = np.inf
        f, q = np.nonzero(gap < law.ramp)
        if not len(f):
            self.touching, self.largest_penetration = np.zeros((0, 2), dtype=np.int64), 0.0
            return _joined([], dim)
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


def _as_set(pairs: Index) -> set[tuple[int, int]]:
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


def _joined(batches: Sequence[SurfaceForces], dim: int) -> SurfaceForces:
    """One batch of several; all facets of a mesh have the same number of nodes."""
    if not batches:
        return SurfaceForces(
            nodes=np.zeros((0, 0), dtype=np.int64),
            force=np.zeros((0, 0, dim)),
            stiffness=np.zeros((0, 0, dim, 0, dim)),
        )
    return SurfaceForces(
        nodes=np.concatenate([b.nodes for b in batches]),
        force=np.concatenate([b.force for b in batches]),
        stiffness=np.concatenate([b.stiffness for b in batches]),
    )
