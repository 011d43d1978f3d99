"""Loops of a tree: their equations in joint velocities, and dependent coordinates as functions of independent ones.

Verified by tests/verification/test_multibody_formulations.py and tests/verification/test_multibody_slider_crank.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr
from scipy.linalg.lapack import dgecon, dgetrf, dgetrs
from scipy.sparse import csr_array

from rover_dynamics.multibody.assembly import ITERATIONS, POSITION_TOLERANCE, cannot_be_assembled
from rover_dynamics.multibody.constraint_kernels import constraint_rows
from rover_dynamics.multibody.constraints import Constraints, Equation, redundant_equations
from rover_dynamics.multibody.formulation import Course
from rover_dynamics.multibody.singular_position import SingularPosition
from rover_dynamics.multibody.tree_jacobians import in_joint_velocities
from rover_dynamics.multibody.tree_kernels import Tree, TreeMotion, advance, tree_motion

__all__ = ["LoopRows", "Loops"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_SINGULAR = 1e-3
"""Of the margin where the dependent velocities were chosen: below it a position counts as singular."""
_DOUBTFUL = 10.0 * _SINGULAR
"""Of that margin: below it by the estimate in the norm of column sums, singular values decide."""
_WORSE = 5.0
"""Growth of the largest rate of a dependent velocity with an independent one, above which they are chosen anew."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LoopRows:
    """The loops' equations at one motion of the tree.

    Attributes
    ----------
    defects : (m,) float, C [m, rad, -]
    jacobian : (m, n_v) float, J by all joint velocities
    rates : (m,) float, -C_t: what J v must be
    accelerations : (m,) float, what J v' must be
    blocks : (m, 2, 6) float, by the velocities of the two bodies
    """

    defects: FloatArray
    jacobian: FloatArray
    rates: FloatArray
    accelerations: FloatArray
    blocks: FloatArray


class Loops:
    """Independent equations of the joints that close loops, and of the drives on them.

    Attributes
    ----------
    constraints : the equations
    redundant : equations that follow from the others at the start; left out
    dependent : (m,) int, joint velocities that follow from the others
    """

    def __init__(self, tree: Tree, constraints: Constraints, free: IntArray, start: TreeMotion) -> None:
        self._tree, self._free = tree, free
        self.constraints = constraints
        J = self.rows(0.0, start).jacobian
        left_out = redundant_equations(csr_array(J[:, free]))
        self.redundant: tuple[Equation, ...] = tuple(constraints.equations[k] for k in left_out)
        self.constraints = constraints.part(np.setdiff1d(np.arange(len(constraints.equations)), left_out))
        self._course: Course | None = None
        self._divide(np.delete(J, left_out, axis=0))

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self.constraints.equations)

    def rows(self, t: float, motion: TreeMotion) -> LoopRows:
        """All equations at t [s] and a motion of the tree."""
        table = self.constraints.table
        C, C_u, Q_c = constraint_rows(table, motion.positions, motion.rotations, motion.velocities)
        rates = self.constraints.add_laws(t, C, Q_c)
        J, bias = in_joint_velocities(self._tree, motion, table, C_u)
        return LoopRows(defects=C, jacobian=J, rates=rates, accelerations=Q_c - bias, blocks=C_u)

    def close(self, t: float, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Dependent coordinates and velocities from the independent ones at t [s], by Newton's method.

        Parameters
        ----------
        q, v : (n_q,), (n_v,) float, all coordinates [rad, m, -] and velocities [rad/s, m/s]; may be overwritten

        Raises
        ------
        SingularPosition
            Where the dependent ones are hardly determined.
        ConvergenceError
            If no dependent coordinates are found.
        """
        if self._course is not None:
            q[self._guessed] = self._course(t)[self._guessed]
        history: list[float] = []
        for _ in range(ITERATIONS):
            motion = tree_motion(self._tree, q, v)
            rows = self.rows(t, motion)
            history.append(float(np.max(np.abs(rows.defects))))
            missing = np.stack([-rows.defects, rows.rates - rows.jacobian @ v], axis=1)
            change = self._solved(rows.jacobian[:, self.dependent], missing, t)
            if len(history) > 1 and max(history[-2:]) < POSITION_TOLERANCE:  # one more: it counts near singularities
                v[self.dependent] += change[:, 1]
                return q, v
            step = np.zeros_like(v)
            step[self.dependent] = change[:, 0]
            q = advance(self._tree, q, step, motion.frames)
        raise cannot_be_assembled(self.constraints, rows.defects, t, history)

    def accepted(self, motion: TreeMotion, course: Course | None) -> None:
        """Guess dependent coordinates from the course of the last step; choose them anew where others are better."""
        self._course = course
        J = self.rows(0.0, motion).jacobian
        if _gain(J, self.dependent, self._independent()) > _WORSE * self._best_gain:
            self._divide(J)

    def margin(self, motion: TreeMotion) -> float:
        """See `formulation.Formulation`."""
        J = self.rows(0.0, motion).jacobian[:, self.dependent]
        return _signed(J, np.linalg.svd(J, compute_uv=False))

    def _independent(self) -> IntArray:
        return np.setdiff1d(self._free, self.dependent)

    def _solved(self, J: FloatArray, right: FloatArray, t: float) -> FloatArray:
        """Changes with J change = right."""
        factors, pivots, zero = dgetrf(J)
        margin = dgecon(factors, np.linalg.norm(J, 1))[0]
        if zero or margin < _DOUBTFUL * self._best_margin:
            sizes = np.linalg.svd(J, compute_uv=False)
            if sizes[-1] < _SINGULAR * self._best_margin * sizes[0]:
                raise SingularPosition(t, _signed(J, sizes))
        return np.asarray(dgetrs(factors, pivots, right)[0])

    def _divide(self, J: FloatArray) -> None:
        """Take the best conditioned columns of J for the dependent velocities, by pivoting."""
        _, _, order = qr(J[:, self._free], mode="economic", pivoting=True)
        self.dependent = self._free[np.sort(order[: len(J)])]
        at, v_at = self._tree.q_at, self._tree.v_at
        whole = [k for k in range(len(at) - 1) if np.isin(np.arange(v_at[k], v_at[k + 1]), self.dependent).all()]
        self._guessed = np.array([i for k in whole for i in range(at[k], at[k + 1])], dtype=np.int64)  # no others
        sizes = np.linalg.svd(J[:, self.dependent], compute_uv=False) if len(J) else np.ones(1)
        self._best_margin = float(sizes[-1] / sizes[0])
        self._best_gain = _gain(J, self.dependent, self._independent())


def _gain(J: FloatArray, dependent: IntArray, independent: IntArray) -> float:
    """Largest rate of a dependent velocity with an independent one; infinite if it is not determined."""
    try:
        return float(np.max(np.abs(np.linalg.solve(J[:, dependent], J[:, independent])), initial=1.0))
    except np.linalg.LinAlgError:
        return np.inf


def _signed(J: FloatArray, sizes: FloatArray) -> float:
    return float(np.linalg.slogdet(J)[0] * sizes[-1] / sizes[0])
