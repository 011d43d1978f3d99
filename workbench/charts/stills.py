"""Stills of meshes, and frames of bodies in motion. The one module that imports PyVista; needs no display.

Verified by tests/end_to_end/test_report.py and tests/unit/test_workbench_rover_animation.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from geometry.hexahedra import face_nodes
from workbench.charts.palette import ABOVE_YIELD, PART_COLOURS
from workbench.charts.solids import WORLD, Deforming, Solid

__all__ = [
    "QUARTERS",
    "Scene",
    "View",
    "draw_deformed",
    "draw_modes",
    "draw_motion",
    "draw_parts",
    "facet_parts",
    "surface",
]

Array = NDArray[np.float64]
_SIZE = (1600, 1200)
_MODES, _PANEL, _SWING = (2, 3), 640, 0.18
"""Rows and columns of modes, pixels of each, largest way of a point over the wheel's radius."""
_MATTE: dict[str, Any] = {"ambient": 0.35, "diffuse": 0.65, "specular": 0.0}
_SCALAR_BAR: dict[str, Any] = {
    "above_label": "above yield",
    "n_labels": 5,
    "fmt": "%.0f",
    "vertical": True,
    "height": 0.6,
    "width": 0.06,
    "position_x": 0.84,
    "position_y": 0.2,
    "title_font_size": 34,
    "label_font_size": 30,
    "color": "black",
}
QUARTERS = np.array([(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)])
"""A 9-node facet as four flat quadrangles."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """Where the eye is: direction from the wheel's centre to it (wheel frame), zoom, shift aside."""

    eye: tuple[float, float, float] = (0.62, -1.0, 0.42)
    zoom: float = 1.3
    shift: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A parallel projection, true to scale.

    Attributes
    ----------
    eye, up : directions, towards the eye and upwards on the picture, at right angles, world
    centre : what stands in the middle [m]
    scale : pixels in a metre
    size : width and height [pixels]
    """

    eye: tuple[float, float, float]
    up: tuple[float, float, float]
    centre: tuple[float, float, float]
    scale: float
    size: tuple[int, int]


def facet_parts(mesh: TaggedMesh) -> NDArray[np.int64]:
    """Part tag of the cell behind each boundary facet, shape (n_facets,)."""
    corners = face_nodes(mesh.cells.shape[1])[:, :4]
    faces = np.sort(mesh.cells[:, corners].reshape(-1, 4), axis=1)
    wanted = np.sort(mesh.facets[:, :4], axis=1)
    _, key = np.unique(np.concatenate([faces, wanted]), axis=0, return_inverse=True)
    owner = np.full(int(key.max()) + 1, -1, dtype=np.int64)
    owner[key.ravel()[: len(faces)]] = np.repeat(mesh.cell_tags, len(corners))
    return owner[key.ravel()[len(faces) :]]


def surface(mesh: TaggedMesh, points: Array | None = None, skip: str = "symmetry") -> pv.PolyData:
    """Boundary facets as flat quadrangles, with the cell array ``part``; the cut of a half width is left out.

    Parameters
    ----------
    mesh : of order 1 or 2
    points : (n_points, 3) float [m], positions to draw instead of the mesh's own, e.g. deformed
    skip : face group left out
    """
    kept = mesh.facet_tags != mesh.faces.get(skip, -1)
    facets, parts = mesh.facets[kept], facet_parts(mesh)[kept]
    if mesh.order == 2:
        facets, parts = facets[:, QUARTERS].reshape(-1, 4), np.repeat(parts, 4)
    faces = np.column_stack([np.full(len(facets), 4), facets]).ravel()
    drawn = pv.PolyData(mesh.points if points is None else points, faces=faces)
    drawn.cell_data["part"] = parts
    return drawn


def draw_parts(mesh: TaggedMesh, path: Path, scene: Scene | None = None) -> None:
    """Picture of the undeformed wheel, one colour and one legend entry a part."""
    plotter = _plotter()
    drawn = _whole_width(mesh, surface(mesh))
    legend = []
    for i, (name, tag) in enumerate(mesh.parts.items()):
        colour = PART_COLOURS[i % len(PART_COLOURS)]
        piece = drawn.extract_cells(drawn.cell_data["part"] == tag).extract_surface(algorithm="dataset_surface")
        plotter.add_mesh(piece, color=colour, **_MATTE)
        legend.append([name.replace("_", " "), colour])
    plotter.add_legend(legend, bcolor=None, face="rectangle", size=(0.19, 0.045 * len(legend)), loc="upper left")
    _save(plotter, path, scene or Scene(shift=-0.18))


def draw_deformed(
    mesh: TaggedMesh,
    fields: Path,
    direction_h: Array,
    yield_strength: float | None,
    path: Path,
    scene: Scene | None = None,
) -> None:
    """Picture of the deformed wheel on the ground, coloured by von Mises stress, in one colour above yield.

    Parameters
    ----------
    mesh : the mesh that was solved
    fields : archive with ``displacement`` (n_points, 3) [m] and ``von_mises`` (n_points,) [Pa]
    direction_h : (3,) float, unit vector from the hub to the ground
    yield_strength : upper end of the colours [Pa]; the largest stress there is where nothing yields
    path : PNG to write
    """
    with np.load(fields, allow_pickle=False) as archive:
        points, stress = mesh.points + archive["displacement"], archive["von_mises"]
    drawn = surface(mesh, points)
    drawn.point_data["von Mises stress [MPa]"] = stress * 1e-6
    plotter = _plotter()
    plotter.add_mesh(
        _whole_width(mesh, drawn),
        scalars="von Mises stress [MPa]",
        cmap="YlGnBu",
        clim=[0.0, 1e-6 * (yield_strength or float(stress.max()))],
        above_color=ABOVE_YIELD,
        scalar_bar_args=_SCALAR_BAR,
        **_MATTE,
    )
    plotter.add_mesh(_ground(points, direction_h), color="#c9c4bb", **_MATTE)
    _save(plotter, path, scene or Scene(eye=(0.35, -1.0, 0.22), zoom=1.45, shift=0.12))


def draw_modes(fields: Path, titles: Mapping[int, str], path: Path, parity: Mapping[int, int] | None = None) -> None:
    """Up to six modes side by side, each as a shape on the wheel, coloured by how far its points move.

    Parameters
    ----------
    fields : VTU with the point data ``mode_01``, ...
    titles : number of a mode -> what stands above it
    path : PNG to write
    parity : of half a wheel's modes, 1 even or -1 odd about y = 0, by their numbers; None for a whole wheel
    """
    drawn: Any = pv.read(fields).extract_surface(algorithm="dataset_surface", nonlinear_subdivision=2)
    chosen = list(titles)[: _MODES[0] * _MODES[1]]
    rows = 1 if len(chosen) <= _MODES[1] else _MODES[0]
    size = [_PANEL * min(len(chosen), _MODES[1]), _PANEL * rows]
    plotter: Any = pv.Plotter(off_screen=True, window_size=size, lighting="light kit", border=False,
                              shape=(rows, min(len(chosen), _MODES[1])))  # fmt: skip
    radius = float(np.linalg.norm(drawn.points, axis=1).max())
    for place, number in enumerate(chosen):
        plotter.subplot(*divmod(place, _MODES[1]))
        shape = np.asarray(drawn.point_data[f"mode_{number:02d}"], dtype=np.float64)
        moved = np.linalg.norm(shape, axis=1)
        shape *= _SWING * radius / moved.max()
        for side in (1.0, -1.0) if parity else (1.0,):
            mirror = np.array([1.0, side, 1.0])
            turned = shape * mirror * (1.0 if side > 0.0 or parity is None else float(parity[number]))
            one = drawn.copy()
            one.points = np.asarray(drawn.points * mirror + turned)
            look = {"scalars": moved / moved.max(), "cmap": "YlGnBu", "clim": [0.0, 1.0], "show_scalar_bar": False}
            plotter.add_mesh(one, **look, **_MATTE)
        plotter.add_text(titles[number], font_size=15, color="black", position="upper_edge")
        plotter.set_background("white")
        plotter.enable_parallel_projection()
        plotter.camera_position = [(0.62, -1.0, 0.42), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
        plotter.reset_camera()
    plotter.screenshot(str(path))
    plotter.close()


def draw_motion(
    solids: Sequence[Solid],
    positions: Array,
    rotations: Array,
    view: View | Sequence[View],
    deforming: Sequence[Deforming] = (),
) -> Iterator[NDArray[np.uint8]]:
    """Frames of bodies in motion, each (height, width, 3) uint8.

    Parameters
    ----------
    solids : what is drawn
    positions, rotations : (n, n_b, 3) float [m] and (n, n_b, 3, 3) float, of all bodies, body to world
    view : where from; one for each frame where the eye moves, all of one size
    deforming : surfaces with a shape for each frame
    """
    views = [view] * len(positions) if isinstance(view, View) else list(view)
    plotter = _plotter(views[0].size)
    moving = []
    for solid in solids:
        actor, _ = _add(plotter, solid.points, solid.quads, solid.colours)
        if solid.body != WORLD:
            moving.append((actor, solid.body))
    shapes = [(_add(plotter, one.points[0], one.quads, one.colours[0])[1], one) for one in deforming]
    for k, (r, R) in enumerate(zip(positions, rotations, strict=True)):
        for actor, body in moving:
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = R[body], r[body]
            actor.user_matrix = pose
        for drawn, one in shapes:
            drawn.points = one.points[k]
            drawn.cell_data["colour"] = one.colours[k]
        if k == 0 or views[k] is not views[k - 1]:
            _look(plotter, views[k])
        plotter.render()
        yield np.asarray(plotter.screenshot(return_img=True))
    plotter.close()


def _add(
    plotter: Any, points: Array, quads: NDArray[np.int64], colours: str | NDArray[np.uint8]
) -> tuple[Any, pv.PolyData]:
    """Actor and mesh of quadrangles in one colour, or each in its own."""
    drawn = pv.PolyData(points, faces=np.column_stack([np.full(len(quads), 4), quads]).ravel())
    if isinstance(colours, str):
        return plotter.add_mesh(drawn, color=colours, **_MATTE), drawn
    drawn.cell_data["colour"] = colours
    return plotter.add_mesh(drawn, scalars="colour", rgb=True, **_MATTE), drawn


def _look(plotter: Any, view: View) -> None:
    """Set the camera; the clipping range holds all that moves within the view."""
    reach = max(view.size) / view.scale
    plotter.enable_parallel_projection()
    plotter.camera.focal_point = view.centre
    plotter.camera.position = tuple(np.array(view.centre) + 4.0 * reach * np.array(view.eye))
    plotter.camera.up = view.up
    plotter.camera.parallel_scale = 0.5 * view.size[1] / view.scale
    plotter.camera.clipping_range = (0.1 * reach, 8.0 * reach)


def _ground(points: Array, direction_h: Array) -> pv.PolyData:
    """A slab of ground under the lowest point of the deformed wheel."""
    depth = float((points @ direction_h).max())
    size = 1.7 * float(np.abs(points).max())
    centre = direction_h * (depth + 0.001)
    return pv.Plane(center=centre, direction=direction_h, i_size=size, j_size=size)


def _whole_width(mesh: TaggedMesh, drawn: pv.PolyData) -> pv.PolyData:
    """Add the mirror image about y = 0 if the mesh is half a width."""
    if "symmetry" not in mesh.faces:
        return drawn
    both: pv.PolyData = drawn.merge(drawn.reflect((0.0, 1.0, 0.0)))
    return both


def _plotter(size: tuple[int, int] = _SIZE) -> Any:
    """An off-screen plotter; PyVista's decorated methods have no usable types."""
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size), lighting="light kit")
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    return plotter


def _save(plotter: Any, path: Path, scene: Scene) -> None:
    plotter.enable_parallel_projection()
    plotter.camera.position = tuple(np.array(scene.eye))
    plotter.camera.focal_point = (0.0, 0.0, 0.0)
    plotter.camera.up = (0.0, 0.0, 1.0)
    plotter.reset_camera()
    plotter.camera.zoom(scene.zoom)
    plotter.camera.SetWindowCenter(scene.shift, 0.0)
    plotter.screenshot(str(path))
    plotter.close()
