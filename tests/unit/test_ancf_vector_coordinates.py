"""Independent vectors of held, tied and several meshes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.motion.vector_coordinates import all_free, side_by_side, with_held_vectors, with_reference_node
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError

TIRE = build_tire(thesis_preset())
STRIP = build_plate_mesh(
    [
        flat_patch(np.array([i * 0.1, 0, 0]), np.array([0.1, 0, 0]), np.array([0, 0.2, 0]), 0.01, "strip")
        for i in range(2)
    ]
)


def test_clamp_leaves_the_other_nodes() -> None:
    held = np.repeat((STRIP.points[:, 0] < 1e-9)[:, None], 4, axis=1)
    coordinates = with_held_vectors(STRIP, held)
    assert coordinates.n_vectors == 16
    p = STRIP.reference_coordinates()
    moved = p + np.where(held[..., None], 0.0, np.random.default_rng(1).normal(size=p.shape))
    np.testing.assert_allclose(coordinates.expand(coordinates.restrict(moved)), moved, atol=1e-14)
    force = np.random.default_rng(2).normal(size=p.shape)
    np.testing.assert_array_equal(coordinates.reduce(force), force[~held])


def test_reference_node_is_the_tie() -> None:
    """The map equals `reference_node.ReferenceNodeTie.expand`, and the reduced force its transpose."""
    coordinates, rng = with_reference_node(TIRE.tie), np.random.default_rng(3)
    free, reference = rng.normal(size=(len(TIRE.tie.free), 4, 3)), rng.normal(size=(4, 3))
    z = np.vstack([free.reshape(-1, 3), reference])
    np.testing.assert_allclose(coordinates.expand(z), TIRE.tie.expand(free, reference), atol=1e-14)
    force = rng.normal(size=(len(TIRE.mesh.points), 4, 3))
    np.testing.assert_allclose(coordinates.reduce(force)[-4:], TIRE.tie.reference_force(force), atol=1e-12)
    np.testing.assert_array_equal(coordinates.triads, [[len(z) - 4, len(z) - 3, len(z) - 2, len(z) - 1]])
    free_positions = np.arange(0, len(z) - 4, 4)
    np.testing.assert_array_equal(coordinates.position_rows, [*free_positions, len(z) - 4])


def test_held_vectors_of_the_reference_node_are_constant() -> None:
    coordinates = with_reference_node(TIRE.tie, held=(True, False, True, False))
    whole = with_reference_node(TIRE.tie)
    assert coordinates.n_vectors == whole.n_vectors - 2
    assert coordinates.triads[0, 0] == coordinates.triads[0, 2] == -1
    z = np.random.default_rng(4).normal(size=(whole.n_vectors, 3))
    z[-4], z[-2] = TIRE.tie.origin, [0.0, 1.0, 0.0]
    kept = np.delete(z, [len(z) - 4, len(z) - 2], axis=0)
    np.testing.assert_allclose(coordinates.expand(kept), whole.expand(z), atol=1e-14)


def test_virtual_work_is_the_same_on_both_sides() -> None:
    coordinates, rng = with_reference_node(TIRE.tie), np.random.default_rng(5)
    v, force = rng.normal(size=(coordinates.n_vectors, 3)), rng.normal(size=(len(TIRE.mesh.points), 4, 3))
    work = float(np.sum(coordinates.reduce(force) * v))
    assert work == pytest.approx(float(np.sum(force * coordinates.expand_rates(v))), rel=1e-12)


def test_six_wheels_side_by_side() -> None:
    one = with_reference_node(TIRE.tie)
    six = side_by_side([one] * 6)
    assert six.n_vectors == 6 * one.n_vectors
    np.testing.assert_array_equal(six.triads[3], one.triads[0] + 3 * one.n_vectors)
    z = np.random.default_rng(6).normal(size=(six.n_vectors, 3))
    parts = [one.expand(part) for part in np.split(z, 6)]
    np.testing.assert_allclose(six.expand(z), np.concatenate(parts), atol=1e-13)


def test_rigid_motion_of_the_reference_node_moves_tied_nodes_rigidly() -> None:
    """Signs of thesis eq. 2.20, mended: as printed a turned hub would not stay rigid."""
    coordinates = with_reference_node(TIRE.tie)
    R = Rotation.from_rotvec([0.3, 1.0, -0.4]).as_matrix()
    p = TIRE.mesh.reference_coordinates() @ R.T
    z = coordinates.restrict(p)
    np.testing.assert_allclose(coordinates.expand(z), p, atol=1e-12)
    np.testing.assert_allclose(z[-3:], R.T, atol=1e-12)


def test_flags_of_the_wrong_shape_are_refused() -> None:
    with pytest.raises(InputError, match="held vectors"):
        with_held_vectors(STRIP, np.zeros((3, 4), dtype=bool))
    assert all_free(STRIP).n_vectors == 24
