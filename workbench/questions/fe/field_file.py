"""Fields of the wheel: at one load as VTU, for ParaView and PyVista; along a curve as one archive, for the viewer.

The one module of the workbench that imports meshio.

Verified by tests/unit/test_workbench_tasks.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.archive import read_archive
from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.hexahedra import VTK_FROM_GMSH

__all__ = [
    "POINTS_FILE",
    "PRESSURE_FILE",
    "Fields",
    "read_points",
    "read_pressures",
    "write_fields",
    "write_points",
    "write_pressures",
    "write_shapes",
]

POINTS_FILE = "points.npz"
"""Fields at the points of a curve, in a task's folder."""
PRESSURE_FILE = "pressure.npz"
"""Contact pressures at the nodes, in a footprint task's folder."""
_HINT = "run the report again, or take the file out of the folder"
_LARGEST = 1_000_000_000
"""Bytes of the arrays along one curve: a mesh of a million nodes at sixty points."""
_NAMES = ("load", "displacement", "von_mises")
_PRESSURES = ("load", "contact_pressure")


class Fields(Protocol):
    """Load [N], displacement (n_points, 3) [m] and von Mises stress (n_points,) [Pa] at the nodes."""

    @property
    def load(self) -> float: ...
    @property
    def displacement(self) -> NDArray[np.float64]: ...
    @property
    def von_mises(self) -> NDArray[np.float64]: ...


def write_fields(
    mesh: TaggedMesh,
    displacement: NDArray[np.float64],
    von_mises: NDArray[np.float64],
    path: Path,
    principal_stress: NDArray[np.float64] | None = None,
) -> None:
    """Write mesh, parts, displacement and stresses; warp by ``displacement_m`` to see the deformed shape.

    Parameters
    ----------
    mesh : the mesh that was solved (half a width stays half)
    displacement : (n_points, 3) float [m]
    von_mises : (n_points,) float [Pa]
    path : ``.vtu`` file to write
    principal_stress : (n_points, 3) float [Pa], descending; single precision in the file
    """
    import meshio  # type: ignore[import-untyped]

    data = {"displacement_m": displacement, "von_mises_Pa": von_mises}
    if principal_stress is not None:
        data["principal_stress_Pa"] = principal_stress.astype(np.float32)
    kind, order = ("hexahedron", range(8)) if mesh.order == 1 else ("hexahedron27", VTK_FROM_GMSH)
    meshio.write_points_cells(
        str(path),
        mesh.points,
        [(kind, mesh.cells[:, list(order)])],
        point_data=data,
        cell_data={"part": [mesh.cell_tags]},
    )


def write_shapes(
    points: NDArray[np.float64], cells: NDArray[np.int64], shapes: NDArray[np.float64], path: Path
) -> None:
    """Write shapes (n, n_points, 3) on a mesh as the point data ``mode_01``, ...; warp by one to see it.

    points, cells : (n_points, 3) [m]; (m, 4) quadrangles, (m, 8) or (m, 27) hexahedra in gmsh's order
    """
    import meshio

    kind, order = {
        4: ("quad", tuple(range(4))),
        8: ("hexahedron", tuple(range(8))),
        27: ("hexahedron27", VTK_FROM_GMSH),
    }[cells.shape[1]]
    data = {f"mode_{number:02d}": shape.astype(np.float32) for number, shape in enumerate(shapes, start=1)}
    meshio.write_points_cells(str(path), points, [(kind, cells[:, list(order)])], point_data=data)


def write_points(points: Sequence[Fields], path: Path) -> None:
    """One archive of arrays over the points of a curve, single precision: ``load``, ``displacement``, ``von_mises``."""
    columns = {name: np.array([getattr(one, name) for one in points], dtype=np.float32) for name in _NAMES}
    np.savez_compressed(path, allow_pickle=False, **columns)


def read_points(path: Path) -> Iterator[tuple[float, NDArray[np.float64], NDArray[np.float64]]]:
    """Load, displacement and stress of each point, as `Fields` has them.

    Raises
    ------
    InputError
        If the file is not what `write_points` writes.
    """
    arrays = read_archive(path, "field file", _LARGEST, _NAMES)
    if arrays.keys() < set(_NAMES) or any(array.dtype.kind not in "iuf" for array in arrays.values()):
        raise InputError("field file", path, f"cannot be read (it lacks numbers of {', '.join(_NAMES)})", _HINT)
    load, moved, stress = (np.asarray(arrays[name], dtype=np.float64) for name in _NAMES)
    fits = moved.ndim == 3 and moved.shape[:2] == stress.shape and load.shape == stress.shape[:1]
    sound = fits and moved.shape[2] == 3 and all(np.isfinite(a).all() for a in (load, moved, stress))
    if not sound:
        raise InputError("field file", path, "must hold finite fields of nodes at each load", _HINT)
    yield from zip(load.tolist(), moved, stress, strict=True)


def write_pressures(pressures: Sequence[tuple[float, NDArray[np.float64]]], path: Path) -> None:
    """One archive in single precision: ``load`` (n,) [N] and ``contact_pressure`` (n, n_points) at the nodes [Pa]."""
    load, pressure = zip(*pressures, strict=True) if pressures else ((), ())
    single = (np.array(values, dtype=np.float32) for values in (load, pressure))
    np.savez_compressed(path, allow_pickle=False, **dict(zip(_PRESSURES, single, strict=True)))


def read_pressures(path: Path) -> dict[float, NDArray[np.float64]]:
    """Pressures at the nodes by load, as `write_pressures` has them.

    Raises
    ------
    InputError
        If the file is not what `write_pressures` writes.
    """
    arrays = read_archive(path, "pressure file", _LARGEST, _PRESSURES)
    if set(arrays) != set(_PRESSURES) or any(array.dtype.kind not in "iuf" for array in arrays.values()):
        raise InputError("pressure file", path, f"cannot be read (it lacks numbers of {', '.join(_PRESSURES)})", _HINT)
    load, pressure = (np.asarray(arrays[name], dtype=np.float64) for name in _PRESSURES)
    sound = load.ndim == 1 and pressure.ndim in (1, 2) and len(load) == len(pressure)
    if not (sound and np.isfinite(load).all() and np.isfinite(pressure).all()):
        raise InputError("pressure file", path, "must hold a finite pressure of nodes at each load", _HINT)
    return dict(zip(load.tolist(), pressure, strict=True))
