"""Supports as Dirichlet conditions of DOLFINx."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import fem
from reference_fe.problem.domain import Domain
from reference_fe.problem.supports import Support

__all__ = ["Prescribed", "build_supports"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prescribed:
    """One component of a support.

    Attributes
    ----------
    function : holds the prescribed displacement [m]
    at_load_factor_1 : displacement at load factor 1 [m]
    expansion : (n,) thermal displacement at the function's points, there from the start [m]
    """

    function: api.Function
    at_load_factor_1: float
    expansion: NDArray[np.float64]

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
            prescribed.append(Prescribed(function=value, at_load_factor_1=at_load_factor_1, expansion=expansion))
            spaces = (V.sub(component), subspace)
            conditions += [fem.dirichletbc(value, dofs, spaces[0]) for dofs in _located(domain, support, spaces)]
    return conditions, prescribed


def _located(domain: Domain, support: Support, spaces: tuple[api.Expr, api.Expr]) -> list[list[NDArray[np.int32]]]:
    """Unknowns of one component held by a support, numbered in the full space and in the component's own."""
    faces, cells = domain.facets_of(support.faces), domain.cells_of(support.parts)
    held = (domain.dim - 1, faces), (domain.dim, cells)
    located = [fem.locate_dofs_topological(spaces, dim, entities) for dim, entities in held]
    for meeting in support.meetings:
        sets = [fem.locate_dofs_topological(spaces, domain.dim - 1, domain.facets_of([face])) for face in meeting]
        common = functools.reduce(np.intersect1d, [dofs[0] for dofs in sets])
        _, rows, _ = np.intersect1d(sets[0][0], common, return_indices=True)
        located.append([dofs[rows] for dofs in sets[0]])
    return [dofs for dofs in located if len(dofs[0])]
