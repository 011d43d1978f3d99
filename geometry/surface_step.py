"""B-spline surfaces in STEP files (ISO 10303-21), and the points gmsh's OpenCASCADE kernel finds on them again.

Files are in millimetres, one product per surface under its name; coordinates have 13 digits.

Verified by tests/unit/test_geometry_surface_step.py and tests/verification/test_ancf_spline_step.py.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.gmsh_session import gmsh_session
from geometry.spline_surface import SplineSurface
from geometry.step import in_metres, write_named

__all__ = ["step_points", "write_surfaces_step"]

FloatArray = NDArray[np.float64]
_NAME = re.compile(r"[\w .+-]+", re.ASCII)


def write_surfaces_step(surfaces: Sequence[SplineSurface], path: Path) -> None:
    """Write each surface as a face on a B_SPLINE_SURFACE_WITH_KNOTS with its control points and knots.

    Parameters
    ----------
    surfaces : one or more, with different names of ASCII letters, digits, spaces and ``. _ + -``; knots clamped (ends
        repeated degree + 1 times)
    path : file to write (``.step``); its folder is made if needed

    Raises
    ------
    InputError
        For no surface, a name twice or with other characters, or knots that are not clamped.
    """
    names = [surface.name for surface in surfaces]
    if not names or len(set(names)) < len(names) or not all(_NAME.fullmatch(name) for name in names):
        rule = "must be one or more, all different, of ASCII letters, digits, spaces and . _ + -"
        raise InputError("names of surfaces", names, rule, "rename them")
    with gmsh_session(path.stem) as gmsh:
        for surface in surfaces:
            _draw(gmsh.model.occ, surface)
        gmsh.model.occ.remove(gmsh.model.occ.getEntities(0))
        gmsh.model.occ.synchronize()
        write_named(gmsh, path, names)


def _draw(occ: Any, surface: SplineSurface) -> None:
    """Add one surface; OpenCASCADE takes distinct knots with their multiplicities, control points with u fastest."""
    knots, repeats = zip(*(np.unique(k, return_counts=True) for k in surface.knots), strict=True)
    if any(r[0] != degree + 1 or r[-1] != degree + 1 for r, degree in zip(repeats, surface.degrees, strict=True)):
        rule = "must be clamped: the first and the last repeated degree + 1 times"
        raise InputError(f"{surface.name}: knots", surface.knots, rule, "insert the end knots first")
    P = surface.control_points
    occ.addBSplineSurface(
        [occ.addPoint(*point) for point in np.swapaxes(P, 0, 1).reshape(-1, 3)],
        len(P),
        degreeU=surface.degrees[0],
        degreeV=surface.degrees[1],
        knotsU=knots[0],
        knotsV=knots[1],
        multiplicitiesU=repeats[0],
        multiplicitiesV=repeats[1],
    )


def step_points(path: Path, parameters: FloatArray) -> dict[str, FloatArray]:
    """Read a STEP file with gmsh and evaluate its surfaces by their own parametrisation.

    Parameters
    ----------
    path : STEP file
    parameters : (k, 2) float [-], (u, v)

    Returns
    -------
    points : name of each surface -> (k, 3) float [m]

    Raises
    ------
    InputError
        If the file cannot be read or holds no surface.
    """
    with gmsh_session("read") as gmsh, in_metres(gmsh):
        try:
            gmsh.model.occ.importShapes(str(path))
        except Exception as error:
            raise InputError("STEP file", path, f"cannot be read: {error}", "check that it is one") from error
        gmsh.model.occ.synchronize()
        faces = gmsh.model.getEntities(2)
        if not faces:
            raise InputError("STEP file", path, "holds no surface", "export the surfaces, not a wireframe")
        names = [gmsh.model.getEntityName(*face).rpartition("/")[2] for face in faces]
        uv = np.asarray(parameters, dtype=np.float64).ravel()
        return {
            name: np.asarray(gmsh.model.getValue(*face, uv)).reshape(-1, 3)
            for name, face in zip(names, faces, strict=True)
        }
