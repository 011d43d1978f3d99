"""Every call whose spelling depends on the DOLFINx version (0.9 to 0.11), and the one place that imports it.

``dolfinx_solver`` must be imported first where the PyPI wheel provides DOLFINx; Debian and conda builds do without it.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.errors import WorkbenchError
from reference_fe.form_cache import sole_compiler
from reference_fe.solver import triangular_product
from reference_fe.solver.loopback import keep_to_this_machine
from reference_fe.solver.signals import leave_signals_alone

with contextlib.suppress(ModuleNotFoundError):
    keep_to_this_machine()  # before MPI is loaded
    leave_signals_alone()  # before PETSc is loaded
    triangular_product.provide()  # before PETSc is loaded
    import dolfinx_solver  # noqa: F401  (sets up the libraries of the PyPI wheel)

import basix
import basix.ufl
import dolfinx as _dolfinx
import numpy as np
import ufl as _ufl
from dolfinx import fem as _fem
from dolfinx import jit
from dolfinx import mesh as dolfinx_mesh
from dolfinx.fem import petsc as _fem_petsc
from dolfinx.graph import adjacencylist
from dolfinx.io import distribute_entity_data
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc

__all__ = [
    "CELL",
    "COMM",
    "MPI",
    "DirichletBC",
    "Expr",
    "Function",
    "Mesh",
    "MeshTags",
    "PETSc",
    "add_block",
    "basix",
    "cell_matrix",
    "cell_measure",
    "cell_nodes",
    "compile_expression",
    "compile_form",
    "create_matrix",
    "distributed_matrix",
    "distributed_values",
    "dolfinx",
    "facet_midpoints",
    "facet_tags_from_nodes",
    "fem",
    "fem_petsc",
    "flush",
    "gauss_rule",
    "matrix_product",
    "mesh_from_arrays",
    "meshtags",
    "petsc_library",
    "quadrature_space",
    "shared_matrix",
    "triangular_matrix",
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
_COMPILED_WITH = {"cffi_extra_compile_args": ["-O3", "-march=native"]}
CELL = {2: "quadrilateral", 3: "hexahedron"}
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
    element: Any = basix.ufl.element("Lagrange", CELL[dim], degree, shape=(dim,))
    permutation = _gmsh_permutation(CELL[dim], cells.shape[1])
    if COMM.rank > 0:
        points, cells = points[:0], cells[:0]
    own = np.ascontiguousarray(cells[:, permutation])
    return dolfinx_mesh.create_mesh(COMM, cells=own, e=element, x=points)  # 0.9 has e and x the other way round


def _gmsh_permutation(cell: str, nodes: int) -> NDArray[np.int64]:
    """Places of DOLFINx' nodes of a cell in gmsh's order."""
    return np.asarray(dolfinx.cpp.io.perm_gmsh(dolfinx_mesh.to_type(cell), nodes))


def facet_tags_from_nodes(mesh: Mesh, facets: NDArray[np.int64], values: NDArray[np.int32]) -> MeshTags:
    """Facet tags from values (n,) of facets (n, n_nodes) given by their node numbers (gmsh order, input numbering)."""
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
    """Tags, values (n,), of entities (n,) of dimension ``dim`` in local numbers, sorted by entity."""
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
    element = basix.ufl.quadrature_element(CELL[points.shape[1]], value_shape=shape, points=points, weights=weights)
    return fem.functionspace(mesh, element)


def compile_form(expression: Expr) -> Any:
    """Compile a UFL form to machine code with this project's compiler flags."""
    with _compiler() as options:
        return fem.form(expression, jit_options=options)


def compile_expression(expression: Expr, points: NDArray[np.float64]) -> Any:
    """Compile a UFL expression at reference points, (n_points, dim), likewise."""
    with _compiler() as options:
        return fem.Expression(expression, points, jit_options=options)


@contextmanager
def _compiler() -> Iterator[dict[str, Any]]:
    """Options of DOLFINx's compiler; its folder is held by the first process of a parallel run, which compiles."""
    folder = Path(jit.get_options()["cache_dir"]) / "wheel-workbench"
    with sole_compiler(folder) if COMM.rank == 0 else nullcontext():
        yield _COMPILED_WITH | {"cache_dir": folder}


def create_matrix(
    form: Any, diagonal_blocks: NDArray[np.int32], couplings: Sequence[NDArray[np.int32]] = ()
) -> PETSc.Mat:
    """Empty matrix for a bilinear form, with room for nodes that no integral reaches: diagonal, and coupled groups.

    diagonal_blocks, couplings : (n,) int, and (k,) int each, nodes in this process' numbers
    """
    pattern = fem.create_sparsity_pattern(form)
    pattern.insert_diagonal(diagonal_blocks)
    for nodes in couplings:
        pattern.insert(nodes, nodes)
    pattern.finalize()
    matrix: PETSc.Mat = dolfinx.cpp.la.petsc.create_matrix(COMM, pattern)
    _call_symmetric(matrix)
    size = matrix.getBlockSize()
    for nodes in couplings:  # PETSc drops room that nothing has been written to
        rows = (size * nodes[:, None] + np.arange(size)).ravel().astype(np.int32)
        add_block(matrix, rows, np.zeros((len(rows), len(rows))))
    flush(matrix)
    return matrix


