"""What stands in the page's 3D view. Beside `workbench.figures.stills` the one module that imports PyVista.

Stills are drawn and gone; this scene lives as long as the page, whose browser draws it (vtk.js).

Verified by tests/unit/test_viewer_scene.py and tests/end_to_end/test_view.py.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from contracts.errors import InputError
from workbench.figures.solids import WORLD, Quads, Solid
from workbench.viewer.wheel_surface import WheelField, WheelSurface, wheel_surface

__all__ = ["Camera", "Scene", "read_fields"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Colours = NDArray[np.uint8]
_MATTE: dict[str, Any] = {"ambient": 0.45, "diffuse": 0.62, "specular": 0.0}
_GROUND = "#d9d4ca"
_MARK = "#d81b60"
_ANGLE = 30.0
"""Of the view from bottom to top [degrees], that of vtk.js."""
_HEXAHEDRA = {12: 8, 29: 27}
"""VTK's cell types with their nodes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """Unit vectors to the eye and upwards, what stands in the middle [m], half the height seen there [m]."""

    eye: tuple[float, float, float]
    up: tuple[float, float, float]
    centre: tuple[float, float, float]
    half_height: float


def read_fields(path: Path) -> tuple[WheelSurface, WheelField]:
    """The outside of the wheel and its fields from a file that ``workbench report`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, or lacks hexahedra, parts, displacement or stress.
    """
    hint = "run the report again, or take the file out of the folder"
    try:
        ElementTree.parse(path)  # what is cut short is said here, and not in a page of VTK's own words
        with _quiet():
            grid: Any = pv.read(path)
        (kind,) = grid.cells_dict
        cells = np.asarray(grid.cells_dict[kind], dtype=np.int64)
        part = np.asarray(grid.cell_data["part"], dtype=np.int64)
        moved = np.asarray(grid.point_data["displacement_m"], dtype=np.float64)
        stress = np.asarray(grid.point_data["von_mises_Pa"], dtype=np.float64)
    except Exception as error:  # VTK raises whatever it likes
        lines = str(error).strip().splitlines()
        reason = f"{type(error).__name__}: {lines[0][:120]}" if lines else type(error).__name__
        raise InputError("field file", path, f"cannot be read ({reason})", hint) from error
    if kind not in _HEXAHEDRA or not (np.all(np.isfinite(moved)) and np.all(np.isfinite(stress))):
        raise InputError("field file", path, "must hold hexahedra with finite fields", hint)
    points = np.asarray(grid.points, dtype=np.float64)
    return wheel_surface(points, cells, part), WheelField(displacement=moved, von_mises=stress)


class Scene:
    """A wheel, or a rover in motion, for the browser to draw."""

    def __init__(self) -> None:
        with _quiet():  # that there is no display is no news
            plotter: Any = pv.Plotter(off_screen=True, lighting="light kit")
        plotter.set_background("white")
        self._plotter = plotter
        self._moving: list[tuple[Any, int]] = []
        self._shapes: list[pv.PolyData] = []

    @property
    def window(self) -> Any:
        """The render window trame takes over."""
        return self._plotter.render_window

    def show_shape(self, quads: Quads, colours: Colours, ground: Quads | None) -> None:
        """One surface, coloured at its points (n, 3) uint8, on a piece of ground; everything else goes."""
        self._clear()
        points, faces = quads
        drawn = _surface(points, faces)
        drawn.point_data["colour"] = colours
        self._plotter.add_mesh(drawn, scalars="colour", rgb=True, name="shape", **_MATTE)
        self._shapes = [drawn]
        if ground is not None:
            self._plotter.add_mesh(_surface(*ground), color=_GROUND, name="ground", pickable=False, **_MATTE)

    def move_shape(self, points: FloatArray, colours: Colours, ground: Quads | None) -> None:
        """Other places (n, 3) [m] and colours of the surface that is shown."""
        (drawn,) = self._shapes
        drawn.points = points
        drawn.point_data["colour"] = colours
        if ground is not None:
            self._plotter.add_mesh(_surface(*ground), color=_GROUND, name="ground", pickable=False, **_MATTE)

    def mark(self, place: FloatArray | None, radius: float) -> None:
        """A ball [m] at a place that was probed, or none."""
        self._plotter.remove_actor("mark", render=False)
        if place is not None:
            ball = pv.Sphere(radius=radius, center=tuple(place), theta_resolution=20, phi_resolution=20)
            self._plotter.add_mesh(ball, color=_MARK, name="mark", pickable=False, ambient=0.6, diffuse=0.4)

    def show_solids(self, solids: Sequence[Solid], tires: Sequence[tuple[Quads, Colours]] = ()) -> None:
        """Solids that move as a whole, and surfaces that change their shape, coloured by face."""
        self._clear()
        for number, solid in enumerate(solids):
            drawn = _surface(solid.points, solid.quads)
            actor = self._add(drawn, solid.colours, f"solid{number}")
            if solid.body != WORLD:
                self._moving.append((actor, solid.body))
        for number, ((points, faces), colours) in enumerate(tires):
            drawn = _surface(points, faces)
            self._add(drawn, colours, f"tire{number}")
            self._shapes.append(drawn)

    def move_solids(
        self, positions: FloatArray, rotations: FloatArray, tires: Sequence[tuple[FloatArray, Colours]] = ()
    ) -> None:
        """Places (n_b, 3) [m] and rotations (n_b, 3, 3) of all bodies; points and colours of the tires."""
        for actor, body in self._moving:
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = rotations[body], positions[body]
            actor.user_matrix = pose
        for drawn, (points, colours) in zip(self._shapes, tires, strict=True):
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

    def _add(self, drawn: pv.PolyData, colours: str | Colours, name: str) -> Any:
        if isinstance(colours, str):
            return self._plotter.add_mesh(drawn, color=colours, name=name, pickable=False, **_MATTE)
        drawn.cell_data["colour"] = colours
        return self._plotter.add_mesh(drawn, scalars="colour", rgb=True, name=name, pickable=False, **_MATTE)

    def _clear(self) -> None:
        self._plotter.clear_actors()
        self._moving, self._shapes = [], []


@contextmanager
def _quiet() -> Iterator[None]:
    """Nothing from VTK on stderr."""
    with warnings.catch_warnings(), pv.vtk_verbosity("off"):
        warnings.simplefilter("ignore")
        yield


def _surface(points: FloatArray, quads: IntArray) -> pv.PolyData:
    """Quadrangles in single precision, which is what the browser draws."""
    return pv.PolyData(points.astype(np.float32), faces=np.column_stack([np.full(len(quads), 4), quads]).ravel())
