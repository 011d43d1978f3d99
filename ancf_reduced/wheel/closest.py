"""Closest points on the faces of plates.

Verified by tests/unit/test_ancf_wheel_contacts.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ancf_reduced.compiled import compiled
from ancf_reduced.thin_plates.plates import ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_rows, shape_tables

__all__ = ["Moved", "PlateFace", "neighbours"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_SAMPLES = 4
"""Of a face along each axis, from which the search for a closest point begins."""
_WALK = 12
"""Steps of that search."""
_STRIDE = 0.7
"""Longest step, in the plate's length [-]."""
_ARRIVED = 1e-13
"""Step that ends it [-]."""
_BEYOND = 1e-3
"""How far past a plate's edge a closest point may lie, in the plate's length [-]."""


class Moved:
    """How far any point of some plates may have moved since the nodes were where they were last remembered."""

    def __init__(self, plates: ThinPlates, height: float) -> None:
        L1, L2 = 0.25 * plates.sizes.T
        self._plates = plates.plates
        # cubics: those of places are a share of one, those of slopes add up to a quarter of the length
        self._bound = np.stack([np.ones_like(L1), L1 + height, L2 + height, L1 * L2], axis=1)
        self._at = plates.reference.copy()

    def __call__(self, q: Array) -> float:
        """Upper bound [m] at nodes q (n_nodes, 4, 3); of points on faces for turns that are not large."""
        change = np.linalg.norm(q - self._at, axis=2)[self._plates].max(axis=1)
        return float((change * self._bound).sum(axis=1).max(initial=0.0))

    def remember(self, q: Array) -> None:
        """Count from here."""
        self._at = q.copy()


class PlateFace:
    """Closest points on one side of some plates, found along their neighbours.

    Parameters
    ----------
    plates : the network
    which : plates of the face
    heights : (n_plates,) of the face along each plate's normal [m]
    """

    def __init__(self, plates: ThinPlates, which: Index, heights: Array) -> None:
        self.which, self.heights = which, heights
        self.plates = plates
        at = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        self._starts = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
        self._tables = shape_tables(
            np.repeat(plates.sizes[which], len(self._starts), axis=0).T, *np.tile(self._starts, (len(which), 1)).T
        )[:, 0].reshape(len(which), len(self._starts), 16)
        self._beside = neighbours(plates.plates, which)
        self._sample = 0.7 * float(np.linalg.norm(plates.sizes[which].max(axis=0, initial=0.0))) / _SAMPLES

    def samples(self, q: Array) -> Array:
        """Points (n, 3) [m] all over the middle surface at nodes q (n_nodes, 4, 3)."""
        local = q[self.plates.plates[self.which]].reshape(len(self.which), 16, 3)
        return np.asarray(np.einsum("esk,eki->esi", self._tables, local).reshape(-1, 3))

    def near(self, q: Array, points: Array, reach: float) -> tuple[Index, Index]:
        """Points (n, 3) that may have a closest one within ``reach`` [m] of the middle surface, and samples by them."""
        if not len(points) or not len(self.which):
            return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
        far, sample = cKDTree(self.samples(q)).query(points, distance_upper_bound=reach + self._sample)
        found = np.flatnonzero(np.isfinite(far))
        return found, np.asarray(sample)[found]

    def closest(self, q: Array, points: Array, reach: float) -> tuple[Index, Index, Array]:
        """Closest points of those points (n, 3) that have one within ``reach`` [m] of the middle surface, and more.

        Returns numbers of the points (m,), plates (m,), and rows (m, 6, 16) of `shape_tables` there.
        """
        found, sample = self.near(q, points, reach)
        if not len(found):
            return found, found, np.empty((0, 6, 16))
        inside, plate, rows = self.reached(q, points[found], sample)
        return found[inside], plate, rows

    def reached(self, q: Array, points: Array, samples: Index) -> tuple[Index, Index, Array]:
        """As `closest`, of points (n, 3) from samples (n,) near them."""
        count, n = len(self._starts), len(points)
        plate, place = self.which[samples // count], self._starts[samples % count].copy()
        inside, rows = np.empty(n, dtype=np.bool_), np.empty((n, 6, 16))
        _walk(q, (self.plates.plates, self.plates.sizes, self._beside), points, (plate, place), (inside, rows))
        kept = np.flatnonzero(inside)
        return kept, plate[kept], rows[kept]


@compiled
def _walk(
    q: Array,
    face: tuple[Index, Array, Index],
    points: Array,
    start: tuple[Index, Array],
    found: tuple[NDArray[np.bool_], Array],
) -> None:
    """Newton's search for the closest points from plates and places on, over edges to their neighbours.

    Parameters
    ----------
    face : nodes and sizes of all plates, and their neighbours (n_plates, 4)
    start : plates (n,) and places (n, 2) in [0, 1], overwritten
    found : whether there is one (n,), rows of `shape_tables` there (n, 6, 16)
    """
    nodes, sizes, beside = face
    plates, places = start
    inside, rows = found
    v, ahead = np.empty((6, 3)), np.empty(2)
    for p in range(points.shape[0]):
        plate, u = plates[p], places[p]
        for _ in range(_WALK):
            shape_rows(sizes[plate], u, rows[p])
            for d in range(6):
                for i in range(3):
                    v[d, i] = 0.0
                    for k in range(16):
                        v[d, i] += rows[p, d, k] * q[nodes[plate, k // 4], k % 4, i]
            off = points[p] - v[0]
            s1, s2 = np.dot(off, v[1]), np.dot(off, v[2])
            b11 = np.dot(v[1], v[1]) - np.dot(off, v[3])
            b12 = np.dot(v[1], v[2]) - np.dot(off, v[4])
            b22 = np.dot(v[2], v[2]) - np.dot(off, v[5])
            safe = b11 * b22 - b12 * b12
            safe = safe if abs(safe) > 1e-6 else 1.0
            ahead[0], ahead[1] = (b22 * s1 - b12 * s2) / safe, (b11 * s2 - b12 * s1) / safe
            largest = 0.0
            for axis in range(2):
                ahead[axis] = min(max(ahead[axis] / sizes[plate, axis], -_STRIDE), _STRIDE)
                largest = max(largest, abs(ahead[axis]))
            if largest < _ARRIVED:
                break
            for axis in range(2):
                u[axis] += ahead[axis]
            for axis in range(2):
                for end in range(2):
                    out = u[axis] > 1.0 if end else u[axis] < 0.0
                    following = beside[plate, 2 * axis + end]
                    if out and following >= 0:
                        u[axis] = 1 - end + (u[axis] - end) * sizes[plate, axis] / sizes[following, axis]
                        plate = following
                u[axis] = min(max(u[axis], -2.0 * _BEYOND), 1.0 + 2.0 * _BEYOND)
        plates[p] = plate
        inside[p] = min(u[0], u[1]) > -_BEYOND and max(u[0], u[1]) < 1.0 + _BEYOND
        shape_rows(sizes[plate], u, rows[p])


def neighbours(nodes: Index, which: Index) -> Index:
    """Plates of ``which`` beyond the edges u = 0, u = 1, v = 0, v = 1 of every plate (n_plates, 4); -1 for none."""
    ends = ((0, 1), (2, 3)), ((0, 2), (1, 3))
    beside = np.full((len(nodes), 4), -1)
    for axis, (low, high) in enumerate(ends):
        first = {tuple(nodes[k, low]): k for k in which.tolist()}
        for k in which.tolist():
            ahead = first.get(tuple(nodes[k, high]))
            if ahead is not None:
                beside[k, 2 * axis + 1], beside[ahead, 2 * axis] = ahead, k
    return beside
