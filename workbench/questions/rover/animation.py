"""A rover's motion as one HTML page: rendered frames with a player, nothing loaded from elsewhere.

Frames are WebP pictures rendered off-screen at recorded times; the page plays, pauses and steps through them.

Verified by tests/unit/test_workbench_rover_animation.py.
"""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Sequence
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from contracts.errors import InputError
from contracts.terrain import Terrain
from contracts.text import for_html
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.vehicle.vehicle import VehicleMotion
from workbench.charts.solids import WORLD, Solid
from workbench.questions.rover.solids import body_names, ground_solids, rover_solids, square_size

if TYPE_CHECKING:
    from ancf_reduced.tire.mesh import Tire
    from workbench.charts.stills import View

__all__ = ["framing", "shown_frames", "write_animation"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Direction = tuple[float, float, float]

_PAGE = Path(__file__).parent / "animation.html"
_FRAMES, _FRAMES_OF_TIRES = 270, 180
_WIDTH, _TALLEST, _BORDER = 960, 640, 12
_QUALITY = 50
_ASIDE = (-0.55, -1.0, 0.45)
"""Towards the eye: from the right, behind and above, where the faces of steps ahead are seen."""
_CORNERS = np.array([(1, 1, 1), (1, -1, 1), (-1, 1, 1), (-1, -1, 1)])
_SPEEDS = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0)
_WATCHED = 15.0


def write_animation(
    motion: VehicleMotion,
    design: RoverDesign,
    terrain: Terrain,
    path: Path,
    *,
    title: str = "Rover",
    up: Direction = (0.0, 0.0, 1.0),
    tire: Tire | None = None,
    most: int | None = None,
) -> None:
    """Write a page that plays a motion in any browser.

    Parameters
    ----------
    motion : of the vehicle `build_rover` makes of ``design``
    terrain : the ground; drawn as far as 0.25 m beyond the wheels
    path : HTML file
    title : heading of the page
    up : upwards on the picture, against gravity; give it where a slope is a tilted gravity on level ground
    tire : of all wheels of a `FlexibleMotion`; drawn as deformed and coloured by strain, with two wheels close by
    most : times that are drawn at most, evenly spread; 270 without a tire, 180 with one

    Raises
    ------
    InputError
        If the motion has another number of bodies than the design, fewer than two times, or no shapes of tires.
    """
    names = body_names(design)
    if motion.positions.shape[1] != len(names) or len(motion.times) < 2:
        value = f"{motion.positions.shape[1]} bodies at {len(motion.times)} times"
        rule = f"must be that of the design's {len(names)} bodies, at two times or more"
        raise InputError("motion to animate", value, rule, "give the design the vehicle was built of")
    chosen = shown_frames(motion.times, most or (_FRAMES if tire is None else _FRAMES_OF_TIRES))
    r, R = motion.positions[chosen], motion.rotations[chosen]
    wheels = [number for number, name in enumerate(names) if name.startswith("wheel_")]
    places = _trodden(r[:, wheels, :2], design.wheel_radius)
    ground = ground_solids(terrain, places)
    view = framing([*rover_solids(design), *ground], r, R, up)
    if tire is None:
        from workbench.charts.stills import draw_motion

        pictures, size, legend = draw_motion([*rover_solids(design), *ground], r, R, view), view.size, ""
    else:
        from workbench.charts.tire_animation import draw_on_tires

        if not isinstance(motion, FlexibleMotion):
            raise InputError("motion to animate", "rigid wheels", "has no shapes of tires", "leave out the tire")
        solids = [*rover_solids(design, tire.preset.hub_radius), *ground]
        pictures, size, legend = draw_on_tires(solids, (r, R), wheels, (tire, motion.vectors[chosen]), view)
    frames = [_webp(picture) for picture in pictures]
    page = _page(motion, chosen, frames, size, (title, square_size(places), legend))
    path.write_text(page, encoding="utf-8")


