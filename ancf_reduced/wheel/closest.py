"""Closest points on the faces of plates.

Verified by tests/unit/test_ancf_wheel_contacts.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ancf_reduced.thin_plates.plates import ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_tables

__all__ = ["PlateFace", "neighbours"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_SAMPLES = 4
"""Of a face along each axis, from which the search for a closest point begins."""
_WALK = 12
"""Steps of that search."""
_BEYOND = 1e-3
"""How far past a plate's edge a closest point may lie, in the plate's length [-]."""


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

    def samples(self, q: Array) -> Array:
        """Points (n, 3) [m] all over the middle surface at nodes q (n_nodes, 4, 3)."""
        local = q[self.plates.plates[self.which]].reshape(len(self.which), 16, 3)
        return np.asarray(np.einsum("esk,eki->esi", self._tables, local).reshape(-1, 3))

    def closest(self, q: Array, points: Array, reach: float) -> tuple[Index, Index, Array]:
        """Closest points of those points (n, 3) that have one within ``reach`` [m] of the middle surface, and more.

        Returns numbers of the points (m,), plates (m,), and rows (m, 6, 16) of `shape_tables` there.
        """
        if not len(points) or not len(self.which):
            return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64), np.empty((0, 6, 16))
        beside = 0.7 * float(np.linalg.norm(self.plates.sizes[self.which].max(axis=0))) / _SAMPLES
        tree = cKDTree(self.samples(q))
        far, sample = (np.asarray(a) for a in tree.query(points, distance_upper_bound=reach + beside))
        found = np.flatnonzero(np.isfinite(far))
        count = len(self._starts)
        plate, place = self.which[sample[found] // count], self._starts[sample[found] % count].copy()
        x, sizes = points[found], self.plates.sizes
        for _ in range(_WALK):
            tables = shape_tables(sizes[plate].T, *place.T)
            local = q[self.plates.plates[plate]].reshape(len(plate), 16, 3)
            r, r1, r2, r11, r12, r22 = np.moveaxis(np.einsum("ndk,nki->ndi", tables, local), 1, 0)
            off = x - r
            slope = np.stack([(off * a).sum(-1) for a in (r1, r2)], axis=-1)
            bend = np.stack([(r1 * r1 - off * r11), (r1 * r2 - off * r12), (r2 * r2 - off * r22)]).sum(-1)
            safe = bend[0] * bend[2] - bend[1] ** 2
            step = (
                np.stack(
                    [(bend[2] * slope[:, 0] - bend[1] * slope[:, 1]), (bend[0] * slope[:, 1] - bend[1] * slope[:, 0])],
                    axis=-1,
                )
                / np.where(np.abs(safe) > 1e-6, safe, 1.0)[:, None]
            )
            step = np.clip(step / sizes[plate], -0.7, 0.7)
            if np.abs(step).max(initial=0.0) < 1e-13:
                break
            place = place + step
            plate, place = self._walk(plate, place)
        inside = ((place > -_BEYOND) & (place < 1.0 + _BEYOND)).all(axis=1)
        tables = shape_tables(sizes[plate[inside]].T, *place[inside].T)
        return found[inside], plate[inside], tables

    def _walk(self, plate: Index, place: Array) -> tuple[Index, Array]:
        """On to the neighbour where a place has left its plate; to the edge's margin where there is none."""
        sizes = self.plates.sizes
        for axis in (0, 1):
            for end in (0, 1):
                out = place[:, axis] > 1.0 if end else place[:, axis] < 0.0
                next_one = self._beside[plate, 2 * axis + end]
                there = out & (next_one >= 0)
                beyond = (place[there, axis] - end) * sizes[plate[there], axis] / sizes[next_one[there], axis]
                place[there, axis] = 1 - end + beyond
                plate = np.where(there, next_one, plate)
        return plate, np.clip(place, -2.0 * _BEYOND, 1.0 + 2.0 * _BEYOND)


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
