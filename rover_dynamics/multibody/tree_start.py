"""Joint coordinates of bodies whose positions are known.

Verified by tests/unit/test_multibody_tree.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contracts.errors import ConvergenceError, IncrementRecord
from rover_dynamics.multibody.state import State, rotations
from rover_dynamics.multibody.tree_jacobians import body_jacobian
from rover_dynamics.multibody.tree_kernels import LinkKind, Tree, TreeMotion, advance, tree_motion

__all__ = ["joint_coordinates", "zero_coordinates"]

FloatArray = NDArray[np.float64]

_ITERATIONS, _TOLERANCE, _LARGEST_STEP = 100, 1e-10, 0.5


def zero_coordinates(tree: Tree) -> FloatArray:
    """Angles and distances of zero, and quaternions of no rotation, (n_q,)."""
    q = np.zeros(tree.q_at[-1])
    for k, kind in enumerate(tree.kinds):
        if kind in (LinkKind.SPHERICAL, LinkKind.FREE):
            q[tree.q_at[k + 1] - 4] = 1.0
    return q


def joint_coordinates(tree: Tree, state: State) -> tuple[FloatArray, FloatArray]:
    """q, (n_q,), and v, (n_v,), of a state that meets the tree's joints, by Gauss-Newton steps on all poses.

    Raises
    ------
    ConvergenceError
        If no joint coordinates give these positions.
    """
    q, v, R = zero_coordinates(tree), np.zeros(tree.v_at[-1]), rotations(state.orientations)
    history: list[float] = []
    for _ in range(_ITERATIONS):
        motion = tree_motion(tree, q, v)
        away, B = _differences(motion, state.positions, R), body_jacobian(tree, motion)
        history.append(float(np.max(np.abs(away))))
        if history[-1] < _TOLERANCE:
            return q, np.asarray(np.linalg.lstsq(B, state.velocities.ravel(), rcond=None)[0])
        step = np.linalg.lstsq(B, away.ravel(), rcond=None)[0]
        q = advance(tree, q, step * min(1.0, _LARGEST_STEP / max(float(np.max(np.abs(step))), 1e-300)), motion.frames)
    message = f"no joint coordinates found for the bodies' positions: {history[-1]:.3g} away; check the joints' frames"
    record = IncrementRecord(target=0.0, step=0.0, converged=False, residuals=tuple(history))
    raise ConvergenceError(message, [record])


def _differences(motion: TreeMotion, positions: FloatArray, R: FloatArray) -> FloatArray:
    """Displacement and rotation that would bring each body to its place, (n_b, 6), world axes."""
    turn = Rotation.from_matrix(R @ motion.rotations[:-1].swapaxes(1, 2)).as_rotvec()
    return np.hstack([positions - motion.positions[:-1], turn])
