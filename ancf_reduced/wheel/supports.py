"""What holds an ANCF wheel: hub and plane of symmetry. Verified by tests/unit/test_ancf_wheel_mesh.py."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.thin_plates.plates import ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_tables

__all__ = ["HubEnd", "free_basis", "hub_stiffness", "on_cylinder"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
_HUB_POINTS = 4
"""Of an edge on the hub: exact for cubics along it."""


@dataclass(frozen=True, slots=True, eq=False)
class HubEnd:
    """Last edge of a spring or a cone on a rigid hub, which keeps its place.

    Attributes
    ----------
    nodes, plates : of the edge, where u = 1, or v = 1 where axis 1 leaves it
    frame : columns along both axes and out of the plate's surface, one or one a node
    turning : stiffness against slopes out of that surface [N/rad], infinite: held
    leaving : axis of the plate that leaves the edge, 0 or 1
    """

    nodes: Index
    plates: Index
    frame: Array
    turning: float
    leaving: int = 0


def on_cylinder(angle: float) -> Array:
    """Columns around, along the axle, outwards, at a circumferential position [rad]."""
    sine, cosine = math.sin(angle), math.cos(angle)
    return np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [sine, 0.0, -cosine]])


def hub_stiffness(plates: ThinPlates, ends: Sequence[HubEnd]) -> csc_array:
    """Stiffness (12 n_nodes, 12 n_nodes) of last edges against slopes out of the hub's surface."""
    at, weight = np.polynomial.legendre.leggauss(_HUB_POINTS)
    blocks = np.zeros((len(plates.plates), 16, 3, 16, 3))
    for end in (one for one in ends if math.isfinite(one.turning)):
        outer = np.outer(end.frame[:, 2], end.frame[:, 2])
        for k in end.plates:
            rows = shape_tables(plates.sizes[k], np.ones(_HUB_POINTS), 0.5 + 0.5 * at)[:, 1]
            share = end.turning * plates.sizes[k, 1] * 0.5 * weight
            blocks[k] += np.einsum("p,pa,pb,ij->aibj", share, rows, rows, outer)
    return plates.assembled(blocks)


def free_basis(nodes: Array, ends: Sequence[HubEnd], *, symmetric: bool) -> csc_array:
    """Columns of free coordinates: edges on the hub keep their places, the plane of symmetry its mirror."""
    frames = np.broadcast_to(np.eye(3), (len(nodes), 3, 3)).copy()
    free = np.ones((len(nodes), 4, 3), dtype=bool)
    for end in ends:
        frames[end.nodes] = end.frame
        leaving, along = (1, 2) if end.leaving == 0 else (2, 1)
        free[end.nodes[:, None], [0, along]] = False
        if math.isinf(end.turning):
            free[end.nodes[:, None], [leaving, 3], 2] = False
    if symmetric:
        middle = np.abs(nodes[:, 0, 1]) < 1e-12
        free[middle, 0, 1] = free[middle, 1, 1] = False
        for k in (2, 3):
            free[middle, k, 0] = free[middle, k, 2] = False
    node, slot, local = np.nonzero(free)
    rows = (12 * node + 3 * slot)[:, None] + np.arange(3)
    values = frames[node, :, local]
    columns = np.repeat(np.arange(len(node)), 3)
    kept = values.ravel() != 0.0
    shape = (12 * len(nodes), len(node))
    return csc_array((values.ravel()[kept], (rows.ravel()[kept], columns[kept])), shape=shape)
