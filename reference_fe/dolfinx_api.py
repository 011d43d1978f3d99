"""Every call whose spelling depends on the DOLFINx version (0.9 to 0.11), and the one place that imports it.

``dolfinx_solver`` must be imported first where the PyPI wheel provides DOLFINx; Debian and conda builds do without it.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from reference_fe import triangular_product

with contextlib.suppress(ModuleNotFoundError):
    triangular_product.provide()  # before PETSc is loaded
    import dolfinx_solver  # noqa: F401  (sets up the libraries of the PyPI wheel)

import basix
import basix.ufl
import dolfinx as _dolfinx
import numpy as np
import ufl as _ufl
from dolfinx import fem as _fem
from dolfinx import mesh as dolfinx_mesh
from dolfinx.fem import petsc as _fem_petsc
from dolfinx.graph import adjacencylist
from dolfinx.io import distribute_entity_data
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

__all__ = [
    "COMM",
    "MPI",
    "DirichletBC",
    "Expr",
    "FacetRule",
    "Function",
    "Mesh",
    "MeshTags",
    "PETSc",
    "PointEvaluation",
    "add_block",
    "cell_matrix",
    "cell_measure",
    "cell_nodes",
    "compile_form",
    "create_matrix",
    "distributed_matrix",
    "distributed_values",
    "facet_midpoints",
    "facet_rule",
    "facet_tags_from_nodes",
    "fem",
    "fem_petsc",
    "flush",
    "gauss_rule",
    "global_dot",
    "global_norm",
    "lagrange_gradients",
    "lagrange_points",
    "lagrange_shapes",
    "largest_of_all",
    "mesh_from_arrays",
    "meshtags",
    "quadrature_space",
    "reference_edge",
    "shared_matrix",
    "sum_shared",
    "ufl",
    "versions",
]

triangular_product.connect()
COMM = MPI.COMM_WORLD
if TYPE_CHECKING:
    Mesh = dolfinx_mesh.Mesh[np.float64]
    Function = _fem.Function[np.float64]
    DirichletBC = _fem.DirichletBC[np.float64]
else:  # generic at run time only from 0.10 on
    Mesh, Function, DirichletBC = dolfinx_mesh.Mesh, _fem.Function, _fem.DirichletBC
MeshTags = dolfinx_mesh.MeshTags
type Expr = Any
# UFL carries no types and DOLFINx's are partial: both are used untyped, our own code around them is not.
dolfinx: Any = _dolfinx
ufl: Any = _ufl
fem: Any = _fem
fem_petsc: Any = _fem_petsc
JIT_OPTIONS = {"cffi_extra_compile_args": ["-O3", "-march=native"]}
_CELL = {2: "quadrilateral", 3: "hexahedron"}
_FACET = {2: "interval", 3: "quadrilateral"}


def versions() -> dict[str, str]:
    """Versions of the libraries a finite element result depends on."""
    return {
        "dolfinx": str(dolfinx.__version__),
        "petsc": ".".join(str(part) for part in PETSc.Sys.getVersion()),
        "basix": str(basix.__version__),
    }


def mesh_from_arrays(points: NDArray[np.float64], cells: NDArray[np.int64]) -> Mesh:
    """DOLFINx mesh of hexahedra (8 or 27 nodes) or quadrilaterals (4 or 9) in gmsh's order; ``points`` (n, dim) [m].

    Every process of a parallel run gives the whole mesh and gets its share.
    """
    dim = points.shape[1]
    degree = 1 if cells.shape[1] == 2**dim else 2
    element: Any = basix.ufl.element("Lagrange", _CELL[dim], degree, shape=(dim,))
    permutation = _gmsh_permutation(_CELL[dim], cells.shape[1])
    if COMM.rank > 0:
        points, cells = points[:0], cells[:0]
    own = np.ascontiguousarray(cells[:, permutation])
    return dolfinx_mesh.create_mesh(COMM, cells=own, e=element, x=points)  # 0.9 has e and x the other way round


def _gmsh_permutation(cell: str, nodes: int) -> NDArray[np.int64]:
    """Places of DOLFINx' nodes of a cell in gmsh's order."""
    return np.asarray(dolfinx.cpp.io.perm_gmsh(dolfinx_mesh.to_type(cell), nodes))


def facet_tags_from_nodes(mesh: Mesh, facets: NDArray[np.int64], values: NDArray[np.int32]) -> MeshTags:
    """Facet tags from facets given by their node numbers (gmsh order, input numbering)."""
    dim = mesh.topology.dim
    permutation = _gmsh_permutation(_FACET[dim], facets.shape[1])
    if COMM.rank > 0:
        facets, values = facets[:0], values[:0]
    entities, local = distribute_entity_data(mesh, dim - 1, np.ascontiguousarray(facets[:, permutation]), values)
    mesh.topology.create_connectivity(dim - 1, dim)
    return dolfinx_mesh.meshtags_from_entities(mesh, dim - 1, adjacencylist(entities), local.astype(np.int32))


def cell_nodes(mesh: Mesh) -> NDArray[np.int32]:
    """Geometry nodes of each cell, (n_cells, n_nodes), local numbering."""
    geometry = mesh.geometry
    return np.asarray(geometry.dofmaps[0] if hasattr(geometry, "dofmaps") else geometry.dofmap)


def facet_midpoints(mesh: Mesh, facets: NDArray[np.int32]) -> NDArray[np.float64]:
    """Midpoints of facets, (n, 3) [m]."""
    return np.asarray(dolfinx_mesh.compute_midpoints(mesh, mesh.topology.dim - 1, facets))


def meshtags(mesh: Mesh, dim: int, entities: NDArray[np.int32], values: NDArray[np.int32]) -> MeshTags:
    """Tags of entities of dimension ``dim``, sorted by entity."""
    order = np.argsort(entities)
    return dolfinx_mesh.meshtags(mesh, dim, entities[order], values[order])


def gauss_rule(points_per_axis: tuple[int, ...]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Tensor Gauss rule of the reference cell with one count an axis: points (n, dim) and weights (n,) [-]."""
    rules: list[Any] = [basix.make_quadrature(basix.CellType.interval, 2 * n - 1) for n in points_per_axis]
    grids = np.meshgrid(*[rule[0][:, 0] for rule in rules], indexing="ij")
    weights = functools.reduce(np.multiply.outer, [rule[1] for rule in rules])
    return np.stack(grids, axis=-1).reshape(-1, len(rules)), weights.ravel()


