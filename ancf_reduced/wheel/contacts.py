"""Contact of points on the faces of an ANCF wheel with rigid surfaces and with plates.

Each contact is a row: a gap, its slopes, a penalty. Which of a wheel's parts touch is in `inner_contacts`. Verified by
tests/unit/test_ancf_wheel_contacts.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, vstack

from ancf_reduced.thin_plates.shape_functions import shape_tables
from ancf_reduced.wheel.closest import PlateFace
from ancf_reduced.wheel.contact_kernels import Faces, face_points, face_slopes, plate_gaps, rigid_gaps
from ancf_reduced.wheel.faces import FacePoints
from ancf_reduced.wheel.mesh import AncfWheel

__all__ = [
    "SKIN",
    "HubContact",
    "Near",
    "PlateContact",
    "Points",
    "Surface",
    "joined",
]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_INNER_REACH = 2e-3
"""Gap up to which a point may touch within one step [m]."""
_LEAST_GAP = 10e-6
"""Points closer than this to a face at the beginning, beside a weld, are left out [m]."""
_DEPTH = 5e-3
"""How far behind a face a point is still held off [m]."""
SKIN = 4e-3
"""Movement of both sides together for which a search of what is near looks ahead [m]."""
_FACING = 0.5
"""Largest cosine between the normals of a point's face and of the one it touches [-]."""

Entries = tuple[Index, Index, Array]
"""Rows, columns and values of a sparse matrix; those of one place add up."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A rigid surface at contacts: normals (n, 3), bends (n, 3, 3) [1/m], places (n, 3) [m] of the points there."""

    normals: Array
    bends: Array
    places: Array


@dataclass(frozen=True, slots=True, eq=False)
class Near:
    """Contacts that may touch within a step: their numbers, gaps [m], slopes (n, size), penalties [N/m].

    And what their forces add to the tangent, and where they lie on a rigid surface.
    """

    points: Index
    gaps: Array
    slopes: csr_array
    stiffness: Array
    tangent: Entries | None = None
    surface: Surface | None = None


def joined(parts: Sequence[Near], counts: Sequence[int]) -> Near:
    """All of them, with numbers that follow one another."""
    starts = np.concatenate([[0], np.cumsum(counts)])[:-1]
    tangents = [part.tangent for part in parts if part.tangent is not None]
    return Near(
        points=np.concatenate([part.points + start for part, start in zip(parts, starts, strict=True)]),
        gaps=np.concatenate([part.gaps for part in parts]),
        slopes=csr_array(vstack([part.slopes for part in parts], format="csr")),
        stiffness=np.concatenate([part.stiffness for part in parts]),
        tangent=_together(tangents) if tangents else None,
    )


def _together(parts: Sequence[Entries]) -> Entries:
    rows, columns, values = (np.concatenate(each) for each in zip(*parts, strict=True))
    return rows, columns, values


class Points:
    """Points on faces, as kernels take them."""

    def __init__(self, wheel: AncfWheel, points: FacePoints) -> None:
        self.plates = wheel.plates
        self.area = points.area
        tables = shape_tables(wheel.plates.sizes[points.plate].T, *points.at.T)[:, :3]
        self.faces: Faces = points.plate, points.height, np.ascontiguousarray(tables)

    def of(self, which: Index) -> Faces:
        """Some of them."""
        plate, height, tables = self.faces
        return plate[which], height[which], tables[which]

    def at(self, q: Array, which: Index | None = None) -> tuple[Array, Array]:
        """Places (n, 3) [m] and outward normals (n, 3)."""
        faces = self.faces if which is None else self.of(which)
        places, normals = np.empty((len(faces[0]), 3)), np.empty((len(faces[0]), 3))
        face_points(q, self.plates.plates, faces, places, normals)
        return places, normals

    def rigid(
        self,
        q: Array,
        near: tuple[Index, Index],
        gaps: Array,
        surface: tuple[Array, Array],
        held: tuple[float | Array, Array, Array],
    ) -> Near:
        """Contacts with a rigid surface.

        near : points and numbers of the contacts; surface : normals and bends; held : penalty of all or each [N/m^3],
        forces of all contacts, blocks of plates
        """
        (points, numbers), (penalty, forces, blocks) = near, held
        slopes = np.empty((len(points), 16, 3))
        rigid_gaps(q, self.plates.plates, self.of(points), surface, forces[numbers], slopes, blocks)
        columns, starts = self.plates.numbers[self.faces[0][points]], 48 * np.arange(len(points) + 1)
        G = csr_array((slopes.ravel(), columns.ravel(), starts), shape=(len(points), self.plates.size))
        return Near(numbers, gaps, G, penalty * self.area[points])

    def slopes(self, q: Array, which: Index) -> csr_array:
        """Derivatives (3 n, size) of the places of some of them by all coordinates."""
        slopes = np.empty((len(which), 3, 16, 3))
        face_slopes(q, self.plates.plates, self.of(which), slopes)
        columns = np.repeat(self.plates.numbers[self.faces[0][which]], 3, axis=0)
        starts = 48 * np.arange(3 * len(which) + 1)
        return csr_array((slopes.ravel(), columns.ravel(), starts), shape=(3 * len(which), self.plates.size))


