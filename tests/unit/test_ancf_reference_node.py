"""Reference node: tied nodes follow its position and gradients (thesis eq. 2.20, signs mended)."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ancf_reduced.motion.reference_node import rigid_reference_node, tie_reference_node
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError

TIRE = build_tire(thesis_preset())


def test_hub_nodes_follow_a_rigid_body() -> None:
    R, position = Rotation.from_rotvec([0.5, -0.3, 2.0]).as_matrix(), np.array([0.1, 0.2, 0.3])
    free = TIRE.mesh.reference_coordinates()[TIRE.tie.free]
    p = TIRE.tie.expand(free, rigid_reference_node(position, R))[TIRE.tie.tied]
    np.testing.assert_allclose(p[:, 0], position + TIRE.mesh.points[TIRE.tie.tied] @ R.T, atol=1e-15)
    np.testing.assert_allclose(np.swapaxes(p[:, 1:], 1, 2), np.repeat(R[None], 8, axis=0), atol=1e-15)


def test_reference_configuration_is_reproduced() -> None:
    p0 = TIRE.mesh.reference_coordinates()
    hub = rigid_reference_node(np.zeros(3), np.eye(3))
    np.testing.assert_allclose(TIRE.tie.expand(p0[TIRE.tie.free], hub), p0, atol=1e-15)
    assert len(TIRE.tie.free) == len(TIRE.tie.tied) == 8


def test_structure_coordinates_and_plate_coordinates_give_the_same_tie() -> None:
    """J^kr = I on p and then e = T p is the thesis' J^kr = J0 on a plate's own coordinates e."""
    mesh, spoke = TIRE.mesh, TIRE.mesh.plates_of("spoke")[1]
    reference = np.random.default_rng(8).normal(size=(4, 3))
    e = mesh.element_coordinates(TIRE.tie.expand(np.zeros((8, 4, 3)), reference))[spoke].reshape(4, 4, 3)
    own = tie_reference_node(mesh, mesh.elements[spoke], np.zeros(3), mesh.gradients[spoke]).map @ reference
    np.testing.assert_allclose(own[[0, 3]], e[[0, 3]], atol=1e-14)


def test_reference_force_does_the_same_work() -> None:
    rng = np.random.default_rng(9)
    force, motion = rng.normal(size=(16, 4, 3)), rng.normal(size=(4, 3))
    displacement = TIRE.tie.expand(np.zeros((8, 4, 3)), motion)
    work = float((force[TIRE.tie.tied] * displacement[TIRE.tie.tied]).sum())
    assert float((TIRE.tie.reference_force(force) * motion).sum()) == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize("nodes", [[], [0, 0], [-1], [16]])
def test_bad_nodes_are_refused(nodes: list[int]) -> None:
    with pytest.raises(InputError, match="tied nodes"):
        tie_reference_node(TIRE.mesh, nodes, np.zeros(3))
