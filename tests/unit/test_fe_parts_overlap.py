"""Overlap of bodies found from their shape alone: blocks whose overlap is known, in every attitude and order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from reference_fe.contact.parts_overlap import PartsOverlap
from reference_fe.verification.structured_hexahedra import block_mesh, stacked

PLATE = np.array([1.0, 0.8, 0.02])
TURN = np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]])


def two_plates(order: int = 2) -> TaggedMesh:
    """A plate 20 mm thick, and a smaller one of other cells 50 mm above it, turned in space."""
    low = block_mesh((3, 2, 1), lambda X: (X * PLATE) @ TURN, order)
    high = block_mesh((2, 3, 1), lambda X: (X * 0.5 * PLATE + [0.2, 0.2, 0.07]) @ TURN, order)
    return stacked(low, high, "lid")


def sunk(mesh: TaggedMesh, by: float) -> NDArray[np.float64]:
    """The lid lowered at right angles to the plates."""
    displacement = np.zeros_like(mesh.points)
    lid = np.unique(mesh.cells[mesh.cell_tags == 2])
    displacement[lid] = np.array([0.0, 0.0, -by]) @ TURN
    return displacement


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(("sink", "depth"), [(0.0, 0.0), (0.0499, 0.0), (0.0504, 0.0004), (0.055, 0.005)])
def test_depth_is_how_far_the_lid_sinks_in(order: int, sink: float, depth: float) -> None:
    mesh = two_plates(order)
    found = PartsOverlap(mesh).deepest(sunk(mesh, sink))
    assert found.depth == pytest.approx(depth, abs=1e-9)
    assert found.parts == (("", "") if depth == 0.0 else found.parts)
    assert set(found.parts) == ({""} if depth == 0.0 else {"body", "lid"})


def test_a_plate_that_has_passed_through_is_seen_where_it_crosses() -> None:
    """A lid bent down through the other plate: most of it lies beyond, none of its nodes need lie inside."""
    mesh = two_plates()
    displacement = sunk(mesh, 0.0)
    upright = mesh.points @ TURN.T
    lid = np.unique(mesh.cells[mesh.cell_tags == 2])
    displacement[lid] = np.column_stack([np.zeros((len(lid), 2)), -0.4 * (upright[lid, 0] - 0.2)]) @ TURN
    assert PartsOverlap(mesh).deepest(displacement).depth > 0.002


def test_a_body_beside_or_behind_another_does_not_overlap() -> None:
    mesh = two_plates()
    lid = np.unique(mesh.cells[mesh.cell_tags == 2])
    for shift in ([0.9, 0.0, -0.055], [0.0, 0.0, -0.12], [-0.71, 0.0, -0.055]):
        displacement = np.zeros_like(mesh.points)
        displacement[lid] = np.array(shift) @ TURN
        assert PartsOverlap(mesh).deepest(displacement).depth == 0.0


def test_welded_parts_do_not_overlap_at_their_weld() -> None:
    mesh = block_mesh((3, 2, 2), lambda X: X * PLATE)
    upper = mesh.points[mesh.cells].mean(axis=1)[:, 2] > 0.5 * PLATE[2]
    welded = replace(mesh, cell_tags=np.where(upper, 2, 1).astype(np.int32), parts={"body": 1, "lid": 2})
    bent = np.column_stack([0.0 * mesh.points[:, 0], 0.0 * mesh.points[:, 0], 0.1 * mesh.points[:, 0] ** 2])
    assert PartsOverlap(welded).deepest(bent).depth < 1e-9


def test_a_plane_of_symmetry_is_no_surface() -> None:
    """A lid that sinks in along the plane alone: its depth there is the whole one, not the distance from the plane."""
    low = block_mesh((3, 2, 1), lambda X: X * PLATE)
    high = block_mesh((2, 3, 1), lambda X: X * 0.5 * PLATE + [0.2, 0.0, 0.07])
    mesh = stacked(low, high, "lid")
    displacement = np.zeros_like(mesh.points)
    lid = np.unique(mesh.cells[mesh.cell_tags == 2])
    displacement[lid, 2] = -0.052 + 0.5 * mesh.points[lid, 1]
    assert PartsOverlap(mesh).deepest(displacement).depth < 0.001
    half = replace(mesh, faces=dict(mesh.faces) | {"symmetry": 99})
    assert PartsOverlap(half).deepest(displacement).depth == pytest.approx(0.002, rel=0.01)