def _call_symmetric(matrix: PETSc.Mat) -> None:
    symmetric: Any = PETSc.Mat.Option.SYMMETRIC  # the stubs give the options the wrong type
    matrix.setOption(symmetric, True)


def flush(matrix: PETSc.Mat) -> None:
    """End a round of insertions, so that additions may follow."""
    halfway: Any = PETSc.Mat.AssemblyType.FLUSH  # the stubs give it the wrong type
    matrix.assemble(halfway)


def add_block(matrix: Any, rows: NDArray[np.int32], block: NDArray[np.float64]) -> None:
    """Add a dense block (n, n) at rows and columns (n,) of a PETSc matrix, given by numbers local to this process."""
    add = PETSc.InsertMode.ADD
    matrix.setValuesLocal(rows, rows, block, add)


def cell_matrix(V: Any, groups: Sequence[NDArray[np.int32]]) -> Any:
    """Empty DOLFINx CSR matrix that couples the nodes of each group.

    It is this process' own: rows and columns are all nodes the process knows, those of its neighbours included.

    groups : (k,) int each, nodes in this process' numbers
    """
    index_map = V.dofmap.index_map
    nodes_here = dolfinx.common.IndexMap(MPI.COMM_SELF, index_map.size_local + index_map.num_ghosts)
    pattern = dolfinx.cpp.la.SparsityPattern(MPI.COMM_SELF, [nodes_here, nodes_here], [3, 3])
    for nodes in groups:
        pattern.insert(nodes, nodes)
    pattern.finalize()
    return dolfinx.la.matrix_csr(pattern, block_mode=dolfinx.la.BlockMode.expanded)


def shared_matrix(indptr: NDArray[Any], indices: NDArray[Any], values: NDArray[np.float64]) -> PETSc.Mat:
    """PETSc matrix on the arrays of a CSR matrix: values written there are seen here after stateIncrease."""
    size = len(indptr) - 1
    arrays: Any = (indptr, indices, values)
    matrix = PETSc.Mat().createAIJWithArrays((size, size), arrays, comm=PETSc.COMM_SELF)
    _call_symmetric(matrix)
    return matrix


def triangular_matrix(indptr: NDArray[Any], indices: NDArray[Any]) -> tuple[PETSc.Mat, NDArray[np.float64]]:
    """Symmetric PETSc matrix from the pattern of its upper triangle, and its values, zero, to be written in place.

    They are gone with the matrix, and seen by it after stateIncrease.
    """
    size = len(indptr) - 1
    arrays: Any = (indptr, indices)
    matrix = PETSc.Mat().createSBAIJ((size, size), 1, csr=arrays, comm=PETSc.COMM_SELF)
    address = ctypes.POINTER(ctypes.c_double)()
    if petsc_library().MatSeqSBAIJGetArray(ctypes.c_void_p(matrix.handle), ctypes.byref(address)):
        raise WorkbenchError("PETSc does not give the values of a symmetric matrix; report this")
    return matrix, np.ctypeslib.as_array(address, (len(indices),))


@functools.cache
def petsc_library() -> ctypes.CDLL:
    """The PETSc library that petsc4py is linked to."""
    return ctypes.CDLL(PETSc.__file__)


def matrix_product(matrix: PETSc.Mat, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """A matrix times x; both of this process' own rows."""
    right, left = matrix.createVecRight(), matrix.createVecLeft()
    right.array[:] = x
    matrix.mult(right, left)
    product = np.array(left.array, dtype=np.float64)
    right.destroy()
    left.destroy()
    return product


def distributed_matrix(
    indptr: NDArray[Any],
    indices: NDArray[Any],
    V: Any,
    further: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None,
) -> PETSc.Mat:
    """PETSc matrix over all processes with room for the sum of their own CSR matrices, see `distributed_values`.

    further : rows and columns (n,) of further entries, in numbers over all processes
    """
    index_map, block = V.dofmap.index_map, V.dofmap.index_map_bs
    here = index_map.size_local + index_map.num_ghosts
    nodes = index_map.local_to_global(np.arange(here, dtype=np.int32))
    numbers = (block * nodes[:, None] + np.arange(block)).ravel()
    rows = np.repeat(numbers, np.diff(indptr))
    sizes = (block * index_map.size_local, block * index_map.size_global)
    matrix = PETSc.Mat().create(PETSc.COMM_WORLD)
    matrix.setSizes((sizes, sizes))
    matrix.setType("aij")
    columns = numbers[indices]
    if further is not None:
        rows, columns = np.concatenate([rows, further[0]]), np.concatenate([columns, further[1]])
    coordinates: Any = (rows.astype(PETSc.IntType), columns.astype(PETSc.IntType))
    if hasattr(matrix, "setPreallocationCOO"):
        matrix.setPreallocationCOO(*coordinates)
    else:  # petsc4py of PETSc 3.22 (Debian 13)
        matrix.setUp()
        matrix.setAttr("coordinates", coordinates)
    _call_symmetric(matrix)
    return matrix


def distributed_values(matrix: PETSc.Mat, values: NDArray[np.float64]) -> None:
    """Set a matrix from `distributed_matrix` to the sum of all processes' values: CSR data, then further entries.

    values : (nnz + n,) in the unit of the matrix, n further entries
    """
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
