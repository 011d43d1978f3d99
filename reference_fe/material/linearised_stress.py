"""Stress linearised through the thickness of strips, at a distance from their joints: a measure that has a limit.

At a weld's end the elastic stress is singular: its largest value rises with every refinement. What bends and stretches
the strip does not: through the thickness T, with s from the middle, the Cauchy stress is replaced by

    sigma_m + sigma_b 2 s / T,   sigma_m = (1 / T) int sigma ds,   sigma_b = (6 / T^2) int sigma s ds

(membrane plus bending on a stress classification line: ASME BPVC VIII-2, annex 5-A, from memory), and the von Mises
stress of its two ends counts. Along the strip, as `stress.StressRecovery` explains, the Gauss stations of each cell
tell the truth; where a cell reaches into the neighbourhood of nodes where parts are joined, the line's stress is
extrapolated from them to the place ``distance`` thicknesses away. Lines within a joint are left out.
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
from reference_fe.material.hyperelastic import cauchy_stress
from reference_fe.material.point_evaluation import PointEvaluation
from reference_fe.problem.static_problem import StaticProblem

__all__ = ["LinearisedStress"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_GAUSS, _WEIGHTS = (rule.ravel() for rule in api.gauss_rule((3,)))
_ACROSS = np.array([0.0, *np.sort(_GAUSS), 1.0])
"""Places of a cell's second and third axis: Gauss points through the thickness, ends and middle along the axle."""
_THROUGH, _LATERAL = [1, 2, 3], [0, 2, 4]
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

    Verified by tests/verification/test_fe_linearised_stress.py: bending of the elastica ring, several cells through the
    thickness, and the limit under refinement.
    """

    def __init__(self, problem: StaticProblem, parts: Sequence[str], distance: float = 1.0) -> None:
        domain = problem.domain
        self._mesh, self._tagged = domain.mesh, domain.tagged
        self._own = np.arange(domain.mesh.topology.index_map(domain.dim).size_local, dtype=np.int32)
        self._original = domain.mesh.topology.original_cell_index[self._own].astype(np.int64)
        along = np.sort(api.gauss_rule((problem.discretisation.gauss_points[0],))[0].ravel())
        law = problem.discretisation.law
        stress = cauchy_stress(law, problem.u, problem.lame, problem.stretch, problem.transverse_strain)
        self._stress = PointEvaluation(stress, _points(along, domain.dim))
        ends = PointEvaluation(api.ufl.SpatialCoordinate(domain.mesh), _points(np.array([0.0, 1.0]), domain.dim))
        places = self._of_all(ends(domain.mesh, self._own))
        self._lines = {part: _lines(_Part(self._tagged, part, places), along, distance) for part in parts}

    def largest_by_part(self) -> dict[str, float]:
        """Largest linearised von Mises stress [Pa]; 0 for a part all of whose lines are left out."""
        stress = self._of_all(self._stress(self._mesh, self._own))
        stress = stress.reshape(-1, 3, 3)
        return {part: max((one.largest(stress) for one in lines), default=0.0) for part, lines in self._lines.items()}

    def _of_all(self, mine: Array) -> Array:
        """Values (n_cells, n_points, ...) at the points of the tagged mesh's cells, from those of own cells."""
        whole = np.zeros((len(self._tagged.cells), *mine.shape[1:]))
        whole[self._original] = mine
        return whole if self._mesh.comm.size == 1 else np.asarray(self._mesh.comm.allreduce(whole))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Lines:
    """Lines through the thickness at Gauss stations, and places between them where their stress is judged.

    points : (m, g, k), k points through the thickness at g stations of the same cells
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
        self.joined = np.zeros(len(grid), dtype=bool)
        self.joined[self.owners[np.isin(self.faces, self.joints).all(axis=1)]] = True

    def stacks(self) -> list[Index]:
        """Rows of the cells that lie on each other: they share a broad face."""
        _, same = np.unique(self.faces, axis=0, return_inverse=True)
        order = np.argsort(same.ravel(), kind="stable")
        meets = np.diff(same.ravel()[order]) == 0
        a, b = self.owners[order][:-1][meets], self.owners[order][1:][meets]
        links = coo_array((np.ones(len(a)), (a, b)), shape=(len(self.cells),) * 2)
        label = connected_components(links, directed=False)[1]
        return np.split(np.argsort(label, kind="stable"), np.cumsum(np.bincount(label))[:-1])

    def points(self, row: int, stations: int) -> Index:
        """Points through the thickness of one cell, (lateral places, stations, 3)."""
        counts = (stations, *[len(_ACROSS)] * (self.mesh.dim - 1))
        numbers = np.arange(math.prod(counts)).reshape(counts) + math.prod(counts) * self.cells[row]
        through = np.moveaxis(numbers, 1 + int(self.axis[row]), -1)[..., _THROUGH]
        lines = through[None] if self.mesh.dim == 2 else np.moveaxis(through[:, _LATERAL], 1, 0)
        return np.asarray(lines, dtype=np.int64)


def _points(along: Array, dim: int) -> Array:
    """Points of the reference cell, the last axis fastest, (n, dim)."""
    grids = np.meshgrid(along, *[_ACROSS] * (dim - 1), indexing="ij")
    return np.stack(grids, axis=-1).reshape(-1, dim)


def _lines(part: _Part, along: Array, distance: float) -> list[_Lines]:
    """The lines of a part that count, those of as many cells through the thickness together."""
    tree = cKDTree(part.mesh.points[part.joints]) if len(part.joints) else None
    found: list[tuple[Index, Array, Array, Array]] = []
    for rows in part.stacks():
        if part.joined[rows].any():
            continue
        first, thickness = int(rows[0]), float(part.thickness[rows].sum())
        places = part.ends[first]
        points, pieces, heights = [], [], []
        for row in rows:
            near = np.linalg.norm(part.ends[row].mean(axis=0)[None] - places.mean(axis=0)[:, None], axis=-1).argmin(
                axis=1
            )
            flipped = np.linalg.norm(part.ends[row][0] - places[0]) > np.linalg.norm(part.ends[row][1] - places[0])
            here = part.points(int(row), len(along))[near]
            points.append(here[:, ::-1] if flipped else here)
            pieces.append(_WEIGHTS[np.argsort(_GAUSS)] * part.thickness[row])
            level = (part.ends[row].mean(axis=(0, 1)) - places.mean(axis=(0, 1))) @ part.direction[first]
            turned = np.sign(part.direction[row] @ part.direction[first])
            heights.append(level + turned * (np.sort(_GAUSS) - 0.5) * part.thickness[row])
        shares, height = np.concatenate(pieces) / thickness, np.concatenate(heights)
        levers = 2.0 * (height - shares @ height) / thickness
        lines = np.concatenate(points, axis=-1)
        beside = np.full(places.shape[:2], distance * thickness)
        if tree is not None:
            beside = np.sqrt(np.maximum(tree.query(places)[0] ** 2 - 0.25 * thickness**2, 0.0))
        for end in (0, 1):
            near, far, wanted = beside[end], beside[1 - end], distance * thickness
            beyond = near < wanted
            kept = ~beyond | (far > wanted)
            share = (wanted - near)[beyond & kept] / (far - near)[beyond & kept]
            station = np.full(len(lines), along[-end])
            station[beyond & kept] = np.abs(end - share)
            weights = np.stack([_lagrange(along, x) for x in station])
            wide = (len(lines), len(shares))
            each = lines, np.broadcast_to(shares, wide), np.broadcast_to(levers, wide), weights
            found.append((each[0][kept], each[1][kept], each[2][kept], each[3][kept]))
    depths = sorted({each[0].shape[-1] for each in found})
    groups = [zip(*(each for each in found if each[0].shape[-1] == depth), strict=True) for depth in depths]
    gathered = [[np.concatenate(list(arrays)) for arrays in group] for group in groups]
    return [_Lines(points=g[0], shares=g[1], levers=g[2], along=g[3]) for g in gathered if len(g[0])]


def _lagrange(nodes: Array, x: float) -> Array:
    """Lagrange polynomials of the nodes at x, (n,)."""
    return np.array([np.prod((x - np.delete(nodes, k)) / (node - np.delete(nodes, k))) for k, node in enumerate(nodes)])
