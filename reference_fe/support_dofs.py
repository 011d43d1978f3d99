"""Supports as Dirichlet conditions of DOLFINx."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.dolfinx_api import fem
from reference_fe.domain import Domain
from reference_fe.supports import Support

__all__ = ["build_supports"]


def build_supports(
    domain: Domain, V: api.Expr, supports: Sequence[Support]
) -> tuple[list[api.DirichletBC], list[tuple[api.Function, float]]]:
    """Conditions, and the function that holds each prescribed component with its value at load factor 1 [m]."""
    conditions: list[api.DirichletBC] = []
    prescribed: list[tuple[api.Function, float]] = []
    for dim in range(4):
        domain.mesh.topology.create_connectivity(dim, 3)
    for support in supports:
        for position, component in enumerate(support.components):
            subspace, _ = V.sub(component).collapse()
            value = fem.Function(subspace)
            prescribed.append((value, support.value[position] if support.value else 0.0))
            spaces = (V.sub(component), subspace)
            conditions += [fem.dirichletbc(value, dofs, spaces[0]) for dofs in _located(domain, support, spaces)]
    return conditions, prescribed


def _located(domain: Domain, support: Support, spaces: tuple[api.Expr, api.Expr]) -> list[list[NDArray[np.int32]]]:
    """Unknowns of one component held by a support, numbered in the full space and in the component's own."""
    faces, cells = domain.facets_of(support.faces), domain.cells_of(support.parts)
    located = [fem.locate_dofs_topological(spaces, dim, entities) for dim, entities in ((2, faces), (3, cells))]
    for meeting in support.meetings:
        sets = [fem.locate_dofs_topological(spaces, 2, domain.facets_of([face])) for face in meeting]
        common = functools.reduce(np.intersect1d, [dofs[0] for dofs in sets])
        _, rows, _ = np.intersect1d(sets[0][0], common, return_indices=True)
        located.append([dofs[rows] for dofs in sets[0]])
    return [dofs for dofs in located if len(dofs[0])]
