"""Quality and joint areas of shapes whose values are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contracts.mesh import TaggedMesh
from geometry.assembly import RawMesh, assemble
from geometry.hexahedra import reference_nodes
from geometry.measures import joint_areas, mesh_quality, mesh_volume


def sheared(angle: float) -> TaggedMesh:
    """Two stacked cells of 2 x 2 x 2 m, sheared by ``angle`` in the x-z plane; parts a (below) and b (above)."""
    x = reference_nodes(27)
    shear = np.array([[1.0, 0, 0], [0, 1, 0], [math.tan(angle), 0, 1]])
    points = np.vstack([x, x + np.array([0.0, 0.0, 2.0])]) @ shear
    cells = np.arange(27)[None, :]
    raw = RawMesh(
        points=points, cells=[("a", cells), ("b", cells + 27)], quadrangles=[("foot", np.array([[0, 3, 2, 1]]))]
    )
    return assemble(raw, ["a", "b"])


@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_scaled_jacobian_of_a_sheared_brick_is_the_cosine(angle: float) -> None:
    quality = mesh_quality(sheared(angle))
    assert quality.min_scaled_jacobian == pytest.approx(math.cos(angle))
    assert quality.mean_scaled_jacobian == pytest.approx(math.cos(angle))
    assert quality.max_aspect_ratio == pytest.approx(1.0 / math.cos(angle))
    assert quality.min_edge == pytest.approx(2.0)
    assert (quality.n_cells, quality.n_points, quality.order) == (2, 45, 2)


def test_volume_and_joint() -> None:
    mesh = sheared(0.5)
    assert mesh_volume(mesh) == pytest.approx({"a": 8.0, "b": 8.0})
    assert joint_areas(mesh) == {("a", "b"): pytest.approx(4.0)}