def shown_frames(times: FloatArray, most: int = _FRAMES) -> IntArray:
    """Numbers of the times that are drawn: the first after each of ``most`` evenly spread ones, and the last."""
    even = np.linspace(times[0], times[-1], min(most, len(times)))
    return np.unique(np.clip(np.searchsorted(times, even - 1e-9), 0, len(times) - 1))


def framing(solids: Sequence[Solid], positions: FloatArray, rotations: FloatArray, up: Direction) -> View:
    """The view that holds everything at all times; positions (n, n_b, 3) [m] and rotations (n, n_b, 3, 3)."""
    from workbench.charts.stills import View

    eye, above = _axes(np.asarray(up, dtype=np.float64))
    screen = np.array([np.cross(above, eye), above])
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for solid in solids:
        moments = range(1) if solid.body == WORLD else range(len(positions))
        for k in moments:
            seen = solid.placed(positions[k], rotations[k]) @ screen.T
            low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
    extent = high - low
    scale = float(np.min((np.array([_WIDTH, _TALLEST]) - 2 * _BORDER) / extent))
    tall = 2 * int(np.ceil(0.5 * (scale * extent[1] + 2 * _BORDER)))
    centre = 0.5 * (low + high) @ screen
    size = (_WIDTH, min(tall, _TALLEST))
    return View(eye=_three(eye), up=_three(above), centre=_three(centre), scale=scale, size=size)


def _axes(up: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit vectors towards the eye and upwards on the picture.

    The eye keeps its height over the horizon, and goes to another corner where it would see the ground edge-on.
    """
    z = up / np.linalg.norm(up)
    ahead = np.array([1.0, 0.0, 0.0]) - z[0] * z
    ahead /= np.linalg.norm(ahead)
    eyes = _CORNERS * _ASIDE @ np.array([ahead, np.cross(z, ahead), z])
    eye = eyes[np.argmax(eyes[:, 2].round(6))] / np.linalg.norm(_ASIDE)
    above = z - (z @ eye) * eye
    return eye, above / np.linalg.norm(above)


def _three(vector: FloatArray) -> Direction:
    x, y, z = vector.tolist()
    return x, y, z


def _trodden(axles: FloatArray, radius: float) -> FloatArray:
    """Corners of the ground the wheels reach, (n, 2) float [m]; axles (n, n_w, 2) [m]."""
    flat = axles.reshape(-1, 2)
    return np.array([flat.min(axis=0) - radius, flat.max(axis=0) + radius])


def _webp(picture: NDArray[np.uint8]) -> str:
    """A picture as base64 text."""
    held = io.BytesIO()
    Image.fromarray(picture).save(held, "WEBP", quality=_QUALITY, method=4)
    return base64.b64encode(held.getvalue()).decode("ascii")


def _page(
    motion: VehicleMotion, chosen: IntArray, frames: Sequence[str], size: tuple[int, int], words: tuple[str, float, str]
) -> str:
    """The template filled in; the first body's speed and its way are shown."""
    t = motion.times[chosen]
    speed = np.linalg.norm(motion.velocities[chosen, 0, :3], axis=1)
    way = np.linalg.norm(motion.positions[chosen, 0] - motion.positions[chosen[0], 0], axis=1)
    fitting = min(_SPEEDS, key=lambda s: abs(np.log(float(t[-1] - t[0]) / s / _WATCHED)))
    options = "".join(f'<option value="{s:g}"{" selected" * (s == fitting)}>{s:g} &times;</option>' for s in _SPEEDS)
    title, squares, legend = words
    return Template(_PAGE.read_text(encoding="utf-8")).substitute(
        title=for_html(title),
        squares=f"{squares:g}",
        legend=legend,
        width=size[0],
        height=size[1],
        options=options,
        times=json.dumps(t.round(4).tolist()),
        speeds=json.dumps((1e3 * speed).round(2).tolist()),
        ways=json.dumps(way.round(4).tolist()),
        frames=json.dumps(list(frames)),
    )
