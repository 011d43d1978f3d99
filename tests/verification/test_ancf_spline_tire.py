"""A tire given as B-spline patches is the tire of plates.

Claim: a closed cubic B-spline ring (10 x 2 control points) and four flat spokes become the mesh of `build_tire` without
meshing, with the same load at 10 mm; a surface outside the element's space is reported with its distance, which falls
with the fourth power of the pieces' size.
Source: thesis eq. 2.13 and section 3.3; a cubic arc with the control polygon's legs (4/3) tan(alpha/4) R has
|r_x1| = (4/alpha) tan(alpha/4) in arc length (docs/theory.md, 3.2). A bilinearly blended Coons patch interpolates its
edges, so the error is the mixed derivative r_uuvv h^4 (Gordon 1971).
Tolerance: 1e-12 m in positions and frames J0 diag(a, b, t): rounding of coordinates of 0.1 m through the 4 x 4 inverse;
1e-9 of the load, ten times Newton's own. Order 4 within 0.2.
Negative controls: one control point of the ring moved by 1 mm; a ring of another radius; unit tangents.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ancf_reduced.plates.bezier import coons_residual
from ancf_reduced.plates.mesh import PlateMesh, build_plate_mesh
from ancf_reduced.plates.spline_plates import plates_on_surface
from ancf_reduced.tire.mesh import build_tire, tire_on_mesh
from ancf_reduced.tire.preset import refined_preset, thesis_preset
from ancf_reduced.tire.static import solve_tire
from ancf_reduced.tire.surfaces import surface_grid
from contracts.errors import InputError
from geometry.spline_surface import SplineSurface
from geometry.step_surfaces import read_surfaces_step
from geometry.surface_step import write_surfaces_step
from tests.spline_tire import ring, spline_mesh, spokes

PRESET = thesis_preset()
DEFLECTION = 0.010
LENGTH_TOLERANCE = 1e-12
LOAD_TOLERANCE = 1e-9


def _frames(mesh: PlateMesh) -> np.ndarray:
    """J0 diag(a, b, t) [m], all that the element sees of its reference gradients and lengths."""
    return mesh.gradients * mesh.dimensions[:, None, None, :]


def _distance(one: PlateMesh, two: PlateMesh) -> float:
    """Largest difference of nodes and frames [m]; infinite for meshes that are joined otherwise."""
    if not np.array_equal(one.elements, two.elements):
        return np.inf
    return max(float(np.abs(one.points - two.points).max()), float(np.abs(_frames(one) - _frames(two)).max()))


def test_a_step_file_of_five_surfaces_is_the_mesh(tmp_path: Path) -> None:
    """CAD to analysis: the ring and the spokes from a STEP file, nothing else."""
    write_surfaces_step([ring(PRESET, 4), *spokes(PRESET)], tmp_path / "tire.step")
    rim, *found = read_surfaces_step(tmp_path / "tire.step")
    assert (rim.name, len(found)) == ("ring", 4)
    assert _distance(spline_mesh(PRESET, rim, found), build_tire(PRESET).mesh) < LENGTH_TOLERANCE


def _moved(row: int) -> SplineSurface:
    """The ring with one control point 1 mm further from the axle."""
    rim = ring(PRESET, 4)
    points = rim.control_points.copy()
    points[row, 0, ::2] *= 1.0 + 1e-3 / np.hypot(*points[row, 0, ::2])
    return replace(rim, control_points=points)


@pytest.mark.parametrize("plates", [4, 8])
def test_the_ring_is_the_mesh(plates: int) -> None:
    preset = refined_preset(PRESET, plates)
    mesh = spline_mesh(preset, ring(preset, plates), spokes(preset))
    reference = build_tire(preset).mesh
    assert mesh.parts == reference.parts
    assert _distance(mesh, reference) < LENGTH_TOLERANCE
    np.testing.assert_allclose(mesh.dimensions, reference.dimensions, rtol=5e-4)  # the cubic's own length


@pytest.mark.parametrize("phi", [0.0, np.pi / 4])
def test_the_load_is_the_same(phi: float) -> None:
    """At 10 mm, spoke down and between spokes."""
    tire = tire_on_mesh(PRESET, spline_mesh(PRESET, ring(PRESET, 4), spokes(PRESET)))
    load = solve_tire(tire, phi, [DEFLECTION]).load[0]
    assert load == pytest.approx(solve_tire(build_tire(PRESET), phi, [DEFLECTION]).load[0], rel=LOAD_TOLERANCE)
    assert load > 40.0


def test_negative_control_a_moved_control_point() -> None:
    """Beside the clamped seam it turns a tangent: frames and load miss. Elsewhere it moves the rim off a spoke."""
    mesh, reference = spline_mesh(PRESET, _moved(1), spokes(PRESET)), build_tire(PRESET)
    assert 1e-4 < _distance(mesh, reference.mesh) < 1e-2
    load = solve_tire(tire_on_mesh(PRESET, mesh), np.pi / 4, [DEFLECTION]).load[0]
    assert load != pytest.approx(solve_tire(reference, np.pi / 4, [DEFLECTION]).load[0], rel=1e6 * LOAD_TOLERANCE)
    assert _distance(spline_mesh(PRESET, _moved(4), spokes(PRESET)), reference.mesh) == np.inf


def test_negative_control_unit_tangents_and_another_radius() -> None:
    mesh = spline_mesh(PRESET, ring(PRESET, 4), spokes(PRESET))
    assert _distance(mesh, build_tire(PRESET, tangent_length=lambda angle: 1.0).mesh) > 1e-3
    wider = replace(PRESET, outer_radius=PRESET.outer_radius + 1e-6)
    assert _distance(mesh, build_tire(wider).mesh) > LENGTH_TOLERANCE


def _barrel() -> SplineSurface:
    """A crowned tire: the ring's inner columns of control points 6 mm further out, cubic across."""
    flat = ring(PRESET, 4).bezier_pieces()
    points = flat.copy()
    points[:, :, :, 1:3, ::2] *= 1.0 + 6e-3 / PRESET.rim_radius
    u = points[:, 0]
    line = np.concatenate([u[0, :1], *(piece[1:] for piece in u)])
    knots = np.concatenate([[0.0] * 4, np.repeat([1.0, 2.0, 3.0], 3), [4.0] * 4])
    return SplineSurface(name="barrel", control_points=line, degrees=(3, 3), knots=(knots, np.repeat([0.0, 1.0], 4)))


