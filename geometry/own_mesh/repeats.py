"""Whether a wheel's own mesh repeats around its axle as often as its study says, and how round its ground faces are.

Outer faces are sampled on their own maps, bilinear or biquadratic. Verified by tests/unit/test_own_mesh_repeats.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.assembly import boundary_facets

__all__ = ["least_reach", "require_repeats"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_OFF = 1e-3
"""Distance of two surfaces that are one, over the wheel's radius [-]: a tenth of a thin strip's thickness."""
_SAMPLES = 1_000_000
_FEWEST, _MOST = 4, 10
"""Samples of a facet along each of its axes."""
_PROBED, _PROBES = 5000, np.array([-0.7, 0.0, 0.7])
"""Facets of a surface that are turned, at most, and the places along each of their axes: within, off their edges."""
_NEAREST = 12
"""Samples that a turned place is compared with: beside an edge the nearest may lie on another face."""
_BETWEEN = 0.75
"""Distance of a place from the nearest sample over the samples' [-]: half a diagonal, and some more."""
_DIRECTIONS = 1440
"""In which the reach of the ground faces is looked at."""
_CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]], dtype=float)
"""Places of a facet's nine nodes; the first four are its corners."""


def require_repeats(mesh: TaggedMesh, repeats: int) -> None:
    """Compare the wheel with itself, turned by 360 degrees over ``repeats``: each part, and each group of faces.

    What is compared are surfaces, not nodes, so a mesh without structure may repeat, too.

    Raises
    ------
    InputError
        If a turned surface lies more than 1e-3 of the wheel's radius off, with part, place and distance.
    """
    if repeats == 1:
        return
    radius, angle = float(np.hypot(mesh.points[:, 0], mesh.points[:, 2]).max()), 2.0 * math.pi / repeats
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    for what, facets in _surfaces(mesh):
        turned = _sampled(mesh, facets[:: 1 + len(facets) // _PROBED], _PROBES)[0] @ turn.T
        off = _distances(turned, *_sampled(mesh, facets, _evenly(len(facets))))
        worst = int(off.argmax())
        if off[worst] > _OFF * radius:
            x, y, z = 1e3 * turned[worst]
            turned_by = f"turned by {360.0 / repeats:g} deg it lies {1e3 * off[worst]:.3g} mm off"
            rule = f"are not what {what} has: {turned_by} at ({x:.4g}, {y:.4g}, {z:.4g}) mm of the wheel frame"
            hint = "give the number of equal sectors, 1 if there are none"
            raise InputError("equal sectors", str(repeats), rule, hint, key="repeats")


def least_reach(mesh: TaggedMesh, ground: Iterable[str]) -> float:
    """How far from the axle the ground faces reach in the direction in which they reach least [m].

    For a smooth round rim this is its radius; between two grousers, and at the middle of a polygon's edge, less.
    """
    tags = [mesh.faces[name] for name in ground]
    facets = mesh.facets[np.isin(mesh.facet_tags, tags)]
    places = _sampled(mesh, facets, _evenly(len(facets)))[0]
    angles = 2.0 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    hull = _outline(places[:, [0, 2]])
    return float(min((hull @ np.array([math.cos(a), math.sin(a)])).max() for a in angles))


def _outline(points: Array) -> Array:
    """Corners of the convex hull of points in a plane."""
    from scipy.spatial import ConvexHull

    return points[ConvexHull(points).vertices]


def _surfaces(mesh: TaggedMesh) -> Iterator[tuple[str, Index]]:
    for name, tag in mesh.parts.items():
        yield f"part {name}", boundary_facets(mesh.cells[mesh.cell_tags == tag])
    for name, tag in mesh.faces.items():
        yield f"group of faces {name}", mesh.facets[mesh.facet_tags == tag]


def _evenly(facets: int) -> Array:
    """Places along each axis of a facet, from edge to edge."""
    return np.linspace(-1.0, 1.0, int(np.clip(math.sqrt(_SAMPLES / max(facets, 1)), _FEWEST, _MOST)))


def _sampled(mesh: TaggedMesh, facets: Index, line: Array) -> tuple[Array, Array, Array]:
    """Places (n, 3) [m], unit normals (n, 3) and distances to the next samples (n,) [m] of facets' samples.

    ``line`` has their places along both axes of a facet.
    """
    at = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    shapes, along, across = _bilinear(at) if facets.shape[1] == 4 else _biquadratic(at)
    nodes = mesh.points[facets]  # (f, 4 or 9, 3)
    places, first, second = (np.einsum("qa,fac->fqc", values, nodes) for values in (shapes, along, across))
    normals = np.cross(first, second)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    apart = (line[1] - line[0]) * np.maximum(np.linalg.norm(first, axis=-1), np.linalg.norm(second, axis=-1))
    unit = normals / np.where(length > 0.0, length, 1.0)
    return places.reshape(-1, 3), unit.reshape(-1, 3), apart.reshape(-1)


def _bilinear(at: Array) -> tuple[Array, Array, Array]:
    """Shape functions of four nodes and their derivatives at places of a facet, each (q, 4)."""
    (a, b), u, v = _CORNERS[:4].T, at[:, :1], at[:, 1:]
    return 0.25 * (1.0 + a * u) * (1.0 + b * v), 0.25 * a * (1.0 + b * v), 0.25 * b * (1.0 + a * u)


def _biquadratic(at: Array) -> tuple[Array, Array, Array]:
    """The same of nine nodes, each (q, 9)."""

    def line(x: Array) -> tuple[Array, Array]:
        """Of the nodes at -1, 0 and 1, (q, 3)."""
        values = np.stack([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)], axis=1)
        return values, np.stack([x - 0.5, -2.0 * x, x + 0.5], axis=1)

    (u, du), (v, dv) = line(at[:, 0]), line(at[:, 1])
    i, j = (_CORNERS.T + 1.0).astype(np.int64)
    return u[:, i] * v[:, j], du[:, i] * v[:, j], u[:, i] * dv[:, j]


def _distances(points: Array, places: Array, normals: Array, apart: Array) -> Array:
    """Distance (n,) of points from a sampled surface [m]: to the tangent planes of samples beside them, or to samples.

    A tangent plane counts no farther from its sample than a place between four samples may lie.
    """
    from scipy.spatial import cKDTree

    distance, near = cKDTree(places).query(points, k=min(_NEAREST, len(places)))
    away = np.einsum("pkc,pkc->pk", points[:, None, :] - places[near], normals[near])
    beside = np.sqrt(np.maximum(distance**2 - away**2, 0.0))
    return np.asarray(np.where(beside <= _BETWEEN * apart[near], np.abs(away), distance).min(axis=1))
