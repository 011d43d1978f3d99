"""Adds the surface terms of a problem to its residual and its matrix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.cells.block_matrix import BlockRows, add_block, place_of
from reference_fe.compiled import compiled
from reference_fe.contact.surface_term import SurfaceForces, SurfaceTerm, TermState
from reference_fe.contact.whole_body import WholeBody
from reference_fe.solver import process_sums

__all__ = ["SurfaceAssembly", "SurfaceStiffness"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceStiffness:
    """Stiffness of all surface terms at one evaluation.

    Attributes
    ----------
    local : blocks of this process' facets
    whole : blocks of terms of the whole body, the same on every process
    """

    local: tuple[SurfaceForces, ...]
    whole: tuple[SurfaceForces, ...]


class SurfaceAssembly:
    """All surface terms of one problem.

    Parameters
    ----------
    terms : the terms, in a fixed order
    V : displacement space

    Attributes
    ----------
    terms, dim : the terms, dimension of space

    Verified by tests/unit/test_fe_surface_assembly.py.
    """

    def __init__(self, terms: Sequence[SurfaceTerm], V: api.Expr) -> None:
        self.terms, self.dim = tuple(terms), int(V.dofmap.index_map_bs)
        self._whole_terms = [t for t in self.terms if getattr(t, "whole_body", False)]
        self._local_terms = [t for t in self.terms if t not in self._whole_terms]
        self.whole = WholeBody(V) if self._whole_terms else None
        self._forces, self._direction = api.fem.Function(V), api.fem.Function(V)
        self._batches: tuple[SurfaceForces, ...] = ()

    @property
    def pattern_version(self) -> tuple[int, ...]:
        """Changes when any term couples other nodes than before."""
        return tuple(term.pattern_version for term in self.terms)

    @property
    def symmetric(self) -> bool:
        """Whether the stiffness of every term is symmetric; a term without the attribute ``symmetric`` says so."""
        return all(getattr(term, "symmetric", True) for term in self.terms)

    def couplings(self) -> list[NDArray[np.int32]]:
        """Groups of nodes (k,) that a term may couple, in this process' numbers; without terms of the whole body."""
        return [group[group >= 0].astype(np.int32) for term in self._local_terms for group in term.couplings()]

    def whole_couplings(self) -> list[NDArray[np.int64]]:
        """Groups of nodes (m, k) that each term of the whole body may couple, in numbers over all processes."""
        return [term.couplings() for term in self._whole_terms]

    def set_control(self, control: float) -> None:
        """Set every term's control parameter: rise of an obstacle [m], load factor [-]."""
        for term in self.terms:
            term.set_control(control)

    def force(self, u: NDArray[np.float64], lag: float) -> NDArray[np.float64]:
        """Force on the body at every own unknown, (n_own_dofs,) [N]; keeps the blocks for the matrix."""
        self._batches = tuple(term.evaluate(u, lag) for term in self._local_terms)
        total = self._forces.x.array
        total[:] = 0.0
        for batch in self._batches:
            _add_forces(batch.nodes, batch.force, total)
        force = process_sums.sum_shared(self._forces)
        if self.whole is not None:
            everywhere = self.whole.gathered(u)
            force += self.whole.own_force([term.evaluate(everywhere, lag) for term in self._whole_terms])
        return force

    def stiffness(self) -> SurfaceStiffness:
        """Stiffness at the last evaluation; stays what it is when the terms are evaluated again."""
        return SurfaceStiffness(local=self._batches, whole=() if self.whole is None else self.whole.batches)

    def product(self, stiffness: SurfaceStiffness, direction: NDArray[np.float64]) -> NDArray[np.float64]:
        """Stiffness times a displacement, (n_own_dofs,) [N], for one at the own unknowns [m]; no support is known."""
        x, total = self._direction.x, self._forces.x.array
        x.array[: len(direction)] = direction
        x.scatter_forward()
        total[:] = 0.0
        for batch in stiffness.local:
            _add_products(batch.nodes, batch.stiffness, x.array, total)
        product = process_sums.sum_shared(self._forces)
        if self.whole is not None:
            product += self.whole.own_product(stiffness.whole, self.whole.gathered(x.array))
        return product

    def add_to_rows(self, rows: BlockRows, values: NDArray[np.float64]) -> None:
        """Add the stiffness of the last evaluation [N/m] to the values of a matrix that has room for it.

        rows : over all nodes this process knows
        """
        for batch in self._batches:
            _add_blocks(batch.nodes, batch.stiffness, rows, values)

    def add_to_matrix(self, matrix: api.PETSc.Mat, supported: NDArray[np.int32]) -> None:
        """Add the stiffness of the last evaluation [N/m] to a PETSc matrix, not at the unknowns ``supported`` (n,).

        Raises
        ------
        InputError
            For terms of the whole body, which only compiled cells can take.
        """
        if self.whole is not None:
            rule = "needs the compiled cells (St. Venant-Kirchhoff, three dimensions)"
            raise InputError("contact between parts", f"{api.COMM.size} processes", rule, "use one process")
        free = np.ones(len(self._forces.x.array))
        free[supported] = 0.0
        for batch in self._batches:
            for nodes, stiffness in zip(batch.nodes, batch.stiffness, strict=True):
                here = np.flatnonzero(nodes >= 0)
                rows = (self.dim * nodes[here, None] + np.arange(self.dim)).ravel().astype(np.int32)
                block = stiffness[here][:, :, here].reshape(len(rows), len(rows))
                api.add_block(matrix, rows, free[rows, None] * block * free[rows])

    def resultant(self) -> NDArray[np.float64]:
        """Sum of all outer surface forces on the body at the last evaluation, (dim,) [N]."""
        return np.asarray(sum((term.resultant() for term in self.terms), np.zeros(self.dim)))

    def augment(self) -> bool:
        """Let every term improve its multipliers; True if any asks for another solve."""
        asked = [term.augment() for term in self.terms]
        return any(asked)

    def accept(self) -> None:
        """Commit every term's history."""
        for term in self.terms:
            term.accept()

    def state(self) -> tuple[TermState, ...]:
        """Committed history of every term."""
        return tuple(term.state() for term in self.terms)

    def restore(self, states: Sequence[TermState]) -> None:
        """Go back to a committed history."""
        for term, state in zip(self.terms, states, strict=True):
            term.restore(state)