def test_a_crowned_tire_is_reported_with_its_residual() -> None:
    """Doubly curved, so outside the space: refused with the distance, unless it is accepted."""
    surface = _barrel()
    with pytest.raises(InputError, match=r"barrel: residual = \S+ m: must be at most 1e-09 m"):
        plates_on_surface(surface, PRESET.rim_thickness, part="rim")
    assert coons_residual(surface.bezier_pieces()).max() > 1e-4


def test_the_residual_bounds_the_error_and_falls_with_the_fourth_order() -> None:
    """Against the surface itself, at 21 x 21 points of every plate."""
    surface, residuals = _barrel(), []
    for cuts in (1, 2, 4):
        found = plates_on_surface(surface, PRESET.rim_thickness, part="rim", subdivisions=(cuts, cuts), tolerance=1.0)
        residuals.append(found.residual.max())
        error = np.linalg.norm(_plate_points(found.patches) - _surface_points(surface, cuts), axis=-1)
        assert np.all(error.max(axis=1) <= found.residual + 1e-15)
        assert error.max() > 0.5 * residuals[-1]
    orders = np.log2(np.array(residuals[:-1]) / residuals[1:])
    assert np.abs(orders - 4.0).max() < 0.2, orders


def _plate_points(patches: tuple) -> np.ndarray:
    mesh = build_plate_mesh(patches)
    return surface_grid(mesh, mesh.reference_coordinates(), 21).reshape(len(patches), -1, 3)


def _surface_points(surface: SplineSurface, cuts: int) -> np.ndarray:
    """The same points on the B-spline surface."""
    line = np.linspace(0.0, 1.0, 21)
    local = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    cells = [(i, j) for i in range(4 * cuts) for j in range(cuts)]
    return np.array([surface.value((np.array(cell) + local) / cuts) for cell in cells])
