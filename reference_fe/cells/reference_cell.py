"""Tables of the reference quadrilateral and hexahedron: Lagrange shape functions, facets and edges."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_fe.dolfinx_api import CELL, basix


def lagrange_points(degree: int, dim: int) -> NDArray[np.float64]:
    """Node positions of the reference quadrilateral's or hexahedron's Lagrange element, (n, dim) [-]."""
    element = basix.create_element(basix.ElementFamily.P, basix.CellType[CELL[dim]], degree)
    return np.asarray(element.points)


def lagrange_gradients(degree: int, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives of the Lagrange shape functions along the reference axes, (dim, n_points, n_nodes) [-]."""
    element = basix.create_element(basix.ElementFamily.P, basix.CellType[CELL[points.shape[1]]], degree)
    return np.asarray(element.tabulate(1, points))[1:, :, :, 0]


def lagrange_shapes(degree: int, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lagrange shape functions of the reference quadrilateral or hexahedron, (n_points, n_nodes) [-]."""
    cell = basix.CellType[CELL[points.shape[1]]]
    element = basix.create_element(basix.ElementFamily.P, cell, degree)
    return np.asarray(element.tabulate(0, points))[0, :, :, 0]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FacetRule:
    """Gauss rule on the facets of the reference cell, one block for each facet of it.

    Attributes
    ----------
    points : (kinds, q, dim) reference points of the cell
    weights : (q,)
    edges : (kinds, dim - 1, dim) reference vectors along the facet's axes
    closure : (kinds, k) numbers of the cell's functions that live on the facet
    shapes : (kinds, q, k) those functions at the points
    """

    points: NDArray[np.float64]
    weights: NDArray[np.float64]
    edges: NDArray[np.float64]
    closure: NDArray[np.int64]
    shapes: NDArray[np.float64]


def facet_rule(V: Any, line: tuple[NDArray[np.float64], NDArray[np.float64]]) -> FacetRule:
    """Tensor product of a rule on [0, 1], points and weights, on each facet, with the shape functions of V."""
    element = V.element.basix_element
    vertices, corners = basix.geometry(element.cell_type), basix.topology(element.cell_type)
    dim = vertices.shape[1]
    axes = dim - 1
    flat = np.stack(np.meshgrid(*[line[0]] * axes, indexing="ij"), axis=-1).reshape(-1, axes)
    weights = functools.reduce(np.multiply.outer, [line[1]] * axes).ravel()
    first = np.array([[vertices[k] for k in facet] for facet in corners[dim - 1]])
    edges = np.stack([first[:, 2**axis] - first[:, 0] for axis in range(dim - 1)], axis=1)
    points = first[:, None, 0] + np.einsum("qa,fad->fqd", flat, edges)
    closure = np.array(element.entity_closure_dofs[dim - 1])
    tables = [element.tabulate(0, on_facet)[0, :, nodes, 0].T for on_facet, nodes in zip(points, closure, strict=True)]
    return FacetRule(points=points, weights=weights, edges=edges, closure=closure, shapes=np.stack(tables))


def reference_edge(local_edge: int) -> NDArray[np.float64]:
    """End points of an edge of the reference hexahedron, (2, 3) [-]."""
    ends = basix.topology(basix.CellType.hexahedron)[1][local_edge]
    return np.asarray(basix.geometry(basix.CellType.hexahedron))[ends]
