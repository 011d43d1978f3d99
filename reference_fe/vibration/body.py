"""Natural modes of a static problem's body about its present state: free, held, or in contact and under load.

K is the tangent stiffness with the present stress, its geometric part included, and with the stiffness of the points
that touch at this state; M the consistent mass. Small motions leave the set of touching points as it is.
Equations: docs/theory/vibration.md. Verified by tests/verification/test_fe_vibration.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, eye_array, kron
from scipy.sparse.linalg import LinearOperator, cg

from contracts.errors import ConvergenceError, InputError
from contracts.modes import Modes
from reference_fe.contact.surface_term import SurfaceTerm
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.vibration.eigen import lowest_modes
from reference_fe.vibration.mass import consistent_mass, nodal_mass
from reference_fe.vibration.motions import Parity, coordinates, rigid_vectors

__all__ = ["Support", "gripping", "natural_modes", "stiffness"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_SLOW = 1e-2
"""Root of the shift's size, over the time of a wave through the body."""
_RIGID = 0.99
"""Share of a mode's energy in rigid motions from which it is one."""


def _none() -> Index:
    return np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Support:
    """What holds a body while it vibrates.

    Attributes
    ----------
    held : unknowns that do not move
    hub : nodes of the displacement space that move as one rigid body
    mirror : nodes on the plane of symmetry of half a body, whose mass and modes count twice
    """

    held: Index = field(default_factory=_none)
    hub: Index = field(default_factory=_none)
    mirror: Index = field(default_factory=_none)


def stiffness(problem: StaticProblem) -> csr_array:
    """Tangent at the present state without regard to supports, symmetric (n_dofs, n_dofs) [N/m].

    Stresses of its geometric part are those of the state, contacts those that touch there.
    """
    problem.residual()  # evaluates the contacts
    problem.store_stress(extrapolate=False)
    matrix = problem.unsupported_tangent()
    indptr, indices, data = matrix.getValuesCSR()
    half = 0.5 * np.asarray(data, dtype=np.float64)
    found = csr_array((half, indices.copy(), indptr.copy()), shape=matrix.getSize())
    matrix.destroy()
    return csr_array(found + found.T)


def gripping(problem: StaticProblem, term: SurfaceTerm) -> csr_array:
    """What a contact adds to the stiffness if points that touch stick as stiffly as they are held off.

    At each point k (I - n n^T) with the stiffness k n n^T that it has against the surface, which is flat;
    (n_dofs, n_dofs) [N/m].
    """
    batch = term.evaluate(problem.u.x.array, 0.0)
    whole = np.einsum("maibi->mab", batch.stiffness)
    blocks = np.einsum("mab,ij->maibj", whole, np.eye(3)) - batch.stiffness
    dofs = (3 * batch.nodes[:, :, None] + np.arange(3)).reshape(len(batch.nodes), -1)
    count = dofs.shape[1]
    rows, columns = np.repeat(dofs, count, axis=1).ravel(), np.tile(dofs, (1, count)).ravel()
    size = problem.own_dofs
    return csr_array(coo_array((blocks.ravel(), (rows, columns)), shape=(size, size)))


