"""Geometry of the tire: counts, arc, faces, surfaces; and that the package imports without compiling."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from ancf_reduced.tire.mesh import arc_tangent_length, build_tire
from ancf_reduced.tire.preset import refined_preset, thesis_preset
from ancf_reduced.tire.surfaces import surface_grid, tire_surfaces

TIRE = build_tire(thesis_preset())


def test_thesis_tire_has_16_nodes_and_8_plates() -> None:
    assert (len(TIRE.mesh.points), len(TIRE.mesh.elements)) == (16, 8)
    assert TIRE.mesh.parts == ("rim",) * 4 + ("spoke",) * 4
    assert TIRE.grid.positions(TIRE.mesh.reference_coordinates()).shape == (4, 100, 3)


def _arc_error(tangent_length: float) -> float:
    """Largest relative error of the rim's mid-surface radius."""
    rim = build_tire(thesis_preset(), tangent_length=lambda angle: tangent_length)
    points = surface_grid(rim.mesh, rim.mesh.reference_coordinates(), n=101)[rim.mesh.plates_of("rim")]
    return float(np.abs(np.hypot(points[..., 0], points[..., 2]) / thesis_preset().rim_radius - 1.0).max())


def test_tangent_length_follows_the_arc() -> None:
    """Source: project theory notes, section 1: 1.05479 and 0.03 % for 90 deg; unit tangents miss by 1.5 %."""
    assert arc_tangent_length(np.pi / 2) == pytest.approx(1.05479, abs=5e-6)
    assert _arc_error(arc_tangent_length(np.pi / 2)) < 3e-4
    assert _arc_error(1.0) == pytest.approx(0.015, abs=0.002)


def test_first_spoke_points_down_and_outer_face_normal_points_out() -> None:
    surfaces = tire_surfaces(TIRE, TIRE.mesh.reference_coordinates(), n=5)
    np.testing.assert_allclose(surfaces.spokes[0, 0, 2], [0.0, 0.0, -0.05], atol=1e-15)
    np.testing.assert_allclose(surfaces.spokes[0, -1, 2], [0.0, 0.0, -0.13], atol=1e-15)
    np.testing.assert_allclose(surfaces.outer_face[0, 0, 2], [0.0, 0.0, -0.1425], atol=1e-15)
    along = surfaces.outer_face[0, 3, 2] - surfaces.outer_face[0, 1, 2]
    across = surfaces.outer_face[0, 2, 3] - surfaces.outer_face[0, 2, 1]
    assert np.cross(along, across) @ surfaces.outer_face[0, 2, 2] > 0.0


@pytest.mark.parametrize(("plates", "per_spoke", "nodes"), [(8, 1, 24), (8, 2, 32), (16, 4, 64)])
def test_refined_tire_ties_the_hub_nodes_only(plates: int, per_spoke: int, nodes: int) -> None:
    tire = build_tire(refined_preset(thesis_preset(), plates, per_spoke))
    assert len(tire.mesh.points) == nodes
    radius = np.hypot(tire.mesh.points[:, 0], tire.mesh.points[:, 2])
    np.testing.assert_array_equal(np.flatnonzero(radius < 0.0501), tire.tie.tied)


def test_package_imports_without_numba() -> None:
    code = "import sys, ancf_reduced, ancf_reduced.tire.preset; print('numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
