"""Overlap of a part with a face, on plates whose distance is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.mesh import TaggedMesh
from reference_fe.contact.overlap import FaceOverlap
from reference_fe.verification.structured_hexahedra import block_mesh

GAP = 0.02


def two_plates() -> TaggedMesh:
    """A lower plate (part body, upper face z1) and an upper one (part lid) ``GAP`` above it."""
    low = block_mesh((3, 2, 1), lambda X: X * np.array([1.0, 1.0, 0.1]))
    shift = len(low.points)
    return replace(
        low,
        points=np.vstack([low.points, low.points + np.array([0.0, 0.0, 0.1 + GAP])]),
        cells=np.vstack([low.cells, low.cells + shift]),
        cell_tags=np.repeat(np.array([1, 2], dtype=np.int32), len(low.cells)),
        parts={"body": 1, "lid": 2},
    )


@pytest.mark.parametrize("sink", [0.0, 0.015, 0.05])
def test_gap_closes_and_turns_negative(sink: float) -> None:
    mesh = two_plates()
    displacement = np.zeros_like(mesh.points)
    displacement[len(mesh.points) // 2 :, 2] = -sink
    assert FaceOverlap(mesh, ("lid",), "z1").smallest_gap(displacement) == pytest.approx(GAP - sink, abs=1e-12)


@pytest.mark.parametrize("sink", [0.0, 0.015, 0.05])
def test_edges_of_a_planar_mesh_have_the_same_gap(sink: float) -> None:
    square = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    low = np.array(square) * [0.5, 0.05]
    mesh = TaggedMesh(
        points=np.vstack([low, low + np.array([0.0, 0.1 + GAP])]),
        cells=np.arange(18).reshape(2, 9),
        cell_tags=np.array([1, 2], dtype=np.int32),
        facets=np.array([[2, 3, 6]]),
        facet_tags=np.array([1], dtype=np.int32),
        parts={"body": 1, "lid": 2},
        faces={"top": 1},
        widths={"body": 1.0, "lid": 0.5},
    )
    displacement = np.zeros_like(mesh.points)
    displacement[9:, 1] = -sink
    assert FaceOverlap(mesh, ("lid",), "top").smallest_gap(displacement) == pytest.approx(GAP - sink, abs=1e-12)
