"""What stands in the page's 3D view. Only `workbench.charts.stills` imports PyVista besides.

Stills are drawn and gone; this scene lives as long as the page, whose browser draws it (vtk.js).

Verified by tests/unit/test_viewer_stages.py and tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import warnings
from collections.abc import Hashable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from workbench.charts.solids import WORLD, Quads, Solid

__all__ = ["Camera", "Scene"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Colours = NDArray[np.uint8]
_MATTE: dict[str, Any] = {"ambient": 0.45, "diffuse": 0.62, "specular": 0.0}
_GROUND = "#d9d4ca"
_MARK = "#d81b60"
_ANGLE = 30.0
"""Of the view from bottom to top [degrees], that of vtk.js."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """Unit vectors to the eye and upwards, what stands in the middle [m], half the height seen there [m]."""

    eye: tuple[float, float, float]
    up: tuple[float, float, float]
    centre: tuple[float, float, float]
    half_height: float


@dataclass(slots=True)
class _Drawn:
    """What one stage has put into the scene: everything, what moves with a body, what changes its shape, the ground.

    ``quads`` are those that the changing surface of a wheel has now.
    """

    actors: list[Any] = field(default_factory=list)
    moving: list[tuple[Any, int]] = field(default_factory=list)
    shapes: list[pv.PolyData] = field(default_factory=list)
    quads: IntArray | None = None
    ground: pv.PolyData | None = None
    below: Any = None


class Scene:
    """A wheel, or a rover in motion, for the browser to draw.

    Every actor lives as long as the scene and is hidden while another stage is looked at: the browser knows VTK's
    objects by their addresses, and would take a new object at the address of one that is gone for the old one.
    """

    def __init__(self) -> None:
        with _quiet():  # that there is no display is no news
            plotter: Any = pv.Plotter(off_screen=True, lighting="light kit")
        plotter.set_background("white")
        self._plotter = plotter
        self._stages: dict[Hashable, _Drawn] = {}
        self._now = _Drawn()
        ball = pv.Sphere(radius=1.0, theta_resolution=20, phi_resolution=20)
        self._mark = plotter.add_mesh(ball, color=_MARK, pickable=False, ambient=0.6, diffuse=0.4)
        self._mark.visibility = False

    @property
    def window(self) -> Any:
        """The render window trame takes over."""
        return self._plotter.render_window

    def turn_to(self, stage: Hashable) -> bool:
        """Hide what is not this stage's; returns whether it has been here before, else it must add its things."""
        known = stage in self._stages
        drawn = self._stages.setdefault(stage, _Drawn())
        if drawn is not self._now:
            for actor in self._now.actors:
                actor.visibility = False
            for actor in drawn.actors:
                actor.visibility = True
            self._now = drawn
        return known

    def add_shape(self, ground: Quads | None) -> None:
        """A surface that is still to be shown, maybe on a piece of ground."""
        drawn = _surface(np.eye(4, 3), np.arange(4)[None])  # as VTK adds nothing that is empty
        drawn.point_data["colour"] = np.zeros((4, 3), dtype=np.uint8)
        self._add(drawn, pickable=True, scalars="colour", rgb=True)
        self._now.shapes.append(drawn)
        if ground is None:
            return
        self._now.ground = _surface(*ground)
        self._now.below = self._add(self._now.ground, color=_GROUND)

    def show_shape(self, quads: Quads, colours: Colours, ground: Quads | None) -> None:
        """The surface, maybe of nothing, coloured at its points (n, 3) uint8, and its piece of ground."""
        (drawn,), (points, corners) = self._now.shapes, quads
        if self._now.ground is not None and ground is not None:
            self._now.ground.points = ground[0]
        self._now.actors[0].visibility = len(corners) > 0
        if not len(corners):
            return
        if self._now.quads is not corners:
            drawn.clear_data()
            drawn.faces = _faces(corners)
            self._now.quads = corners
        drawn.points = points.astype(np.float32)
        drawn.point_data["colour"] = colours

    def show_ground(self, *, shown: bool) -> None:
        """Show or hide what the wheel stands on, which is there at other times."""
        if self._now.below is not None:
            self._now.below.visibility = shown

    def mark(self, place: FloatArray | None, radius: float) -> None:
        """A ball [m] at a place that was probed, or none."""
        self._mark.visibility = place is not None
        if place is not None:
            self._mark.position, self._mark.scale = tuple(place), (radius, radius, radius)

    def add_solids(self, solids: Sequence[Solid], tires: Sequence[tuple[Quads, Colours]] = ()) -> None:
        """Solids that move as a whole, and surfaces that change their shape, coloured by face."""
        for solid in solids:
            drawn = _surface(solid.points, solid.quads)
            if isinstance(solid.colours, str):
                actor = self._add(drawn, color=solid.colours)
            else:
                drawn.cell_data["colour"] = solid.colours
                actor = self._add(drawn, scalars="colour", rgb=True)
            if solid.body != WORLD:
                self._now.moving.append((actor, solid.body))
        for quads, colours in tires:
            drawn = _surface(*quads)
            drawn.cell_data["colour"] = colours
            self._add(drawn, scalars="colour", rgb=True)
            self._now.shapes.append(drawn)

    def move_solids(
        self, positions: FloatArray, rotations: FloatArray, tires: Sequence[tuple[FloatArray, Colours]] = ()
    ) -> None:
        """Places (n_b, 3) [m] and rotations (n_b, 3, 3) of all bodies; points and colours of the tires."""
        for actor, body in self._now.moving:
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = rotations[body], positions[body]
            actor.user_matrix = pose
        for drawn, (points, colours) in zip(self._now.shapes, tires, strict=True):
            drawn.points = points
            drawn.cell_data["colour"] = colours

    def look(self, camera: Camera) -> None:
        """Set the eye."""
        seen, centre = self._plotter.camera, np.array(camera.centre)
        seen.focal_point = camera.centre
        seen.position = tuple(centre + camera.half_height / np.tan(np.radians(0.5 * _ANGLE)) * np.array(camera.eye))
        seen.up = camera.up
        seen.view_angle = _ANGLE

    def close(self) -> None:
        """Let go of the window."""
        self._plotter.close()

    def _add(self, drawn: pv.PolyData, *, pickable: bool = False, **colours: Any) -> Any:
        actor = self._plotter.add_mesh(drawn, pickable=pickable, **colours, **_MATTE)
        self._now.actors.append(actor)
        return actor


@contextmanager
def _quiet() -> Iterator[None]:
    """Nothing from VTK on stderr."""
    with warnings.catch_warnings(), pv.vtk_verbosity("off"):
        warnings.simplefilter("ignore")
        yield


def _surface(points: FloatArray, quads: IntArray) -> pv.PolyData:
    """Quadrangles in single precision, which is what the browser draws."""
    return pv.PolyData(points.astype(np.float32), faces=_faces(quads))


def _faces(quads: IntArray) -> IntArray:
    """As VTK has them: the number of corners before each."""
    return np.column_stack([np.full(len(quads), 4), quads]).ravel()