def natural_modes(
    problem: StaticProblem,
    densities: Mapping[str, float],
    support: Support,
    count: int,
    *,
    grips: SurfaceTerm | None = None,
) -> Modes:
    """The lowest modes about the problem's present state, besides those of a rigid body.

    Parameters
    ----------
    problem : at rest, on one process, three-dimensional
    densities : part -> density, of rigid parts too [kg/m^3]
    support : what holds it while it vibrates, whatever holds it in the problem
    count : of modes
    grips : the contact with flat ground whose touching points stick; without it they slide freely

    Raises
    ------
    InputError
        For a count that the mesh cannot have, friction in the problem's contacts, and as `consistent_mass` does.
    ConvergenceError
        If modes are not found, or more of them are without stiffness than a rigid body has.
    """
    if not problem.surfaces.symmetric:
        raise InputError("contact", "with friction", "has no symmetric stiffness", "leave friction away")
    mass = consistent_mass(problem.domain, problem.V, densities)
    K = stiffness(problem)
    if grips is not None:
        K = csr_array(K + gripping(problem, grips))
    whole = _Whole(problem, K, csr_array(kron(mass, eye_array(3))))
    parities = (Parity.EVEN, Parity.ODD) if len(support.mirror) else (Parity.NONE,)
    parts = [whole.modes(support, parity, count) for parity in parities]
    eigenvalue, shape, participation, rigid = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("eigenvalue", "shape", "participation", "rigid")
    )
    parity = np.concatenate([np.full(len(p.eigenvalue), int(q)) for p, q in zip(parts, parities, strict=True)])
    of_body = np.argmax(participation**2 / np.maximum(whole.whole, np.finfo(float).tiny), axis=1)
    order = np.lexsort((np.where(rigid, of_body, eigenvalue), ~rigid))[: int(rigid.sum()) + count]
    sides = float(len(parities))
    return Modes(
        eigenvalue=eigenvalue[order],
        shape=whole.nodal(shape[order]) / np.sqrt(sides),
        points=problem.domain.tagged.points,
        weight=nodal_mass(problem.domain, densities),
        participation=np.sqrt(sides) * participation[order],
        moving=sides * np.sum([part.moving for part in parts], axis=0),
        whole=sides * whole.whole,
        rigid=rigid[order],
        parity=parity[order],
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """Modes of one parity; names as in `Modes`, shapes (n, n_dofs)."""

    eigenvalue: Array
    shape: Array
    participation: Array
    rigid: NDArray[np.bool_]
    moving: Array


class _Whole:
    """Stiffness, mass and rigid motions of all unknowns."""

    def __init__(self, problem: StaticProblem, K: csr_array, M: csr_array) -> None:
        self._problem, self._K, self._M = problem, K, M
        self._rigid = rigid_vectors(problem.V, problem.u.x.array)
        self.whole = np.einsum("kn,kn->k", self._rigid, (self._M @ self._rigid.T).T)
        fastest = max(m.young_modulus / m.density for m in problem.materials.values())
        size = float(np.linalg.norm(np.ptp(problem.domain.tagged.points, axis=0)))
        self._shift = -(_SLOW**2) * fastest / size**2

    def modes(self, support: Support, parity: Parity, count: int) -> _Part:
        """The lowest modes that mirror in one way; those of a rigid body come first."""
        found = coordinates(self._rigid, held=support.held, hub=support.hub, mirror=support.mirror, parity=parity)
        T, loose = found.basis, len(found.loose)
        K, M = csr_array(T.T @ self._K @ T), csr_array(T.T @ self._M @ T)
        if not 0 < count < K.shape[0] - loose - 1:
            raise InputError("number of modes", count, f"must lie between 1 and {K.shape[0] - loose - 2}", "ask for 10")
        values, vectors = lowest_modes(K, M, count + loose, self._shift)
        values, vectors = _told_apart(values, vectors, M, found.loose)
        given = T.T @ (self._M @ self._rigid.T)
        participation, moving = np.zeros((len(values), 6)), np.zeros(6)
        for k in found.directions:
            participation[:, k] = vectors.T @ given[:, k]
            moving[k] = float(given[:, k] @ _mass_solve(M, given[:, k]))
        return _Part(values, (T @ vectors).T, participation, np.arange(len(values)) < loose, moving)

    def nodal(self, shapes: Array) -> Array:
        """Shapes (n, n_dofs) at the nodes of the mesh, (n, n_points, 3)."""
        u = self._problem.u.x.array
        kept = u.copy()
        found = []
        for shape in shapes:
            u[:] = shape
            found.append(self._problem.nodal_displacement())
        u[:] = kept
        return np.array(found)


def _told_apart(values: Array, vectors: Array, M: csr_array, loose: Array) -> tuple[Array, Array]:
    """Modes of a free body, the rigid ones first: translations along the axes, then turns about the centre of mass.

    What is found of them is a mixture of all of them, as they share their frequency. loose : (k, n), see `Coordinates`
    """
    if not len(loose):
        return values, vectors
    rigid = list[Array]()
    for motion in loose:
        for one in rigid:
            motion = motion - (one @ (M @ motion)) * one
        rigid.append(motion / np.sqrt(motion @ (M @ motion)))
    share = ((np.array(rigid) @ (M @ vectors)) ** 2).sum(axis=0)
    of_body = share > _RIGID
    if of_body.sum() != len(loose):
        told = f"{int(of_body.sum())} of {len(loose)} motions of a rigid body are among the modes"
        raise ConvergenceError(f"natural modes: {told}; look for a part that nothing holds", [])
    return (
        np.concatenate([values[of_body], values[~of_body]]),
        np.column_stack([*rigid, vectors[:, ~of_body]]),
    )


def _mass_solve(M: csr_array, right: Array) -> Array:
    """M^-1 times a vector by conjugate gradients."""
    if not right.any():
        return right
    diagonal = M.diagonal()
    operator = LinearOperator(M.shape, matvec=lambda x: x.ravel() / diagonal, dtype=np.float64)
    found, failed = cg(M, right, rtol=1e-10, maxiter=2000, M=operator)
    if failed:
        raise ConvergenceError("the moving mass is not found: its matrix is all but singular; look at the mesh", [])
    return np.asarray(found)
