"""Deforming tires of a rover's motion as coloured surfaces, and close views of wheels that roll by.

Verified by tests/unit/test_workbench_tire_animation.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import Tire
from ancf_reduced.tire.skin import tire_skin
from workbench.charts.palette import STRAIN_COLOURS
from workbench.charts.solids import Deforming, Solid
from workbench.charts.stills import View, draw_motion

__all__ = ["StrainedTires", "close_views", "draw_on_tires", "strain_colours", "strained_tires"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
_CLOSE = 320
"""Width of the close views [pixels]."""
_SHARE = 99.5
"""Percentile of the strains at which the colours end, so that a single corner does not take them all."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StrainedTires:
    """All tires in each frame; ``end`` is the strain at the end of the colours [-], ``largest`` that of all [-]."""

    surfaces: tuple[Deforming, ...]
    end: float
    largest: float


def draw_on_tires(
    solids: Sequence[Solid],
    bodies: tuple[FloatArray, FloatArray],
    wheels: Sequence[int],
    shapes: tuple[Tire, FloatArray],
    view: View,
) -> tuple[Iterator[NDArray[np.uint8]], tuple[int, int], str]:
    """Pictures of a rover on deforming tires, two of its wheels from close by at their right; size, legend.

    Parameters
    ----------
    solids : everything but the tires
    bodies : positions (n, n_b, 3) [m] and rotations (n, n_b, 3, 3), body to world
    wheels : bodies of the wheels, in the order of the tires
    shapes : the tire, and its vectors (n, n_w, n_vectors, 3)
    view : of the rover
    """
    r, R = bodies
    tire, vectors = shapes
    strained, (width, height) = strained_tires(tire, vectors), view.size
    side = r[0, wheels, 1] - r[0, wheels, 1].mean()
    towards = [k for k in np.argsort(r[0, wheels, 0])[::-1] if side[k] * view.eye[1] > 0.0]
    pair = [towards[0], towards[-1]]
    upper = height // 2
    sizes = [(_CLOSE, upper), (_CLOSE, height - upper)]
    films = [draw_motion(solids, r, R, view, strained.surfaces)]
    for k, size in zip(pair, sizes, strict=True):
        seen = close_views(r[:, wheels[k]], float(np.sign(side[k])), tire.preset.outer_radius, size)
        films.append(draw_motion(solids, r, R, seen, strained.surfaces))
    pictures = (
        np.hstack([rover, np.vstack([_framed(front), _framed(rear)])])
        for rover, front, rear in zip(*films, strict=True)
    )
    return pictures, (width + _CLOSE, height), _legend(strained)


def _framed(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """With a thin line around it."""
    framed = picture.copy()
    framed[:1] = framed[-1:] = 170
    framed[:, :1] = framed[:, -1:] = 170
    return framed


def _legend(strained: StrainedTires) -> str:
    colours = ", ".join(STRAIN_COLOURS)
    return (
        '<p>Tires: largest principal Green-Lagrange strain, 0 <span class="strain" '
        f'style="background: linear-gradient(to right, {colours})"></span> {100.0 * strained.end:.1f} % and above; '
        f"largest {100.0 * strained.largest:.1f} %. Plates as the model has them, drawn from their shape functions; at "
        "the right the first and the last wheel of this side.</p>"
    )


def strained_tires(tire: Tire, vectors: FloatArray) -> StrainedTires:
    """Surfaces coloured by the principal Green-Lagrange strain that is largest in size.

    Parameters
    ----------
    tire : each of them
    vectors : (n, n_w, n_vectors, 3) float, see `rover_dynamics.flexible.flexible_vehicle.FlexibleMotion`
    """
    skin = tire_skin(tire)
    places = np.array([[skin.points(z) for z in frame] for frame in vectors])
    strains = np.array([[skin.largest_strain(z) for z in frame] for frame in vectors])
    of_faces = strains[:, :, skin.quads].mean(axis=-1)
    end = float(np.percentile(of_faces, _SHARE))
    colours = strain_colours(of_faces / max(end, 1e-12))
    surfaces = tuple(
        Deforming(points=places[:, w], quads=skin.quads, colours=colours[:, w]) for w in range(vectors.shape[1])
    )
    return StrainedTires(surfaces=surfaces, end=end, largest=float(strains.max()))


def strain_colours(share: FloatArray) -> NDArray[np.uint8]:
    """Colours (..., 3) of strains over that at the colours' end, (...)."""
    stops = np.array([[int(c[i : i + 2], 16) for i in (1, 3, 5)] for c in STRAIN_COLOURS], dtype=np.float64)
    places = np.linspace(0.0, 1.0, len(stops))
    return np.stack([np.interp(share, places, stops[:, i]) for i in range(3)], axis=-1).round().astype(np.uint8)


def close_views(hubs: FloatArray, outside: float, radius: float, size: tuple[int, int]) -> list[View]:
    """Views of one wheel from its outer side and a little above, one for each frame.

    Parameters
    ----------
    hubs : (n, 3) float [m], its hub's places
    outside : the side of the rover it is on, +1 left, -1 right
    radius : of the wheel [m]; 2.5 of them are seen across
    size : of the picture [pixels]
    """
    eye = np.array([0.0, outside * np.cos(0.2), np.sin(0.2)])
    up = np.array([0.0, -outside * np.sin(0.2), np.cos(0.2)])
    scale = min(size) / (2.5 * radius)
    return [View(eye=_three(eye), up=_three(up), centre=_three(hub), scale=scale, size=size) for hub in hubs]


def _three(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
