"""Newton's matrix of a step: each tire's free vectors condensed onto the motion of its hub.

For one tire, in the axes of its hub, with the matrix S = c M + dt gamma C + dt^2 beta K of the accelerations split into
free vectors f and reference node r, and the hub's motion D (12, 6) of the node's vectors for a twist:

    S_ff dA_f + S_fr D t = rho_f,      wrench  -D^T (S_rf dA_f + S_rr D t)

so the hub feels E = D^T (S_rr - S_rf S_ff^-1 S_fr) D. In these axes the matrix changes only with the tire's shape: it
serves for many steps of a wheel that rolls. Verified by tests/verification/test_flexible_motion.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, csc_array
from scipy.sparse.linalg import splu

from contracts.nodal_tires import NodalTires

__all__ = ["CondensedTires", "condense"]

FloatArray = NDArray[np.float64]
Solve = Callable[[FloatArray], FloatArray]

_DENSE = 120
"""Free vectors of a tire up to which its inverse is a full matrix."""


def _hub_twist() -> FloatArray:
    """D in the hub's axes, (12, 6): r' = v, a_i' = w x e_i."""
    D = np.zeros((4, 3, 6))
    D[0, :, :3] = np.eye(3)
    for i in range(3):
        for k in range(3):
            D[1 + i, :, 3 + k] = np.cross(np.eye(3)[k], np.eye(3)[i])
    return D.reshape(12, 6)


_D = _hub_twist()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CondensedTires:
    """The matrices of all tires, in the axes of their hubs.

    Attributes
    ----------
    solve : S_ff^-1 for right-hand sides (n_w, 3 n_f)
    follow : (n_w, 3 n_f, 6) float, S_ff^-1 S_fr D
    carry : (n_w, 6, 3 n_f) float, D^T S_rf S_ff^-1
    stiffness : (n_w, 6, 6) float, E
    """

    solve: Solve
    follow: FloatArray
    carry: FloatArray
    stiffness: FloatArray


def condense(tires: NodalTires, blocks: FloatArray, axes: FloatArray, c: float) -> CondensedTires:
    """Build them.

    Parameters
    ----------
    blocks : dt gamma C + dt^2 beta K, of `NodalTires.step_matrix`, world axes
    axes : (n_w, 3, 3) float, columns are the hubs' axes
    c : weight of the mass
    """
    blocks = _turned(blocks, axes)
    rows, columns = tires.pattern.T
    blocks += c * tires.mass[rows, columns][:, None, None] * np.eye(3)
    n = len(tires.mass)
    return _dense(blocks, tires.pattern, n) if n <= _DENSE + 4 else _sparse(blocks, tires.pattern, n)


def _turned(blocks: FloatArray, axes: FloatArray) -> FloatArray:
    """R^T block R of each wheel's blocks."""
    turned = blocks.reshape(len(blocks), -1, 3) @ axes
    turned = np.swapaxes(turned.reshape(blocks.shape), -1, -2).reshape(len(blocks), -1, 3) @ axes
    return np.swapaxes(turned.reshape(blocks.shape), -1, -2)


def _dense(blocks: FloatArray, pattern: NDArray[np.int64], n: int) -> CondensedTires:
    full = np.zeros((len(blocks), n, n, 3, 3))
    full[:, pattern[:, 0], pattern[:, 1]] = blocks
    S: FloatArray = full.transpose(0, 1, 3, 2, 4).reshape(len(blocks), 3 * n, 3 * n)
    f = 3 * n - 12
    inverse = np.linalg.inv(S[:, :f, :f])
    S_fr, S_rf = S[:, :f, f:] @ _D, _D.T @ S[:, f:, :f]
    follow = inverse @ S_fr
    return CondensedTires(
        solve=lambda rho: np.matmul(inverse, rho[..., None])[..., 0],
        follow=follow,
        carry=S_rf @ inverse,
        stiffness=_D.T @ S[:, f:, f:] @ _D - S_rf @ follow,
    )


def _factors(matrix: csc_array) -> Any:
    """SuperLU's factors; LinAlgError for a singular matrix, as of a full one."""
    try:
        return splu(matrix)
    except RuntimeError as error:
        raise np.linalg.LinAlgError("the matrix of a tire is singular") from error


def _sparse(blocks: FloatArray, pattern: NDArray[np.int64], n: int) -> CondensedTires:
    f, order = 3 * n - 12, np.lexsort((pattern[:, 1], pattern[:, 0]))
    starts = np.searchsorted(pattern[order, 0], np.arange(n + 1))
    factors, follow, carry, stiffness = [], [], [], []
    for own in blocks:
        S = csc_array(bsr_array((own[order], pattern[order, 1], starts), shape=(3 * n, 3 * n)))
        lu = _factors(csc_array(S[:f, :f]))
        S_fr, S_rf = S[:f, f:] @ _D, (S[f:, :f].T @ _D).T
        factors.append(lu)
        follow.append(lu.solve(S_fr))
        carry.append(lu.solve(np.ascontiguousarray(S_rf.T), trans="T").T)
        stiffness.append(_D.T @ S[f:, f:].toarray() @ _D - S_rf @ follow[-1])
    return CondensedTires(
        solve=lambda rho: np.array([lu.solve(right) for lu, right in zip(factors, rho, strict=True)]),
        follow=np.array(follow),
        carry=np.array(carry),
        stiffness=np.array(stiffness),
    )
