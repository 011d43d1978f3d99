"""What a static problem asks of forces that act on the body's surface and depend on its displacement: contact.

Verified by tests/unit/test_fe_surface_assembly.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.errors import WorkbenchError
from reference_fe.dolfinx_api import Expr
from reference_fe.problem.domain import Domain

__all__ = ["SurfaceDescription", "SurfaceForces", "SurfaceTerm", "TermState", "WildIterateError", "joined"]

type TermState = Mapping[str, NDArray[np.float64]]
"""History of a term by name: committed slip, multipliers; empty where there is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceForces:
    """Forces on groups of nodes, and their stiffness, as a batch of dense blocks.

    Attributes
    ----------
    nodes : (m, k) int64, node numbers of the displacement space, local to this process; -1 fills up short groups
    force : (m, k, dim) float [N], force on the body
    stiffness : (m, k, dim, k, dim) float [N/m], minus the derivative of ``force`` by the nodes' displacement
    """

    nodes: NDArray[np.int64]
    force: NDArray[np.float64]
    stiffness: NDArray[np.float64]


def joined(batches: Sequence[SurfaceForces], dim: int) -> SurfaceForces:
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


class WildIterateError(WorkbenchError):
    """An iterate so far from balance that contact cannot be looked up in it: its pairs would fill the memory."""


class SurfaceTerm(Protocol):
    """One contact while it is being solved. History changes in `accept` and `augment` only.

    On several processes a term sees its own process' facets and numbers its nodes likewise; `resultant` sums over the
    processes. A term with an attribute ``whole_body`` that is true is evaluated whole by each, see `whole_body`.
    """

    @property
    def pattern_version(self) -> int:
        """Changes whenever `couplings` does; the matrix is then laid out anew."""

    def couplings(self) -> NDArray[np.int64]:
        """Groups of nodes whose blocks may be filled, (m, k); -1 fills up short groups."""

    def set_control(self, control: float) -> None:
        """Set the control parameter: rise of an obstacle [m], load factor [-]."""

    def evaluate(self, u: NDArray[np.float64], lag: float) -> SurfaceForces:
        """Forces at displacement u (n_dofs,) [m]; with a lag [m] their tangent line, see `contact.law`."""

    def resultant(self) -> NDArray[np.float64]:
        """Sum of the outer forces on the body at the last evaluation, (dim,) [N]; zero for contact inside the body."""

    def augment(self) -> bool:
        """After Newton has converged: improve the multipliers; True if the state must be solved again."""

    def accept(self) -> None:
        """The increment is accepted: the present history becomes the committed one."""

    def state(self) -> TermState:
        """Committed history, for cut-backs and checkpoints."""

    def restore(self, state: TermState) -> None:
        """Go back to a committed history."""


class SurfaceDescription(Protocol):
    """A contact as data, before there is a mesh in DOLFINx."""

    def build(self, domain: Domain, V: Expr) -> SurfaceTerm:
        """The term on this mesh and displacement space."""
