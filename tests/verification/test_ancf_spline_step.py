"""The ANCF tire in a STEP file: gmsh reads back the same surfaces, loaded or not.

Claim: points gmsh finds on the exported surfaces, by their own parametrisation, are those of the plates (thesis eqs.
2.11 to 2.13, evaluated without Bezier patches), for the lower, middle and upper surface of each plate.
Source: a plate's surfaces are bicubic Bezier patches (ancf_reduced/plates/bezier.py); B_SPLINE_SURFACE_WITH_KNOTS
holds them. Tolerance: 1e-9 m, the issue's; the file has 13 digits of a millimetre. Measured: 1e-13 m.
What is read as control points becomes the same plates again, to 1e-12 m.
Negative controls: a control point moved by 10 nm before the export; the other state's surface; the patch turned over.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.plates.spline_plates import FACES, plate_surfaces, plates_between
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.static import solve_tire
from ancf_reduced.tire.surfaces import surface_grid
from geometry.spline_surface import SplineSurface
from geometry.step_surfaces import read_surfaces_step
from geometry.surface_step import step_points, write_surfaces_step

TOLERANCE = 1e-9
N = 9
TIRE = build_tire(thesis_preset())
LINE = np.linspace(0.0, 1.0, N)
UV = np.stack(np.meshgrid(LINE, LINE, indexing="ij"), axis=-1).reshape(-1, 2)


@pytest.fixture(scope="module")
def states() -> dict[str, np.ndarray]:
    """Coordinates unloaded and at 10 mm, at an orientation without symmetry."""
    loaded = solve_tire(TIRE, np.radians(17.0), [0.010])
    assert loaded.load[0] > 10.0
    return {"unloaded": TIRE.mesh.reference_coordinates(), "loaded": loaded.coordinates[0]}


def _deviation(path: Path, coordinates: np.ndarray) -> float:
    """Largest distance between surfaces read and plates, at N x N points of each [m]."""
    found = step_points(path, UV)
    assert len(found) == 3 * len(TIRE.mesh.elements)
    grids = {face: surface_grid(TIRE.mesh, coordinates, N, zeta) for face, zeta in FACES.items()}
    return max(
        float(np.linalg.norm(found[f"{part} {j} {face}"] - grid[j].reshape(-1, 3), axis=1).max())
        for j, part in enumerate(TIRE.mesh.parts)
        for face, grid in grids.items()
    )


@pytest.mark.parametrize("state", ["unloaded", "loaded"])
def test_gmsh_reads_the_same_surfaces(states: dict[str, np.ndarray], state: str, tmp_path: Path) -> None:
    path = tmp_path / f"{state}.step"
    write_surfaces_step(plate_surfaces(TIRE.mesh, states[state]), path)
    assert _deviation(path, states[state]) < TOLERANCE


@pytest.mark.parametrize("state", ["unloaded", "loaded"])
def test_the_file_is_the_mesh(states: dict[str, np.ndarray], state: str, tmp_path: Path) -> None:
    """Plates between the faces read from the file: the same corners and frames, so the same elements."""
    path = tmp_path / f"{state}.step"
    write_surfaces_step(plate_surfaces(TIRE.mesh, states[state]), path)
    found = {surface.name: surface for surface in read_surfaces_step(path)}
    e = TIRE.mesh.normalised(states[state], TIRE.mesh.gradients * TIRE.mesh.dimensions[:, None, None, :])
    for j, part in enumerate(TIRE.mesh.parts):
        plates = plates_between(found[f"{part} {j} lower"], found[f"{part} {j} upper"], part=part)
        (patch,) = plates.patches
        nodes = np.concatenate([patch.corners[:, None], np.swapaxes(patch.gradients * patch.dimensions, 1, 2)], axis=1)
        np.testing.assert_allclose(nodes.reshape(16, 3), e[j], rtol=0, atol=1e-12)
        assert plates.residual[0] < 1e-12


def _moved(surface: SplineSurface) -> SplineSurface:
    points = surface.control_points.copy()
    points[1, 2] += 1e-8
    return replace(surface, control_points=points)


def _turned(surface: SplineSurface) -> SplineSurface:
    return replace(surface, control_points=surface.control_points[::-1])


@pytest.mark.parametrize("damage", [_moved, _turned])
def test_negative_control_a_damaged_surface_is_seen(states: dict[str, np.ndarray], damage, tmp_path: Path) -> None:
    first, *others = plate_surfaces(TIRE.mesh, states["loaded"])
    write_surfaces_step([damage(first), *others], tmp_path / "damaged.step")
    assert _deviation(tmp_path / "damaged.step", states["loaded"]) > TOLERANCE


def test_negative_control_the_states_differ(states: dict[str, np.ndarray], tmp_path: Path) -> None:
    write_surfaces_step(plate_surfaces(TIRE.mesh, states["unloaded"]), tmp_path / "tire.step")
    assert _deviation(tmp_path / "tire.step", states["loaded"]) > 1e-3
