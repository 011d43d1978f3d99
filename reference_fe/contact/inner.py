"""Frictionless contact between parts of the deforming body: springs against rim, hub and each other.

Points on the slave faces are held off the master faces along the master's normal at the closest point (points to
surface, Gauss points of the slave's undeformed facets). The penalty law is that of `contact.law` with the normal gap to
the master, so that the contact has a potential and a symmetric stiffness. docs/theory.md 2.4 has the equations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.contact.surface import contact_surface, node_positions
from reference_fe.contact.surface_term import SurfaceForces, TermState, joined
from reference_fe.contact.two_sides import TwoSides, as_set
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
    overhang : how far a master facet goes on, as its shape functions do, beyond an edge it shares with the slave's
        surface [m]: where a spring is welded to a rim, its face goes on within the weld, and no point can slip off
        its end
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
            TwoSides(
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
        return joined([batch for share in self._of_all(batches) for batch in share if len(batch.nodes)], self._dim)

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
            known = as_set(state[f"pairs_{k}"].astype(np.int64))
            if known != side.known:
                side.known, self.pattern_version = known, self.pattern_version + 1
