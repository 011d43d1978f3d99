"""Reference nodes eliminated onto wheels' bodies: rates are derivatives, and forces do the same work."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.flexible.flexible_system import node_jacobians
from rover_dynamics.flexible.hub_kernels import HubMotion, hub_motion, hub_wrenches, wheel_jacobians
from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.joint import revolute
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.tree_kernels import advance, tree_motion

FloatArray = NDArray[np.float64]
FRAME = body("frame", 3.0, (0.1, 0.2, 0.3), (0.0, 0.0, 0.2))
WHEEL = body("wheel", 1.0, (0.01, 0.02, 0.01), (0.4, 0.1, 0.2))
HINGE = revolute("axle", FRAME, WHEEL, at=(0.4, 0.1, 0.2), axis=(0.0, 1.0, 0.0))
TREE = TreeCoordinates(MultibodyModel(bodies=(FRAME, WHEEL), joints=(HINGE,)))
WHEELS = np.array([1])
MOUNTS = np.array([[[np.cos(0.3), 0.0, np.sin(0.3)], [0.0, 1.0, 0.0], [-np.sin(0.3), 0.0, np.cos(0.3)]]])
RNG = np.random.default_rng(4)
V, A = RNG.normal(size=7), RNG.normal(size=7)
START = TREE.start()[:8]


def node(q: FloatArray, v: FloatArray, a: FloatArray) -> tuple[HubMotion, FloatArray]:
    """Reference node and Jacobian at joint coordinates, velocities and accelerations."""
    motion = tree_motion(TREE.tree, q, v)
    J = wheel_jacobians(TREE.tree, motion, WHEELS)
    return hub_motion(motion, WHEELS, MOUNTS, J @ a + motion.accelerations[WHEELS]), J


def after(h: float) -> HubMotion:
    """The node a short time later, at constant joint accelerations."""
    q = advance(TREE.tree, START, h * V + 0.5 * h * h * A, TREE.tree.turns)
    return node(q, V + h * A, A)[0]


def test_rates_and_accelerations_are_derivatives() -> None:
    h = 1e-5
    here, back, forth = after(0.0), after(-h), after(h)
    np.testing.assert_allclose(here.v, (forth.z - back.z) / (2.0 * h), atol=1e-8)
    np.testing.assert_allclose(here.a, (forth.v - back.v) / (2.0 * h), atol=1e-7)


def test_gradients_are_the_axes_of_the_mounted_tire() -> None:
    here = after(0.0)
    np.testing.assert_allclose(here.z[0, 1:], MOUNTS[0].T, atol=1e-14)
    np.testing.assert_allclose(here.z[0, 0], [0.4, 0.1, 0.2], atol=1e-14)


def test_wrenches_do_the_work_of_the_forces() -> None:
    here, J = node(START, V, A)
    forces = RNG.normal(size=(1, 4, 3))
    wrench = hub_wrenches(here.z, forces)
    np.testing.assert_allclose(np.sum(wrench * (J @ V)), np.sum(forces * here.v), rtol=1e-12)
    np.testing.assert_allclose(node_jacobians(here.z, J) @ V, here.v, atol=1e-13)
