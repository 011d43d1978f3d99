"""Coordinates of small motions: what is held, what moves as one rigid hub, what mirrors about the middle plane.

The displacement is u = T q. Free unknowns have a coordinate each; nodes of a rigid hub share its six, translations and
turns about the origin; half a wheel moves evenly or oddly about its plane y = 0.
Verified by tests/verification/test_fe_wheel_vibration.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from contracts.modes import DIRECTIONS
from reference_fe import dolfinx_api as api
from reference_fe.problem.domain import Domain

__all__ = ["Coordinates", "Parity", "coordinates", "located_nodes", "rigid_vectors"]

Array = NDArray[np.float64]
_ROUND_OFF = 1e-12


class Parity(IntEnum):
    """How motions mirror about y = 0."""

    ODD = -1
    """u_x and u_z vanish on the plane: lateral motions, turns about x and z."""
    NONE = 0
    """A whole body: any motion."""
    EVEN = 1
    """u_y vanishes on the plane: motions in the plane of the wheel."""

    @property
    def fixed(self) -> tuple[int, ...]:
        """Components that vanish on the plane."""
        return {Parity.ODD: (0, 2), Parity.NONE: (), Parity.EVEN: (1,)}[self]

    @property
    def rigid(self) -> tuple[int, ...]:
        """Numbers in `DIRECTIONS` of rigid motions that mirror like this."""
        return {Parity.ODD: (1, 3, 5), Parity.NONE: tuple(range(len(DIRECTIONS))), Parity.EVEN: (0, 2, 4)}[self]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Coordinates:
    """Coordinates q of a body's small motions.

    Attributes
    ----------
    basis : T (n_dofs, n)
    rigid : (6, n_dofs) displacement of the unknowns under `DIRECTIONS` of rigid motion, at the body's present state
    directions : numbers of those that these coordinates share in
    loose : (k, n) coordinates of those that nothing holds
    """

    basis: csc_array
    rigid: Array
    directions: tuple[int, ...]
    loose: Array


def rigid_vectors(V: api.Expr, displacement: Array) -> Array:
    """Unknowns of unit translations and turns about the origin, of the body displaced by (n_dofs,) [m]; (6, n_dofs)."""
    found = np.zeros((6, len(displacement)))
    moved, one = displacement.reshape(-1, 3), api.fem.Function(V)
    for k, axis in enumerate(np.eye(3)):
        found[k] = np.tile(axis, len(moved))
        one.interpolate(lambda x, axis=axis: np.cross(axis, x.T).T)
        found[3 + k] = one.x.array + np.cross(axis, moved).ravel()
    return found


def located_nodes(domain: Domain, V: api.Expr, parts: Sequence[str], faces: Sequence[str]) -> NDArray[np.int64]:
    """Nodes of the displacement space in some parts and on some faces, ascending."""
    found = [np.zeros(0, dtype=np.int64)]
    for dim, entities in ((3, domain.cells_of(parts)), (2, domain.facets_of(faces))):
        domain.mesh.topology.create_connectivity(dim, 3)
        found.append(np.asarray(api.fem.locate_dofs_topological(V, dim, entities), dtype=np.int64))
    return np.unique(np.concatenate(found))


def coordinates(
    rigid: Array, *, held: NDArray[np.int64], hub: NDArray[np.int64], mirror: NDArray[np.int64], parity: Parity
) -> Coordinates:
    """Coordinates of a body.

    Parameters
    ----------
    rigid : (6, n_dofs) from `rigid_vectors`
    held : unknowns that do not move
    hub : nodes that move as one rigid body
    mirror : nodes on the plane of symmetry
    parity : of the motions
    """
    free = np.ones(rigid.shape[1], dtype=bool)
    free[held] = False
    on_hub = _unknowns(hub)
    free[on_hub] = False
    for component in parity.fixed:
        free[3 * mirror + component] = False
    own = np.flatnonzero(free)
    rows, columns, values = [own], [np.arange(len(own))], [np.ones(len(own))]
    shared = parity.rigid if len(hub) else ()
    for k, direction in enumerate(shared):
        rows.append(on_hub)
        columns.append(np.full(len(on_hub), len(own) + k))
        values.append(rigid[direction, on_hub])
    size = len(own) + len(shared)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    loose = [k for k in parity.rigid if np.abs(rigid[k, held]).max(initial=0.0) <= _ROUND_OFF * np.abs(rigid[k]).max()]
    of_loose = np.zeros((len(loose), size))
    of_loose[:, : len(own)] = rigid[np.ix_(loose, own)]
    for row, direction in enumerate(loose):
        of_loose[row, len(own) :] = [float(direction == other) for other in shared]
    return Coordinates(
        basis=csc_array(coo_array(entries, shape=(rigid.shape[1], size))),
        rigid=rigid,
        directions=parity.rigid,
        loose=of_loose,
    )


def _unknowns(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())
