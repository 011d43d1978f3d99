"""Stress linearised through the thickness of strips, at a distance from their joints: a measure that has a limit.

At a weld's end the elastic stress is singular: its largest value rises with every refinement. What bends and stretches
the strip does not: through the thickness T, with s from the middle, the Cauchy stress is replaced by

    sigma_m + sigma_b 2 s / T,   sigma_m = (1 / T) int sigma ds,   sigma_b = (6 / T^2) int sigma s ds

(membrane plus bending on a stress classification line: ASME BPVC VIII-2, annex 5-A, from memory), and the von Mises
stress of its two ends counts. Along the strip, as `stress.StressRecovery` explains, the Gauss stations of each cell
tell the truth; where a cell reaches into the neighbourhood of nodes where parts are joined, the line's stress is
extrapolated from them to the place ``distance`` thicknesses away. Lines within a joint are left out.

Where a weld reaches the free edge of a strip, the measure has no limit either: on the edge itself the built-in wheel's
rises by 5 % and falls again over three meshes. So a strip is judged up to ``edge_distance`` thicknesses from its free
edges (half way to the middle, where it is narrower); the last line is interpolated from the three of its cell. What the
edge carries beyond that is not in the value.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from contracts.mesh import TaggedMesh
from reference_fe import dolfinx_api as api
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.material.point_stress import PointStress
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["LinearisedStress"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_GAUSS, _WEIGHTS = (rule.ravel() for rule in api.gauss_rule((3,)))
_ACROSS = np.array([0.0, *np.sort(_GAUSS), 1.0])
"""Places of a cell's second and third axis: Gauss points through the thickness, ends and middle along the axle."""
_THROUGH, _LATERAL = [1, 2, 3], [0, 2, 4]
_MIDDLE_AND_ENDS = np.array([0.0, 0.5, 1.0])
EDGE_DISTANCE = 4.0
"""In thicknesses: three meshes of the built-in wheel agree within 2.5 % from there on; at 0, within 11 %."""
_FACES = {
    2: np.array([(0, 1), (1, 2), (2, 3), (3, 0)]),
    3: np.array([(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]),
}
"""Corners of a cell's faces, gmsh's numbers."""


class LinearisedStress:
    """Largest linearised von Mises stress of each part.

    Parameters
    ----------
    problem : body of structured cells whose first axis runs along the strip; the shorter of the others is its thickness
    parts : those that count, deformable
    distance : from joints, in thicknesses of the strip [-]
    edge_distance : from a solid strip's free edges, in thicknesses; at most half way to its middle, where it is [-]

    Verified by tests/verification/test_fe_linearised_stress.py: bending of the elastica ring, several cells through the
    thickness, and the limit under refinement.
    """

    def __init__(
        self, problem: StaticProblem, parts: Sequence[str], distance: float = 1.0, edge_distance: float = EDGE_DISTANCE
    ) -> None:
        domain = problem.domain
        self._mesh, self._tagged = domain.mesh, domain.tagged
        self._own = np.arange(domain.mesh.topology.index_map(domain.dim).size_local, dtype=np.int32)
        self._original = domain.mesh.topology.original_cell_index[self._own].astype(np.int64)
        along = np.sort(api.gauss_rule((problem.discretisation.gauss_points[0],))[0].ravel())
        self._stress = PointStress(problem, _points(along, domain.dim))
        ends = PointEvaluation(api.ufl.SpatialCoordinate(domain.mesh), _points(np.array([0.0, 1.0]), domain.dim))
        places = self._of_all(ends(domain.mesh, self._own))
        self._lines = {
            part: _lines(_Part(self._tagged, part, places), along, distance, edge_distance) for part in parts
        }

    def largest_by_part(self) -> dict[str, float]:
        """Largest linearised von Mises stress [Pa]; 0 for a part all of whose lines are left out."""
        stress = self._of_all(self._stress()).reshape(-1, 3, 3)
        return {part: max((one.largest(stress) for one in lines), default=0.0) for part, lines in self._lines.items()}

    def _of_all(self, mine: Array) -> Array:
        """Values (n_cells, n_points, ...) at the points of the tagged mesh's cells, from those of own cells."""
        whole = np.zeros((len(self._tagged.cells), *mine.shape[1:]))
        whole[self._original] = mine
        return whole if self._mesh.comm.size == 1 else np.asarray(self._mesh.comm.allreduce(whole))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Lines:
    """Lines through the thickness at Gauss stations, and places between them where their stress is judged.

    points : (m, g, k), k points through the thickness at g stations of the same cells, or at g = 3 x stations where
        three lines across the strip have to be interpolated
    shares : (m, k) parts of the thickness, sum 1
    levers : (m, k) places through the thickness, -1 to 1
    along : (m, g) weights of the stations at the place that counts
    """

    points: Index
    shares: Array
    levers: Array
    along: Array

    def largest(self, stress: Array) -> float:
        """Largest von Mises stress at the ends of the lines, from stress (n, 3, 3) at the points [Pa]."""
        here = np.einsum("mg,mgkij->mkij", self.along, stress[self.points])
        membrane = np.einsum("mk,mkij->mij", self.shares, here)
        bending = 3.0 * np.einsum("mk,mk,mkij->mij", self.shares, self.levers, here)
        worst = 0.0
        for end in (membrane - bending, membrane + bending):
            deviator = end - np.trace(end, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
            worst = max(worst, float(np.sqrt(1.5 * np.einsum("mij,mij->m", deviator, deviator)).max()))
        return worst


class _Part:
    """Cells of one part; places (n_cells, n, dim) [m]: `_points` at both ends of every cell's first axis."""

    def __init__(self, mesh: TaggedMesh, part: str, places: Array) -> None:
        self.mesh = mesh
        self.cells = np.flatnonzero(mesh.cell_tags == mesh.parts[part])
        self.corners = mesh.cells[self.cells][:, : 2**mesh.dim]
        grid = places[self.cells].reshape(-1, 2, *[len(_ACROSS)] * (mesh.dim - 1), mesh.dim)
        axes = range(2, mesh.dim + 1)
        spans = np.stack(
            [(grid.take(-1, axis=k) - grid.take(0, axis=k)).reshape(len(grid), -1, mesh.dim) for k in axes]
        )
        sizes = np.linalg.norm(spans, axis=-1).mean(axis=-1)
        self.axis = np.argmin(sizes, axis=0)
        self.thickness = np.min(sizes, axis=0)
        across = np.take_along_axis(spans.mean(axis=2), self.axis[None, :, None], axis=0)[0]
        self.direction = across / np.linalg.norm(across, axis=-1, keepdims=True)
        middle = len(_ACROSS) // 2
        self.ends = np.stack([np.take(grid[c], middle, axis=1 + a) for c, a in enumerate(self.axis)])
        if mesh.dim == 3:
            self.ends = self.ends[:, :, _LATERAL]
        self.ends = self.ends.reshape(len(grid), 2, -1, mesh.dim)
        owners = sum(np.isin(np.arange(len(mesh.points)), mesh.cells[mesh.cell_tags == t]) for t in set(mesh.cell_tags))
        self.joints = np.flatnonzero(np.asarray(owners) > 1)
        faces = np.sort(self.corners[:, _FACES[mesh.dim]], axis=-1)
        to_face = mesh.points[faces].mean(axis=2) - mesh.points[self.corners].mean(axis=1)[:, None]
        along = np.abs(np.einsum("nfi,ni->nf", to_face, self.direction))
        broad = along > 0.7 * np.linalg.norm(to_face, axis=-1)
        self.owners, self.faces = np.nonzero(broad)[0], faces[broad]
        self.across = (self.ends[:, :, -1] - self.ends[:, :, 0]).mean(axis=1)
        self.across /= np.maximum(np.linalg.norm(self.across, axis=-1, keepdims=True), np.finfo(float).tiny)
        self.slice, self.edges = np.arange(len(grid)), dict[int, Index]()
        if mesh.dim == 3:
            lateral = np.abs(np.einsum("nfi,ni->nf", to_face, self.across)) > 0.7 * np.linalg.norm(to_face, axis=-1)
            sides = broad | lateral
            self.slice = _connected(np.nonzero(sides)[0], faces[sides], len(grid))
            self.edges = self._edges(np.nonzero(lateral)[0], faces[lateral])
        self.joined = np.zeros(len(grid), dtype=bool)
        self.joined[self.owners[np.isin(self.faces, self.joints).all(axis=1)]] = True

    def _edges(self, owners: Index, lateral: Index) -> dict[int, Index]:
        """Slice of the strip -> nodes of its faces to either side that no other cell shares; symmetry is no edge."""
        symmetric = self.mesh.facets[self.mesh.facet_tags == self.mesh.faces.get("symmetry", -1)][:, :4]
        every = np.concatenate([self.mesh.cells[:, :8][:, _FACES[3]].reshape(-1, 4), symmetric])
        different, counts = np.unique(np.sort(every, axis=-1), axis=0, return_counts=True)
        alone = set(map(tuple, different[counts == 1].tolist()))
        found = dict[int, set[int]]()
        for one, face in zip(self.slice[owners].tolist(), lateral.tolist(), strict=True):
            if tuple(face) in alone:
                found.setdefault(one, set()).update(face)
        return {one: np.array(sorted(nodes)) for one, nodes in found.items()}

    def beside_edges(self, row: int) -> Array:
        """Distances of the lateral places of one cell from the nearest free edge of its slice, (3,) [m]."""
        places = self.ends[row]
        if (nodes := self.edges.get(int(self.slice[row]))) is None:
            return np.full(places.shape[1], math.inf)
        apart = self.mesh.points[nodes] - places[:, :, None]
        nearest = np.linalg.norm(apart, axis=-1).argmin(axis=-1)[..., None, None]
        return np.asarray(np.abs(np.take_along_axis(apart, nearest, axis=2)[:, :, 0] @ self.across[row]).min(axis=0))

    def stacks(self) -> list[Index]:
        """Rows of the cells that lie on each other: they share a broad face."""
        label = _connected(self.owners, self.faces, len(self.cells))
        return np.split(np.argsort(label, kind="stable"), np.cumsum(np.bincount(label))[:-1])

    def half_widths(self, stacks: Sequence[Index], beside_edges: Sequence[Array]) -> Array:
        """Largest distance from free edges in the slice of the strip that each stack lies in, (n_stacks,) [m]."""
        slices = self.slice[[int(rows[0]) for rows in stacks]]
        widest = np.zeros(len(self.cells))
        np.maximum.at(widest, slices, [float(d.max()) for d in beside_edges])
        return np.asarray(widest[slices])

    def points(self, row: int, stations: int) -> Index:
        """Points through the thickness of one cell, (lateral places, stations, 3)."""
        counts = (stations, *[len(_ACROSS)] * (self.mesh.dim - 1))
        numbers = np.arange(math.prod(counts)).reshape(counts) + math.prod(counts) * self.cells[row]
        through = np.moveaxis(numbers, 1 + int(self.axis[row]), -1)[..., _THROUGH]
        lines = through[None] if self.mesh.dim == 2 else np.moveaxis(through[:, _LATERAL], 1, 0)
        return np.asarray(lines, dtype=np.int64)


def _connected(owners: Index, faces: Index, n_cells: int) -> Index:
    """Number of the group of each cell, (n_cells,): cells of a group share faces. owners (n,), faces (n, corners)"""
    _, same = np.unique(faces, axis=0, return_inverse=True)
    order = np.argsort(same.ravel(), kind="stable")
    meets = np.diff(same.ravel()[order]) == 0
    a, b = owners[order][:-1][meets], owners[order][1:][meets]
    links = coo_array((np.ones(len(a)), (a, b)), shape=(n_cells, n_cells))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _points(along: Array, dim: int) -> Array:
    """Points of the reference cell, the last axis fastest, (n, dim)."""
    grids = np.meshgrid(along, *[_ACROSS] * (dim - 1), indexing="ij")
    return np.stack(grids, axis=-1).reshape(-1, dim)


def _lines(part: _Part, along: Array, distance: float, edge_distance: float) -> list[_Lines]:
    """The lines of a part that count, those of equal shape together."""
    tree = cKDTree(part.mesh.points[part.joints]) if len(part.joints) else None
    stacks = part.stacks()
    beside_edges = [part.beside_edges(int(rows[0])) for rows in stacks]
    half_widths = part.half_widths(stacks, beside_edges) if stacks else np.zeros(0)
    found: list[tuple[Index, Array, Array, Array]] = []
    for rows, beside_edge, half_width in zip(stacks, beside_edges, half_widths, strict=True):
        if part.joined[rows].any():
            continue
        first, thickness = int(rows[0]), float(part.thickness[rows].sum())
        lines, shares, levers = _through(part, rows, len(along))
        across = _stations(beside_edge, min(edge_distance * thickness, 0.5 * half_width))
        places = np.einsum("ln,enx->elx", across, part.ends[first])
        beside = np.full(places.shape[:2], distance * thickness)
        if tree is not None:
            beside = np.sqrt(np.maximum(tree.query(places)[0] ** 2 - 0.25 * thickness**2, 0.0))
        wanted = distance * thickness
        for end in (0, 1):
            near, far = beside[end], beside[1 - end]
            beyond = near < wanted
            station = np.full(len(across), along[-end])
            reaching = beyond & (far > wanted)
            station[reaching] = np.abs(end - (wanted - near[reaching]) / (far - near)[reaching])
            for weights, x in zip(across[~beyond | reaching], station[~beyond | reaching], strict=True):
                used = np.flatnonzero(weights)
                points = lines[used].reshape(-1, lines.shape[-1])
                found.append((points, shares, levers, np.outer(weights[used], _lagrange(along, x)).ravel()))
    shapes = sorted({each[0].shape for each in found})
    groups = [zip(*(each for each in found if each[0].shape == shape), strict=True) for shape in shapes]
    gathered = [[np.stack(arrays) for arrays in group] for group in groups]
    return [_Lines(points=g[0], shares=g[1], levers=g[2], along=g[3]) for g in gathered]


def _through(part: _Part, rows: Index, stations: int) -> tuple[Index, Array, Array]:
    """Points (lateral places, stations, k), shares (k,) and levers (k,) of the cells that lie on each other."""
    first, thickness = int(rows[0]), float(part.thickness[rows].sum())
    places = part.ends[first]
    points, pieces, heights = [], [], []
    for row in rows:
        apart = np.linalg.norm(part.ends[row].mean(axis=0)[None] - places.mean(axis=0)[:, None], axis=-1)
        flipped = np.linalg.norm(part.ends[row][0] - places[0]) > np.linalg.norm(part.ends[row][1] - places[0])
        here = part.points(int(row), stations)[apart.argmin(axis=1)]
        points.append(here[:, ::-1] if flipped else here)
        pieces.append(_WEIGHTS[np.argsort(_GAUSS)] * part.thickness[row])
        level = (part.ends[row].mean(axis=(0, 1)) - places.mean(axis=(0, 1))) @ part.direction[first]
        turned = np.sign(part.direction[row] @ part.direction[first])
        heights.append(level + turned * (np.sort(_GAUSS) - 0.5) * part.thickness[row])
    shares, height = np.concatenate(pieces) / thickness, np.concatenate(heights)
    return np.concatenate(points, axis=-1), shares, 2.0 * (height - shares @ height) / thickness


def _stations(beside: Array, wanted: float) -> Array:
    """Weights of a cell's lateral places, one row for each line that counts: those away from the edge, and the places
    ``wanted`` from it that lie within the cell. beside : distances of the places from the edge [m]
    """
    chosen = [np.eye(len(beside))[k] for k in np.flatnonzero(beside >= wanted)]
    peak = int(beside.argmax())
    for end in {0, len(beside) - 1} - {peak}:
        if beside[end] < wanted < beside[peak]:
            way = np.arange(end, peak + np.sign(peak - end), np.sign(peak - end))
            chosen.append(_lagrange(_MIDDLE_AND_ENDS, np.interp(wanted, beside[way], _MIDDLE_AND_ENDS[way])))
    return np.array(chosen).reshape(-1, len(beside))


def _lagrange(nodes: Array, x: np.floating | float) -> Array:
    """Lagrange polynomials of the nodes at x, (n,)."""
    return np.array([np.prod((x - np.delete(nodes, k)) / (node - np.delete(nodes, k))) for k, node in enumerate(nodes)])