class HubContact:
    """Springs and rim on the hub: a cylinder about the axle."""

    def __init__(self, wheel: AncfWheel, faces: Points, penalty: float) -> None:
        self._points, self._radius, self._penalty = faces, wheel.hub[0], penalty
        self.count = len(wheel.faces.plate)
        places = self._points.at(wheel.plates.reference)[0]
        self._asked = np.flatnonzero((self._gaps(places) > _LEAST_GAP) & (np.abs(places[:, 1]) <= wheel.hub[1]))
        self.search(wheel.plates.reference)

    def search(self, q: Array) -> None:
        """As `PlateContact.search`."""
        self._near = self._asked[self._gaps(self._points.at(q, self._asked)[0]) < _INNER_REACH + SKIN]

    def _gaps(self, places: Array) -> Array:
        return np.asarray(np.hypot(places[:, 0], places[:, 2]) - self._radius)

    def near(self, q: Array, forces: Array, blocks: Array) -> Near:
        places, _ = self._points.at(q, self._near)
        gaps = self._gaps(places)
        kept = np.flatnonzero((gaps < _INNER_REACH) & (gaps > -_DEPTH))
        outwards = places[kept] * [1.0, 0.0, 1.0]
        rho = np.linalg.norm(outwards, axis=1)
        normals = outwards / rho[:, None]
        flat = np.diag([1.0, 0.0, 1.0]) - normals[:, :, None] * normals[:, None, :]
        surface = normals, flat / rho[:, None, None]
        held = self._penalty, forces, blocks
        return self._points.rigid(q, (self._near[kept], self._near[kept]), gaps[kept], surface, held)


class PlateContact:
    """Some points on the faces of some plates.

    Parameters
    ----------
    faces : points on all faces
    points : their numbers
    face : what they may touch
    """

    def __init__(self, wheel: AncfWheel, faces: Points, points: Index, face: PlateFace, penalty: float) -> None:
        self._points, self._of, self._face, self._penalty = faces, points, face, penalty
        self.count = len(points)
        self._reach = max(_INNER_REACH, _DEPTH) + float(np.abs(face.heights[face.which]).max(initial=0.0))
        self._asked = np.arange(len(points))
        self.search(wheel.plates.reference)
        numbers, gaps = self._found(wheel.plates.reference, _LEAST_GAP)[:2]
        self._asked = np.setdiff1d(self._asked, numbers[gaps < _LEAST_GAP])
        self.search(wheel.plates.reference)

    def search(self, q: Array) -> None:
        """Which points are near at nodes q, and may be until both sides have moved by `SKIN` together."""
        places, _ = self._points.at(q, self._of[self._asked])
        found, self._samples = self._face.near(q, places, self._reach + SKIN)
        self._near = self._asked[found]

    def _found(self, q: Array, reach: float) -> tuple[Index, Array, Index, Array]:
        """Numbers among the points, gaps, plates and their rows of what is nearer than ``reach`` [m]."""
        face, plates = self._face, self._points.plates
        places, normals = self._points.at(q, self._of[self._near])
        number, plate, rows = face.reached(q, places, self._samples)
        local = q[plates.plates[plate]].reshape(len(plate), 16, 3)
        r, r1, r2 = np.moveaxis(np.einsum("ndk,nki->ndi", rows[:, :3], local), 1, 0)
        N = np.cross(r1, r2) * np.sign(face.heights[plate])[:, None]
        N /= np.linalg.norm(N, axis=1)[:, None]
        gaps = ((places[number] - r) * N).sum(axis=1) - np.abs(face.heights[plate])
        cosine = (normals[number] * N).sum(axis=1)
        kept = (gaps < reach) & (gaps > -_DEPTH) & (cosine < _FACING)
        return self._near[number[kept]], gaps[kept], plate[kept], rows[kept]

    def near(self, q: Array, forces: Array, blocks: Array) -> Near:
        """Contacts within reach, with the tangent of two plates each that forces (count,) add."""
        plates = self._points.plates
        if not len(self._near):
            return Near(self._near, np.empty(0), csr_array((0, plates.size)), np.empty(0))
        numbers, gaps, other, rows = self._found(q, _INNER_REACH)
        own, heights, tables = self._points.of(self._of[numbers])
        pairs, block = np.unique(np.stack([own, other], axis=-1).reshape(-1, 2), axis=0, return_inverse=True)
        slopes, tangent = np.empty((len(numbers), 32, 3)), np.zeros((len(pairs), 32, 3, 32, 3))
        masters = other, self._face.heights[other], rows
        plate_gaps(
            q,
            plates.plates,
            (own, heights, tables),
            masters,
            forces[numbers],
            block.ravel(),
            (gaps, slopes),
            tangent,
        )
        columns = np.concatenate([plates.numbers[own], plates.numbers[other]], axis=1)
        G = coo_array(
            (slopes.ravel(), (np.repeat(np.arange(len(own)), 96), columns.ravel())), shape=(len(own), plates.size)
        )
        area = self._points.area[self._of[numbers]]
        return Near(numbers, gaps, csr_array(G), self._penalty * area, self._entries(pairs, tangent))

    def _entries(self, pairs: Index, blocks: Array) -> Entries | None:
        plates = self._points.plates
        held = blocks.any(axis=(1, 2, 3, 4))
        numbers = np.concatenate([plates.numbers[pairs[held, 0]], plates.numbers[pairs[held, 1]]], axis=1)
        rows, columns = np.repeat(numbers, 96, axis=1).ravel(), np.tile(numbers, (1, 96)).ravel()
        return (rows, columns, blocks[held].ravel()) if held.any() else None
