"""Supports as Dirichlet conditions of DOLFINx."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import fem
from reference_fe.problem.domain import Domain
from reference_fe.problem.supports import Middle, Support

__all__ = ["Prescribed", "build_supports"]

type _Dofs = list[NDArray[np.int32]]
"""The same unknowns, numbered in the full space and in that of one component."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prescribed:
    """One component of a support.

    Attributes
    ----------
    function : holds the prescribed displacement [m]
    at_load_factor_1 : displacement at load factor 1 [m]
    expansion : (n,) thermal displacement at the function's points, there from the start [m]
    name : of the support
    dofs : (m,) unknowns it holds
    """

    function: api.Function
    at_load_factor_1: float
    expansion: NDArray[np.float64]
    name: str
    dofs: NDArray[np.int32]

    def set_control(self, control: float) -> None:
        """Set the displacement at a load factor [-]."""
        self.function.x.array[:] = control * self.at_load_factor_1 + self.expansion


def build_supports(
    domain: Domain, V: api.Expr, supports: Sequence[Support]
) -> tuple[list[api.DirichletBC], list[Prescribed]]:
    """Conditions, and what each of them prescribes."""
    conditions: list[api.DirichletBC] = []
    prescribed: list[Prescribed] = []
    for entity in range(domain.dim + 1):
        domain.mesh.topology.create_connectivity(entity, domain.dim)
    for support in supports:
        for position, component in enumerate(support.components):
            if component >= domain.dim:
                continue
            subspace, _ = V.sub(component).collapse()
            value = fem.Function(subspace)
            expansion = np.zeros_like(value.x.array)
            if support.stretch != 1.0:  # elements without nodal values, such as 20-node hexahedra, have no coordinates
                expansion += (support.stretch - 1.0) * subspace.tabulate_dof_coordinates()[:, component]
            at_load_factor_1 = support.value[position] if support.value else 0.0
            spaces = (V.sub(component), subspace)
            located = _located(domain, support, spaces)
            conditions += [fem.dirichletbc(value, dofs, spaces[0]) for dofs in located]
            held = Prescribed(
                function=value,
                at_load_factor_1=at_load_factor_1,
                expansion=expansion,
                name=support.name,
                dofs=np.unique(np.concatenate([dofs[0] for dofs in located] or [np.zeros(0, dtype=np.int32)])),
            )
            prescribed.append(held)
    return conditions, prescribed


def _located(domain: Domain, support: Support, spaces: tuple[api.Expr, api.Expr]) -> list[_Dofs]:
    """Unknowns of one component held by a support."""
    faces, cells = domain.facets_of(support.faces), domain.cells_of(support.parts)
    held = (domain.dim - 1, faces), (domain.dim, cells)
    located = [fem.locate_dofs_topological(spaces, dim, entities) for dim, entities in held]
    located += [_common(_in_faces(domain, meeting, spaces)) for meeting in support.meetings]
    located += [_halfway(domain, middle, spaces) for middle in support.middles]
    return [dofs for dofs in located if len(dofs[0])]


def _in_faces(domain: Domain, faces: Sequence[str], spaces: tuple[api.Expr, api.Expr]) -> list[_Dofs]:
    """Unknowns in each of the faces."""
    facets = [domain.facets_of([face]) for face in faces]
    return [fem.locate_dofs_topological(spaces, domain.dim - 1, found) for found in facets]


def _common(sets: Sequence[_Dofs]) -> _Dofs:
    """Unknowns that all sets have."""
    common = functools.reduce(np.intersect1d, [dofs[0] for dofs in sets])
    _, rows, _ = np.intersect1d(sets[0][0], common, return_indices=True)
    return [dofs[rows] for dofs in sets[0]]


def _halfway(domain: Domain, middle: Middle, spaces: tuple[api.Expr, api.Expr]) -> _Dofs:
    """Unknowns of the nodes that are as far from the nearest node of one face as from that of the other."""
    what = "support in the middle", " and ".join(middle.between)
    if not spaces[1].element.basix_element.interpolation_is_identity:
        raise InputError(*what, "needs elements with nodal values", "take 27-node hexahedra, not 20-node ones")
    places = spaces[1].tabulate_dof_coordinates()
    apart = []
    for dofs in _in_faces(domain, middle.between, spaces):
        face = np.concatenate(domain.mesh.comm.allgather(places[dofs[1]]))
        apart.append(cKDTree(face).query(places)[0])
    if middle.within:
        inside = _common(_in_faces(domain, middle.within, spaces))
    else:
        cells = np.unique(domain.cell_tags.indices)
        inside = fem.locate_dofs_topological(spaces, domain.dim, cells)
    near, far = (distance[inside[1]] for distance in apart)
    found = [dofs[np.abs(near - far) < 1e-6 * (near + far)] for dofs in inside]
    if domain.mesh.comm.allreduce(len(found[0])) == 0:
        hint = "mesh an even number of cells across the wall, or one of 27 nodes"
        raise InputError(*what, "has no node halfway between the faces", hint)
    return found