class _Signed(np.ndarray[Any, np.dtype[np.float64]]):
    """Array with the signature by which UFL tells two forms apart; UFL 2024 (DOLFINx 0.9) knows no plain arrays."""

    @property
    def ufl_signature(self) -> str:
        return repr(self.tolist())


def cell_measure(mesh: Mesh, tags: MeshTags, ids: tuple[int, ...], points_per_axis: tuple[int, ...]) -> Any:
    """UFL measure over the tagged cells with a tensor Gauss rule."""
    points, weights = gauss_rule(points_per_axis)
    rule = {"quadrature_points": points.view(_Signed), "quadrature_weights": weights.view(_Signed)}
    metadata = {"quadrature_rule": "custom", **rule}
    return ufl.dx(domain=mesh, subdomain_data=tags, subdomain_id=ids, metadata=metadata)


def quadrature_space(mesh: Mesh, points_per_axis: tuple[int, ...], shape: tuple[int, ...]) -> Any:
    """Space of values at the Gauss points of every cell."""
    points, weights = gauss_rule(points_per_axis)
    element = basix.ufl.quadrature_element(_CELL[points.shape[1]], value_shape=shape, points=points, weights=weights)
    return fem.functionspace(mesh, element)


def lagrange_points(degree: int, dim: int) -> NDArray[np.float64]:
    """Node positions of the reference quadrilateral's or hexahedron's Lagrange element, (n, dim) [-]."""
    element = basix.create_element(basix.ElementFamily.P, basix.CellType[_CELL[dim]], degree)
    return np.asarray(element.points)


