"""The rover at rest on level ground, to be turned in the page. Verified by tests/unit/test_workbench_scenes.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from contracts.terrain import inclined_plane
from rover_dynamics.rover.rover import build_rover
from rover_dynamics.rover.rover_file import RoverDesign
from workbench.charts.scenes import Look, Piece, coloured_scene
from workbench.charts.solids import Solid, joined
from workbench.questions.rover.animation import framing
from workbench.questions.rover.solids import MARKER, body_names, ground_solids, rover_solids

__all__ = ["draw_still", "rover_pieces", "rover_scene"]

FloatArray = NDArray[np.float64]

_ROLES = {
    "#e6b84a": "principal body",
    "#0072b2": "bogies",
    "#56b4e9": "arms",
    "#777777": "steered forks",
    "#b5b5b5": "wheels",
    "#333333": "grousers",
    MARKER: "mark of a wheel's turn",
    "#8a7458": "ground's edge",
}
"""Colours of `workbench.questions.rover.solids` -> what they stand for."""


def rover_scene(design: RoverDesign, poster: str) -> str:
    """HTML of the scene; ``poster`` is a ``data:`` link to its still."""
    alt = "The rover at rest on level ground: body, bogies, arms and six wheels"
    look = Look(eye=(-0.55, -1.4, 0.5), zoom=2.3, alt=alt)
    return coloured_scene("scene-rover", rover_pieces(design), poster, look=look)


def rover_pieces(design: RoverDesign) -> list[Piece]:
    """Solids in one piece a colour, in the order of `_ROLES`, the ground last."""
    positions, rotations = _stance(design)
    by_colour: dict[str, list[Solid]] = {}
    for solid in (part for whole in _solids(design) for part in _one_colour_each(whole)):
        by_colour.setdefault(str(solid.colours), []).append(solid)
    known = [colour for colour in _ROLES if colour in by_colour]
    return [
        _piece(by_colour[c], _ROLES.get(c, "ground"), positions, rotations)
        for c in [*known, *(c for c in by_colour if c not in _ROLES)]
    ]


def _solids(design: RoverDesign) -> list[Solid]:
    positions, _ = _stance(design)
    wheels = [k for k, name in enumerate(body_names(design)) if name.startswith("wheel_")]
    return [*rover_solids(design), *ground_solids(inclined_plane(0.0), positions[wheels, :2])]


def _stance(design: RoverDesign) -> tuple[FloatArray, FloatArray]:
    """Positions (n, 3) [m] and rotations (n, 3, 3) of all bodies, wheels touching the ground."""
    bodies = build_rover(design).model.bodies
    return np.array([b.position for b in bodies]), np.array([b.rotation for b in bodies])


def _one_colour_each(solid: Solid) -> list[Solid]:
    """A solid whose faces have colours of their own as one solid a colour."""
    if isinstance(solid.colours, str):
        return [solid]
    found = []
    for colour in np.unique(solid.colours, axis=0):
        used, local = np.unique(solid.quads[(solid.colours == colour).all(axis=1)], return_inverse=True)
        quads = local.reshape(-1, 4)
        text = "#" + "".join(f"{part:02x}" for part in colour)
        found.append(Solid(body=solid.body, points=solid.points[used], quads=quads, colours=text))
    return found


def _piece(solids: list[Solid], name: str, positions: FloatArray, rotations: FloatArray) -> Piece:
    points, quads = joined([(s.placed(positions, rotations), s.quads) for s in solids])
    return Piece(name=name, colour=str(solids[0].colours), points=points, quads=quads)


def draw_still(design: RoverDesign, path: Path) -> None:
    """Picture of the same, PNG."""
    from workbench.charts.stills import draw_motion

    positions, rotations = (pose[None] for pose in _stance(design))
    solids = _solids(design)
    (picture,) = draw_motion(solids, positions, rotations, framing(solids, positions, rotations, (0.0, 0.0, 1.0)))
    Image.fromarray(picture).save(path)