@compiled()
def _add_forces(nodes: NDArray[np.int64], force: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    dim = force.shape[2]
    for m in range(nodes.shape[0]):
        for a in range(nodes.shape[1]):
            if nodes[m, a] >= 0:
                for i in range(dim):
                    out[dim * nodes[m, a] + i] += force[m, a, i]


@compiled()
def _add_products(
    nodes: NDArray[np.int64], stiffness: NDArray[np.float64], x: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    dim = stiffness.shape[2]
    for m in range(nodes.shape[0]):
        for a in range(nodes.shape[1]):
            for b in range(nodes.shape[1]):
                if nodes[m, a] < 0 or nodes[m, b] < 0:
                    continue
                for i in range(dim):
                    for j in range(dim):
                        out[dim * nodes[m, a] + i] += stiffness[m, a, i, b, j] * x[dim * nodes[m, b] + j]


@compiled()
def _add_blocks(
    nodes: NDArray[np.int64], stiffness: NDArray[np.float64], rows: BlockRows, values: NDArray[np.float64]
) -> None:
    for m in range(nodes.shape[0]):
        for a in range(nodes.shape[1]):
            for b in range(nodes.shape[1]):
                if nodes[m, a] < 0 or nodes[m, b] < 0 or (rows.upper == 1 and nodes[m, b] < nodes[m, a]):
                    continue
                add_block(rows, nodes[m, a], place_of(rows, nodes[m, a], nodes[m, b]), stiffness[m, a, :, b], values)
