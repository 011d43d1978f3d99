"""Constraint equations without the redundant ones, which are chosen anew where those kept turn dependent.

Which of the equations follows from the others may change along a motion: Bricard's mechanism has one too many in every
position, and each of them is at times the one that must stay. The rows kept of C_u, scaled to length one, are watched
by their smallest singular value. Where it has fallen, others are chosen by QR with column pivoting of C_u^T, as many as
at the start. Motions and constraint forces of the bodies do not depend on the choice as long as the rows kept have full
rank, so that it may change within a step. Where no choice helps, the mechanism itself gains a freedom. Verified by
tests/verification/test_multibody_bricard.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import svdvals
from scipy.sparse import csr_array

from rover_dynamics.multibody.constraints import Constraints, ConstraintValues, Equation, pivoted, scaled_rows
from rover_dynamics.multibody.singular_position import SingularPosition
from rover_dynamics.multibody.state import State

__all__ = ["IndependentRows"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_WORSE = 5.0
"""Fall of the smallest singular value of the rows kept at which they are chosen anew."""
_SINGULAR = 1e-3
"""Of the largest `IndependentRows.size` at the end of a step so far: below it a position counts as singular."""


class IndependentRows:
    """Equations of a model at one state after another.

    Attributes
    ----------
    constraints : the equations kept now; drives always are
    redundant : equations that follow from them; left out
    size : smallest over largest singular value of the rows kept, scaled to length one, at the last state [-]
    """

    def __init__(self, every: Constraints, kept: IntArray, start: State) -> None:
        self._every = every
        drives = np.array([equation.drive is not None for equation in every.equations], dtype=bool)
        self._own, self._drives = np.flatnonzero(~drives), np.flatnonzero(drives)
        self._keep(kept)
        self.size = self._chosen = self._best = 0.0
        self.accepted(0.0, start)

    def at(self, t: float, state: State) -> ConstraintValues:
        """The independent equations at t [s] and a state.

        Raises
        ------
        SingularPosition
            Where no choice of equations is independent: the mechanism gains a freedom.
        """
        values = self.constraints.at(t, state)
        if not len(values.defects):
            return values
        self.size = _size(scaled_rows(values.jacobian))
        if self.redundant and self.size < self._chosen / _WORSE:
            self._choose(t, state)
            values = self.constraints.at(t, state)
            self.size = self._chosen = _size(scaled_rows(values.jacobian))
        self._chosen = max(self._chosen, self.size)
        if self.size < _SINGULAR * self._best:
            raise SingularPosition(t, self._signed(values.jacobian, self.size))
        return values

    def accepted(self, t: float, state: State) -> None:
        """Be told that a step ended at t [s] with this state: signs of margins refer to it."""
        self._reference = scaled_rows(self._every.at(t, state).jacobian)
        self.size = self._chosen = _size(self._reference[self._rows])
        self._best = max(self._best, self.size)

    def margin(self, t: float, state: State) -> float:
        """See `formulation.Formulation`; positive where the last step ended."""
        jacobian = self.constraints.at(t, state).jacobian
        return self._signed(jacobian, _size(scaled_rows(jacobian))) if jacobian.shape[0] else 1.0

    def _keep(self, rows: IntArray) -> None:
        self._rows = rows
        self.constraints = self._every.part(rows)
        left_out = np.setdiff1d(np.arange(len(self._every.equations)), rows)
        self.redundant: tuple[Equation, ...] = tuple(self._every.equations[k] for k in left_out)

    def _choose(self, t: float, state: State) -> None:
        """Keep the drives, and of the joints' equations those that pivoting finds best, as many as before."""
        own = self._every.at(t, state).jacobian[self._own]
        _, order = pivoted(own)
        kept = self._own[order[: len(self._rows) - len(self._drives)]]
        self._keep(np.sort(np.concatenate([kept, self._drives])))

    def _signed(self, jacobian: csr_array, size: float) -> float:
        """The size with a sign that changes where the rows' rank does, that of det(C C_0^T), C_0 where a step ended."""
        sign, _ = np.linalg.slogdet(scaled_rows(jacobian) @ self._reference[self._rows].T)
        return float(sign * size)


def _size(rows: FloatArray) -> float:
    """Smallest over largest singular value; one without rows."""
    sizes = svdvals(rows, check_finite=False) if len(rows) else np.ones(1)
    return float(sizes[-1] / sizes[0])
