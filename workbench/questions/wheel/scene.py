"""The wheel in the page: its parts as meshed, and its shapes under load with their stress.

Verified by tests/unit/test_workbench_scenes.py and tests/end_to_end/test_report_browser.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from workbench.charts.palette import PART_COLOURS
from workbench.charts.scenes import Look, Piece, Pose, Stressed, coloured_scene, stressed_scene
from workbench.charts.stills import facet_parts, surface
from workbench.questions.wheel.mesh_file import MESH, read_mesh

__all__ = ["parts_scene", "stress_scene", "surface_pieces", "surface_with_fields"]

FIELDS = "fields_*N.npz"


def parts_scene(mesh_folder: Path, poster: str) -> str:
    """The whole wheel undeformed, one colour a part."""
    pieces = surface_pieces(read_mesh(mesh_folder / MESH))
    look = Look(eye=(0.9, -1.6, 0.7), zoom=1.75, alt="The wheel with its parts in different colours")
    return coloured_scene("scene-parts", pieces, poster, look=look)


def stress_scene(mesh_folder: Path, solved: Mapping[float, Path], yield_strength: float | None, poster: str) -> str:
    """The wheel at each orientation [deg] and load that the solver kept; empty text where it kept none."""
    wheel = surface_with_fields(read_mesh(mesh_folder / MESH), solved, yield_strength)
    if not wheel.poses:
        return ""
    alt = "Deformed wheel on the ground, coloured by von Mises stress"
    look = Look(eye=(0.5, -1.9, 0.35), zoom=2.2, alt=alt)
    return stressed_scene("scene-stress", wheel, poster, look=look)


def surface_pieces(mesh: TaggedMesh) -> list[Piece]:
    """The boundary by part, corners of the facets only."""
    kept = mesh.facet_tags != mesh.faces.get("symmetry", -1)
    quads, parts = mesh.facets[kept][:, :4], facet_parts(mesh)[kept]
    found = []
    for k, (name, tag) in enumerate(mesh.parts.items()):
        used, local = _compact(quads[parts == tag])
        colour = PART_COLOURS[k % len(PART_COLOURS)]
        found.append(Piece(name=name.replace("_", " "), colour=colour, points=mesh.points[used], quads=local))
    return found


def surface_with_fields(mesh: TaggedMesh, solved: Mapping[float, Path], yield_strength: float | None) -> Stressed:
    """The boundary of the solved mesh, with the fields of each orientation's folder.

    yield_strength : upper end of the colours [Pa]; the largest stress of all where nothing yields
    """
    used, quads = _compact(np.asarray(surface(mesh).faces, dtype=np.int64).reshape(-1, 5)[:, 1:])
    poses = []
    for orientation, folder in solved.items():
        for path in sorted(folder.glob(FIELDS), key=_load):
            with np.load(path, allow_pickle=False) as archive:
                displacement, stress = archive["displacement"][used], archive["von_mises"][used]
            poses.append(
                Pose(
                    label=f"{orientation:g}°, {_load(path):g} N",
                    orientation=math.radians(orientation),
                    displacement=displacement,
                    von_mises=stress,
                )
            )
    return Stressed(
        points=mesh.points[used],
        quads=quads,
        mirrored="symmetry" in mesh.faces,
        limit=yield_strength or max((float(pose.von_mises.max()) for pose in poses), default=0.0),
        poses=poses,
    )


def _load(path: Path) -> float:
    return float(path.stem.removeprefix("fields_").removesuffix("N"))


def _compact(quads: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Numbers of the points used, and the quadrangles in terms of these."""
    used, local = np.unique(quads, return_inverse=True)
    return used, local.reshape(quads.shape)
