"""Constraints that hold reference nodes to wheels' bodies (thesis eqs 2.20 and 2.24), at three levels.

Twelve equations a wheel, with the body's centre R and the axes b_i that the tire is mounted on:

    r - R = 0,     (a_i . a_j - delta_ij) / 2 = 0 (six),     a_1 . b_2 = a_2 . b_3 = a_3 . b_1 = 0

Verified by tests/verification/test_flexible_formulations.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["NodeConstraints", "node_constraints"]

FloatArray = NDArray[np.float64]
_PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
_TIES = ((0, 1), (1, 2), (2, 0))
SIZE = 12


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NodeConstraints:
    """The equations of all wheels at one state.

    Attributes
    ----------
    defects : (n_w, 12) float
    by_node : (n_w, 12, 4, 3) float, Jacobian by the rates of the node's vectors
    by_body : (n_w, 12, 6) float, Jacobian by the body's twist, world
    accelerations : (n_w, 12) float, Q_c of eq. 2.25
    """

    defects: FloatArray
    by_node: FloatArray
    by_body: FloatArray
    accelerations: FloatArray


def node_constraints(
    z: FloatArray, z_rate: FloatArray, bodies: tuple[FloatArray, FloatArray, FloatArray]
) -> NodeConstraints:
    """Evaluate them.

    Parameters
    ----------
    z, z_rate : (n_w, 4, 3) float, reference nodes and their rates
    bodies : centres (n_w, 3), mounted axes as columns (n_w, 3, 3), twists (n_w, 6), world
    """
    R, B, twist = bodies
    n, axes, w = len(z), np.swapaxes(B, -1, -2), twist[:, 3:]
    a, a_rate = z[:, 1:], z_rate[:, 1:]
    turned = np.cross(w[:, None], axes)  # rates of the axes
    defects, Q_c = np.zeros((n, SIZE)), np.zeros((n, SIZE))
    by_node, by_body = np.zeros((n, SIZE, 4, 3)), np.zeros((n, SIZE, 6))
    defects[:, :3] = z[:, 0] - R
    for k in range(3):
        by_node[:, k, 0, k], by_body[:, k, k] = 1.0, -1.0
    for row, (i, j) in enumerate(_PAIRS, start=3):
        defects[:, row] = 0.5 * (np.sum(a[:, i] * a[:, j], axis=-1) - (i == j))
        by_node[:, row, 1 + i] += 0.5 * a[:, j]
        by_node[:, row, 1 + j] += 0.5 * a[:, i]
        Q_c[:, row] = -np.sum(a_rate[:, i] * a_rate[:, j], axis=-1)
    for row, (i, j) in enumerate(_TIES, start=9):
        defects[:, row] = np.sum(a[:, i] * axes[:, j], axis=-1)
        by_node[:, row, 1 + i] = axes[:, j]
        by_body[:, row, 3:] = np.cross(axes[:, j], a[:, i])  # a . (w x b) = w . (b x a)
        spun = np.cross(w, turned[:, j])
        Q_c[:, row] = -2.0 * np.sum(a_rate[:, i] * turned[:, j], axis=-1) - np.sum(a[:, i] * spun, axis=-1)
    return NodeConstraints(defects=defects, by_node=by_node, by_body=by_body, accelerations=Q_c)
