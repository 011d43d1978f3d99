"""Scenes of the page that turn under the mouse: coloured solids, and the wheel with its stress as it deforms.

A scene is a poster (what is printed, and what stands there until it is drawn) and packed numbers, of which the page
makes Plotly's triangles when the reader comes to it. Verified by tests/unit/test_workbench_scenes.py.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.text import for_html
from workbench.charts.packing import packed, quantised
from workbench.charts.palette import ABOVE_YIELD

__all__ = ["STRESS_SCALE", "Look", "Piece", "Pose", "Stressed", "coloured_scene", "stressed_scene"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

STRESS_SCALE = ((0.0, "#ffffd9"), (0.2, "#c7e9b4"), (0.4, "#7fcdbb"), (0.6, "#41b6c4"), (0.8, "#225ea8"),
                (0.999, "#081d58"), (1.0, ABOVE_YIELD))  # fmt: skip
"""YlGnBu up to the yield strength, one colour above it, as in the stills."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Piece:
    """Quadrangles of one colour under one name: points (n, 3) float [m], quads (m, 4) int."""

    name: str
    colour: str
    points: FloatArray
    quads: IntArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """The wheel at one orientation and load.

    Attributes
    ----------
    label : on its button
    orientation : circumferential position that faces the ground [rad]
    displacement : (n, 3) float [m], of the surface's points, hub frame
    von_mises : (n,) float [Pa]
    """

    label: str
    orientation: float
    displacement: FloatArray
    von_mises: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stressed:
    """A surface with what was solved on it.

    Attributes
    ----------
    points, quads : (n, 3) float [m] hub frame, and (m, 4) int
    mirrored : half a width, cut at y = 0
    limit : upper end of the colours [Pa], as a rule the yield strength
    poses : one or more
    """

    points: FloatArray
    quads: IntArray
    mirrored: bool
    limit: float
    poses: Sequence[Pose]


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """Where the eye is at first (towards it from the centre, z up), size in the box, and what is seen, in words."""

    eye: tuple[float, float, float]
    zoom: float
    alt: str


def coloured_scene(name: str, pieces: Sequence[Piece], poster: str, *, look: Look) -> str:
    """HTML of solids in colours, each named by the pointer and by the legend."""
    content = {
        "eye": look.eye,
        "zoom": look.zoom,
        "pieces": [
            {"name": p.name, "colour": p.colour, "points": _points(p.points), "quads": _indices(p.quads)}
            for p in pieces
        ],
    }
    return _html(name, content, poster, look.alt)


def stressed_scene(name: str, wheel: Stressed, poster: str, *, look: Look) -> str:
    """HTML of the deformed wheel coloured by von Mises stress [MPa]; a button a pose, and a slider to its shape."""
    content = {
        "eye": look.eye,
        "zoom": look.zoom,
        "points": _points(wheel.points),
        "quads": _indices(wheel.quads),
        "mirrored": wheel.mirrored,
        "limit": wheel.limit * 1e-6,
        "scale": STRESS_SCALE,
        "poses": [
            {
                "label": pose.label,
                "orientation": pose.orientation,
                "displacement": _points(pose.displacement),
                "stress": quantised(pose.von_mises * 1e-6),
            }
            for pose in wheel.poses
        ],
    }
    return _html(name, content, poster, look.alt)


def _points(points: FloatArray) -> list[dict[str, object]]:
    return [quantised(points[:, axis]) for axis in range(3)]


def _indices(quads: IntArray) -> str:
    return base64.b64encode(quads.astype("<u4").tobytes()).decode("ascii")


def _html(name: str, content: Mapping[str, Any], poster: str, alt: str) -> str:
    text = packed(json.dumps(content, allow_nan=False, separators=(",", ":")))
    image = f'<img class="poster" loading="lazy" src="{poster}" alt="{for_html(alt)}">'
    return (
        f'<div class="scene" id="{name}"><div class="controls"></div><div class="stage">{image}</div></div>'
        f'<script type="text/plain" data-for="{name}">{text}</script>'
    )
