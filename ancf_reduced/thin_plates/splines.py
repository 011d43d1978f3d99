"""Thin plates become B-spline surfaces, deformed or not, and B-spline surfaces become thin plates; both exact.

A plate's surface is bicubic: its control points are P = C X C^T, with C from ends' values and slopes to a cubic's
Bezier points. So every piece of a surface of degree 3 or less is a plate, if slopes go on from piece to piece.
Verified by tests/unit/test_ancf_thin_splines.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from contracts.errors import InputError
from geometry.spline_surface import SplineSurface, bezier_surface

__all__ = ["bezier_points", "plate_surfaces", "plates_on_surface"]

Array = NDArray[np.float64]
_CORNERS = ((0, 0), (0, 1), (1, 0), (1, 1))
_KINK = 1e-6
"""Jump of a slope between pieces, over the slope, from which a surface has a kink [-]."""
_MEANT = 1e-2
"""Such a jump where a surface closes on itself, from which it is taken for a seam [-]."""


def bezier_points(plates: ThinPlates, q: Array) -> Array:
    """Control points (n, 4, 4, 3) [m] of every plate at nodes q (n_nodes, 4, 3); first index along r_1."""
    ends = [_from_ends(plates.sizes[:, axis]) for axis in range(2)]
    corners = q[plates.plates].reshape(-1, 2, 2, 2, 2, 3)  # plate, end 1, end 2, slope 2, slope 1, component
    return np.asarray(np.einsum("naik,nbjl,nijlkx->nabx", *ends, corners, optimize=True))


def _from_ends(lengths: Array) -> Array:
    """Cubic's Bezier points (n, 4) by end (2) and value or slope (2), for lengths (n,)."""
    found = np.zeros((len(lengths), 4, 2, 2))
    found[:, :2, 0, 0] = found[:, 2:, 1, 0] = 1.0
    found[:, 1, 0, 1], found[:, 2, 1, 1] = lengths / 3.0, -lengths / 3.0
    return found


def plate_surfaces(plates: ThinPlates, q: Array, names: Sequence[str]) -> tuple[SplineSurface, ...]:
    """The surface of every plate at nodes q, on 0..1 x 0..1, for `geometry.surface_step.write_surfaces_step`.

    names : of the plates' parts; a surface is called ``"{name} {number of the plate}"``
    """
    points = bezier_points(plates, q)
    return tuple(bezier_surface(f"{name} {k}", points[k]) for k, name in enumerate(names))


def plates_on_surface(
    surface: SplineSurface,
    layers: Sequence[Layer],
    subdivisions: tuple[int, int] = (1, 1),
    membrane_points: tuple[int, int] = (2, 4),
) -> ThinPlates:
    """Plates whose reference is a B-spline surface, one a piece or ``subdivisions`` of them along u and v.

    Nodes (i, j) of the grid have the number i n + j, n those along v. The plates' parameters are u and v times the
    surface's mean lengths along them over their range. ``membrane_points`` as `ThinPlates`: (4, 2) for one more curved
    along v. Where a surface closes on itself without a kink its last nodes are its first ones; with one it stays slit.

    Raises
    ------
    InputError
        For a degree above 3, a surface whose slopes jump between its pieces (a kink, or parameters of unequal speed),
        or all but closes without one, subdivisions below 1, and a surface that `ThinPlates` refuses.
    """
    if min(subdivisions) < 1:
        raise InputError("subdivisions", subdivisions, "must be 1 or more along u and v", "give (1, 1)")
    breaks = [
        np.append((b[:-1, None] + np.diff(b)[:, None] * np.arange(n) / n).ravel(), b[-1])
        for b, n in zip(surface.breaks, subdivisions, strict=True)
    ]
    pieces = surface.bezier_pieces((breaks[0], breaks[1]))
    turned = pieces, pieces.transpose(1, 0, 3, 2, 4)
    scales = [_mean_length(one) / np.ptp(b) for one, b in zip(turned, breaks, strict=True)]
    steps = [scale * np.diff(b) for scale, b in zip(scales, breaks, strict=True)]
    to_ends = [np.linalg.inv(_from_ends(step).reshape(-1, 4, 4)).reshape(-1, 2, 2, 4) for step in steps]
    corners = np.einsum("uika,vjlb,uvabx->uvijlkx", *to_ends, pieces, optimize=True)
    nodes = np.zeros((len(breaks[0]), len(breaks[1]), 2, 2, 3))
    grids = [(nodes[i : i + len(steps[0]), j : j + len(steps[1])], corners[:, :, i, j]) for i, j in _CORNERS]
    for grid, own in grids:
        grid[:] = own
    jump = max(float(np.abs(grid - own).max()) for grid, own in grids)
    if jump > _KINK * float(np.abs(nodes[:, :, 0, 1]).max()):
        rule = "must go on from piece to piece, which a kink or parameters of unequal speed prevent"
        raise InputError(f"{surface.name}: slopes", f"jump of {jump:.3g}", rule, "split the surface there")
    for axis in range(2):
        first, last = np.take(nodes, 0, axis), np.take(nodes, -1, axis)
        if len(steps[axis]) > 1 and _closed(surface.name, first, last, float(steps[axis].min())):
            nodes = np.delete(nodes, -1, axis)
    numbers = np.arange(nodes.shape[0] * nodes.shape[1]).reshape(nodes.shape[:2])
    rows = [np.arange(len(step)) for step in steps]
    ahead = [(rows[0] + i) % len(numbers) for i in range(2)], [(rows[1] + j) % numbers.shape[1] for j in range(2)]
    plates = np.stack([numbers[np.ix_(ahead[0][i], ahead[1][j])] for i, j in _CORNERS], axis=-1)
    sizes = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1)
    return ThinPlates(
        nodes.reshape(-1, 4, 3), plates.reshape(-1, 4), sizes.reshape(-1, 2), [tuple(layers)], membrane_points
    )


def _closed(name: str, first: Array, last: Array, step: float) -> bool:
    """Whether two rows of nodes (n, 2, 2, 3) meet, in places to a part of a plate's length [m], and go on smoothly.

    InputError where they meet with a kink too small to be meant; a large one is a seam that stays open.
    """
    gaps = np.abs(first - last).reshape(-1, 4, 3).max(axis=(0, 2))
    slopes, twists = (np.abs(first.reshape(-1, 4, 3)[:, rows]).max() for rows in (slice(1, 3), 3))
    if gaps[0] > _KINK * step:
        return False
    kink = float(max(gaps[1:3].max() / slopes, gaps[3] / max(twists, slopes / step)))
    if _KINK < kink < _MEANT:
        raise InputError(
            f"{name}: slopes where it closes",
            f"jump of {kink:.3g}",
            f"must go on there, or have a kink of {_MEANT:g} and more",
            "let it close smoothly, or split the surface there",
        )
    return kink <= _KINK


def _mean_length(pieces: Array) -> float:
    """Of the lines of a grid of pieces (n_u, n_v, 4, 4, 3) along its first axis, control polygons for curves [m]."""
    return float(np.linalg.norm(np.diff(pieces, axis=2), axis=-1).sum(axis=(0, 2)).mean())