def lagrange_gradients(degree: int, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives of the Lagrange shape functions along the reference axes, (dim, n_points, n_nodes) [-]."""
    element = basix.create_element(basix.ElementFamily.P, basix.CellType[_CELL[points.shape[1]]], degree)
    return np.asarray(element.tabulate(1, points))[1:, :, :, 0]


def lagrange_shapes(degree: int, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lagrange shape functions of the reference quadrilateral or hexahedron, (n_points, n_nodes) [-]."""
    cell = basix.CellType[_CELL[points.shape[1]]]
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


def sum_shared(function: Function) -> NDArray[np.float64]:
    """Own values of a function after the other processes' contributions have been added."""
    function.x.scatter_reverse(dolfinx.la.InsertMode.add)
    own = function.function_space.dofmap.index_map.size_local * function.function_space.dofmap.index_map_bs
    return np.array(function.x.array[:own])


def global_norm(own: NDArray[np.float64]) -> float:
    """Euclidean norm of a vector of which each process holds its own entries."""
    local = float(np.linalg.norm(own))
    return local if COMM.size == 1 else float(np.sqrt(COMM.allreduce(local * local)))


def global_dot(own: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Scalar product of two vectors of which each process holds its own entries."""
    local = float(own @ other)
    return local if COMM.size == 1 else float(COMM.allreduce(local))


def largest_of_all[Number: (np.float64, np.int64)](local: NDArray[Number]) -> NDArray[Number]:
    """Largest value over the processes, entry by entry."""
    if COMM.size == 1:
        return local
    largest = np.empty_like(local)
    COMM.Allreduce(np.ascontiguousarray(local), largest, op=MPI.MAX)
    return largest


def compile_form(expression: Expr) -> Any:
    """Compile a UFL form to machine code with this project's compiler flags."""
    return fem.form(expression, jit_options=JIT_OPTIONS)


def create_matrix(
    form: Any, diagonal_blocks: NDArray[np.int32], couplings: Sequence[NDArray[np.int32]] = ()
) -> PETSc.Mat:
    """Empty matrix for a bilinear form, with room for nodes that no integral reaches: diagonal, and coupled groups."""
    pattern = fem.create_sparsity_pattern(form)
    pattern.insert_diagonal(diagonal_blocks)
    for nodes in couplings:
        pattern.insert(nodes, nodes)
    pattern.finalize()
    matrix: PETSc.Mat = dolfinx.cpp.la.petsc.create_matrix(COMM, pattern)
    symmetric: Any = PETSc.Mat.Option.SYMMETRIC  # the stubs give the options the wrong type
    matrix.setOption(symmetric, True)
    size = matrix.getBlockSize()
    for nodes in couplings:  # PETSc drops room that nothing has been written to
        rows = (size * nodes[:, None] + np.arange(size)).ravel().astype(np.int32)
        add_block(matrix, rows, np.zeros((len(rows), len(rows))))
    flush(matrix)
    return matrix


def flush(matrix: PETSc.Mat) -> None:
    """End a round of insertions, so that additions may follow."""
    halfway: Any = PETSc.Mat.AssemblyType.FLUSH  # the stubs give it the wrong type
    matrix.assemble(halfway)


def add_block(matrix: Any, rows: NDArray[np.int32], block: NDArray[np.float64]) -> None:
    """Add a dense block at rows and columns of a PETSc matrix, given by numbers local to this process."""
    add = PETSc.InsertMode.ADD
    matrix.setValuesLocal(rows, rows, block, add)


def cell_matrix(V: Any, groups: Sequence[NDArray[np.int32]], diagonal_blocks: NDArray[np.int32]) -> Any:
    """Empty DOLFINx CSR matrix that couples the nodes of each group, with room on the diagonal of further nodes.

    It is this process' own: rows and columns are all nodes the process knows, those of its neighbours included.
    """
    index_map = V.dofmap.index_map
    nodes_here = dolfinx.common.IndexMap(MPI.COMM_SELF, index_map.size_local + index_map.num_ghosts)
    pattern = dolfinx.cpp.la.SparsityPattern(MPI.COMM_SELF, [nodes_here, nodes_here], [3, 3])
    for nodes in groups:
        pattern.insert(nodes, nodes)
    pattern.insert_diagonal(diagonal_blocks)
    pattern.finalize()
    return dolfinx.la.matrix_csr(pattern, block_mode=dolfinx.la.BlockMode.expanded)


def shared_matrix(csr: Any) -> PETSc.Mat:
    """PETSc matrix on the arrays of a DOLFINx CSR matrix: values written there are seen here after stateIncrease."""
    size = len(csr.indptr) - 1
    indptr: Any = np.ascontiguousarray(csr.indptr, dtype=PETSc.IntType)
    indices: Any = np.ascontiguousarray(csr.indices, dtype=PETSc.IntType)
    matrix = PETSc.Mat().createAIJWithArrays((size, size), (indptr, indices, csr.data), comm=PETSc.COMM_SELF)
    symmetric: Any = PETSc.Mat.Option.SYMMETRIC  # the stubs give the options the wrong type
    matrix.setOption(symmetric, True)
    return matrix


def distributed_matrix(
    csr: Any, V: Any, further: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None
) -> PETSc.Mat:
    """PETSc matrix over all processes with room for the sum of their own CSR matrices, see `distributed_values`.

    further : rows and columns of further entries, in numbers over all processes
    """
    index_map, block = V.dofmap.index_map, V.dofmap.index_map_bs
    here = index_map.size_local + index_map.num_ghosts
    nodes = index_map.local_to_global(np.arange(here, dtype=np.int32))
    numbers = (block * nodes[:, None] + np.arange(block)).ravel()
    rows = np.repeat(numbers, np.diff(csr.indptr))
    sizes = (block * index_map.size_local, block * index_map.size_global)
    matrix = PETSc.Mat().create(PETSc.COMM_WORLD)
    matrix.setSizes((sizes, sizes))
    matrix.setType("aij")
    columns = numbers[csr.indices]
    if further is not None:
        rows, columns = np.concatenate([rows, further[0]]), np.concatenate([columns, further[1]])
    coordinates: Any = (rows.astype(PETSc.IntType), columns.astype(PETSc.IntType))
    if hasattr(matrix, "setPreallocationCOO"):
        matrix.setPreallocationCOO(*coordinates)
    else:  # petsc4py of PETSc 3.22 (Debian 13)
        matrix.setUp()
        matrix.setAttr("coordinates", coordinates)
    symmetric: Any = PETSc.Mat.Option.SYMMETRIC  # the stubs give the options the wrong type
    matrix.setOption(symmetric, True)
    return matrix


def distributed_values(matrix: PETSc.Mat, values: NDArray[np.float64]) -> None:
    """Set a matrix from `distributed_matrix` to the sum of all processes' values: CSR data, then further entries."""
    entries: Any = values  # the stubs know lists only
    replace: Any = PETSc.InsertMode.INSERT_VALUES
    if hasattr(matrix, "setValuesCOO"):
        matrix.setValuesCOO(entries, replace)
    else:
        _add_triples(matrix, entries)


def _add_triples(matrix: Any, values: NDArray[np.float64]) -> None:
    """`distributed_values` entry by entry, for a petsc4py without COO assembly."""
    rows, columns = matrix.getAttr("coordinates")
    if matrix.assembled:
        matrix.zeroEntries()
    matrix.setValuesRCV(rows[:, None], columns[:, None], values[:, None, None], addv=PETSc.InsertMode.ADD_VALUES)
    matrix.assemble()


class PointEvaluation:
    """Compiled UFL expression at fixed reference points, evaluated for chosen cells.

    Parameters
    ----------
    expression : UFL expression
    points : (n_points, dim) reference points
    """

    def __init__(self, expression: Expr, points: NDArray[np.float64]) -> None:
        self._compiled = fem.Expression(expression, points, jit_options=JIT_OPTIONS)
        self._shape = (len(points), *expression.ufl_shape)

    def __call__(self, mesh: Mesh, cells: NDArray[np.int32]) -> NDArray[np.float64]:
        """Values, (n_cells, n_points, *shape)."""
        values = np.asarray(self._compiled.eval(mesh, cells))  # 0.9 gives them flat, (n_cells, n_points * size)
        return values.reshape(len(cells), *self._shape)
