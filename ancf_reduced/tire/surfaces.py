"""Surfaces of deformed plates as grids of points, for pictures and geometry checks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.mesh import PlateMesh
from ancf_reduced.plates.shape_functions import plate_shape
from ancf_reduced.tire.mesh import RIM, SPOKE, Tire

__all__ = ["TireSurfaces", "outer_face_error", "surface_grid", "tire_surfaces"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class TireSurfaces:
    """A tire's surfaces in the wheel frame; each plate one n x n grid, x1 along the first axis.

    Attributes
    ----------
    outer_face : (n_rim, n, n, 3) float [m], the rim's face towards the ground (zeta = +1/2)
    spokes : (n_spokes, n, n, 3) float [m], the spokes' mid-surfaces
    """

    outer_face: FloatArray
    spokes: FloatArray


def surface_grid(mesh: PlateMesh, coordinates: FloatArray, n: int = 11, zeta: float = 0.0) -> FloatArray:
    """Points of all plates' surfaces zeta = const (thesis eq. 2.11).

    Parameters
    ----------
    mesh : plates
    coordinates : (n_nodes, 4, 3) float [m, -]
    n : points along x1 and x2
    zeta : 0 for mid-surfaces, -1/2 and +1/2 for the faces

    Returns
    -------
    points : (n_plates, n, n, 3) float [m]

    Verified by tests/unit/test_ancf_tire_mesh.py.
    """
    line = np.linspace(0.0, 1.0, n)
    xi = np.stack(np.meshgrid(line, line, [zeta], indexing="ij"), axis=-1).reshape(-1, 3)
    shape = np.array([plate_shape(xi, dimensions) for dimensions in mesh.dimensions])
    return (shape @ mesh.element_coordinates(coordinates)).reshape(-1, n, n, 3)


def tire_surfaces(tire: Tire, coordinates: FloatArray, n: int = 11) -> TireSurfaces:
    """Outer face of the rim and mid-surfaces of the spokes at given coordinates (n_nodes, 4, 3)."""
    mesh = tire.mesh
    return TireSurfaces(
        outer_face=surface_grid(mesh, coordinates, n, 0.5)[mesh.plates_of(RIM)],
        spokes=surface_grid(mesh, coordinates, n)[mesh.plates_of(SPOKE)],
    )


def outer_face_error(tire: Tire, n: int = 101) -> float:
    """How far the unloaded outer face lies inside the nominal circle, at most [m].

    Directors interpolated bilinearly shrink by cos(alpha/2) half-way between nodes alpha apart: t/2 (1 - cos(alpha/2))
    at mid-element, 3.66 mm for the thesis preset (alpha = 90 deg, t = 25 mm).

    Verified by tests/verification/test_ancf_tire_refinement.py.
    """
    face = tire_surfaces(tire, tire.mesh.reference_coordinates(), n).outer_face
    return float(tire.preset.outer_radius - np.hypot(face[..., 0], face[..., 2]).min())
