"""Overlap of a part with a face, on plates whose distance is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.mesh import TaggedMesh
from reference_fe.overlap import FaceOverlap
from tests.structured_hexahedra import block_mesh

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
