"""Hexahedra of sidewall springs, node to node with the rim they are welded to.

Verified by tests/unit/test_geometry_sidewall.py and tests/verification/test_fe_amalia.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.assembly import RawMesh
from geometry.hexahedra import reference_nodes
from geometry.resolution import MeshSize, Ring, axial_bands, sidewall_angles
from geometry.sidewall import Profile, SidewallSprings, sidewall_profile, weld_half_angle
from geometry.wheel import WheelDesign

__all__ = ["LEAST_PER_ARC", "LEAST_PER_CURL", "elements_along", "sidewall_cells"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

LEAST_PER_CURL = 4
LEAST_PER_ARC = 8
"""Elements along the half circle of the curl and along the arc, at the least."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Strip:
    """What all strips share: section across, centreline along, cells of one strip in its own node numbers.

    Attributes
    ----------
    cells : (n_along, n_across * n_thickness, 8 or 27) int
    end : (n_across * n_thickness, 4) int, corner nodes of the facets at the weld's inner end
    clamped : elements along the clamp
    """

    profile: Profile
    depths: Array
    cells: Index
    end: Index
    clamped: int


def sidewall_cells(
    design: WheelDesign, size: MeshSize, rim: tuple[Ring, Array], order: int, half_width: bool
) -> RawMesh:
    """Mesh every strip: weld and free length as the springs' part, the clamped ends as ``outer_hub``.

    Parameters
    ----------
    design : a wheel with sidewall springs
    size : element sizes
    rim : the rim's division: ring cut at the strips' flanks, axial positions where the section changes [m]
    order : 1 or 2
    half_width : only the strips at y > 0; a weld that reaches y = 0 then ends in the face group ``"symmetry"``
    """
    springs, (ring, levels) = design.sidewall_springs, rim
    assert springs is not None
    weld = _weld_positions(design, springs, size, levels, order)
    points: list[Array] = []
    parts: list[tuple[str, Index]] = []
    ends: list[Index] = []
    for middle in sidewall_angles(springs):
        angles = _angles_across(ring, middle, weld_half_angle(springs, design.tire.inner_radius), order)
        strip = _strip(springs, design.tire.inner_radius, (weld, len(angles)), size, order)
        for side in (1.0,) if half_width else (1.0, -1.0):
            first = sum(len(p) for p in points)
            points.append(_nodes(strip, angles, middle, (side, design.tire.inner_radius)))
            free = len(strip.cells) - strip.clamped
            for part, cells in ((springs.name, strip.cells[:free]), ("outer_hub", strip.cells[free:])):
                parts.append((part, cells.reshape(-1, cells.shape[-1]) + first))
            ends.append(strip.end + first)
    at_symmetry = half_width and weld[0] < 1e-9
    return RawMesh(
        points=np.concatenate(points),
        cells=parts,
        quadrangles=[("symmetry", quads) for quads in ends] if at_symmetry else [],
    )


def _weld_positions(design: WheelDesign, springs: SidewallSprings, size: MeshSize, levels: Array, order: int) -> Array:
    """Axial positions [m] of the rim's nodes on the weld, increasing."""
    edge = 0.5 * design.tire.width
    inner = edge - springs.weld_length
    pieces = [
        np.linspace(low, high, order * n + 1)
        for low, high, n in axial_bands(design, size, levels)
        if low > inner - 1e-9 and high < edge + 1e-9
    ]
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])


def _angles_across(ring: Ring, middle: float, half: float, order: int) -> Array:
    """Angles [rad] from ``middle`` of the rim's nodes under the strip centred there, increasing."""
    angles = [-half]
    for i in ring.span(middle - half, middle + half):
        n, start = order * int(ring.counts[i]), angles[-1]
        angles += [start + ring.step(i) * k / n for k in range(1, n + 1)]
    return np.array(angles)


def _strip(springs: SidewallSprings, rim: float, rows: tuple[Array, int], size: MeshSize, order: int) -> _Strip:
    """Divide one strip; ``rows`` are the positions on the weld and the number of nodes across."""
    weld, n_across = rows
    counts = elements_along(springs, size)
    curl, arc, clamp = (order * n for n in counts)
    profile = sidewall_profile(springs, rim, weld, (curl, arc, clamp))
    depths = springs.thickness * np.linspace(-0.5, 0.5, order * size.thickness_elements + 1)
    cells = _lattice_cells((len(profile.points), n_across, len(depths)), order)
    at_end = np.flatnonzero(reference_nodes(8)[:, 0] < 0.0)
    return _Strip(profile=profile, depths=depths, cells=cells, end=cells[0][:, at_end], clamped=counts[2])


def elements_along(springs: SidewallSprings, size: MeshSize) -> list[int]:
    """Elements along curl, arc and clamp of a strip."""
    largest = size.of(springs.name)
    lengths = math.pi * springs.curl_radius, springs.sweep * springs.arc_radius, springs.clamp_length
    return [
        size.refined(max(least, math.ceil(length / largest - 1e-6)))
        for least, length in zip((LEAST_PER_CURL, LEAST_PER_ARC, 1), lengths, strict=True)
    ]


def _lattice_cells(shape: tuple[int, int, int], order: int) -> Index:
    """Cells of a lattice of nodes, (n_along, n_across * n_thickness, 8 or 27), in its flat numbering."""
    number = np.arange(math.prod(shape)).reshape(shape)
    local = np.rint((reference_nodes(8 if order == 1 else 27) + 1.0) * 0.5 * order).astype(np.int64)
    first = np.stack(np.meshgrid(*(np.arange(0, n - 1, order) for n in shape), indexing="ij"), axis=-1)
    at = first[..., None, :] + local
    cells: Index = number[at[..., 0], at[..., 1], at[..., 2]]
    return cells.reshape(cells.shape[0], -1, cells.shape[-1])


def _nodes(strip: _Strip, angles: Array, middle: float, place: tuple[float, float]) -> Array:
    """Positions (n, 3) [m] of a strip's nodes, at the side and for the rim radius given by ``place``.

    Across the strip a node at the angle a of the rim lies at the chord R sin a; its depth below the mid-surface's
    tangent plane, R (1 - cos a) on the rim, fades out as the strip flattens (R: mid-surface of the weld).
    """
    side, rim = place
    radius = rim - 0.5 * float(strip.depths[-1] - strip.depths[0])
    flat, a, depth = strip.profile.flatness[:, None, None], angles[None, :, None], strip.depths[None, None, :]
    chord = (radius + (1.0 - flat) * depth + flat * (rim - radius)) * np.sin(a)
    normal = depth - (1.0 - flat) * (radius + depth) * (1.0 - np.cos(a))
    plane = strip.profile.points[:, None, None, :] + normal[..., None] * strip.profile.normals[:, None, None, :]
    y, r = side * plane[..., 0], plane[..., 1]
    x, z = r * math.sin(middle) + chord * math.cos(middle), -r * math.cos(middle) + chord * math.sin(middle)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)
