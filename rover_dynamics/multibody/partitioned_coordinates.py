"""Generalised coordinate partitioning in absolute coordinates, section 2.5.3 of the thesis.

    C_u = [C_ud  C_ui],   du_d = -C_ud^-1 (C_ui du_i + C),   u_d = -C_ud^-1 (C_ui u_i + C_t)

Equation 2.26 gives all accelerations; only the independent ones are integrated. The dependent positions and velocities
follow from the constraints at each evaluation, by Newton's method along the dependent directions, so that all levels
hold. The dependent columns are those that column pivoting of C_u finds best conditioned (Wehage and Haug 1982), chosen
anew after each step: the step is of a method without memory, and the state stays as it is. A step that turns them bad
before its end is tried shorter. Verified by tests/verification/test_multibody_formulations.py against
`formulation.AbsoluteCoordinates`, and by tests/verification/test_multibody_heavy_top.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve, qr
from scipy.sparse import csr_array

from contracts.errors import ConvergenceError
from rover_dynamics.multibody.assembly import ITERATIONS, POSITION_TOLERANCE, cannot_be_assembled
from rover_dynamics.multibody.formulation import AbsoluteCoordinates, Course, packed
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.state import State, moved

__all__ = ["PartitionedCoordinates"]

FloatArray = NDArray[np.float64]

_BAD = 1e-3
"""Of the smallest singular value of C_u: a smaller pivot of C_ud leaves the dependent velocities undetermined."""


class PartitionedCoordinates(AbsoluteCoordinates):
    """Equation 2.26 with the independent velocities and positions integrated.

    y : positions (3 n), quaternions (4 n), velocities (6 n) as in `AbsoluteCoordinates`; their dependent parts are
        guesses, which `rates` and `corrected` replace

    Attributes
    ----------
    dependent : (m,) int, velocities among the 6 n that follow from the others

    Raises
    ------
    InputError, ConvergenceError
        See `assembly.assembly`.
    """

    def __init__(self, model: MultibodyModel) -> None:
        super().__init__(model)
        self._divide(0.0, self.equations.start)

    @property
    def independent(self) -> NDArray[np.int64]:
        """Velocities among the 6 n that are integrated, (6 n - m,) int."""
        return np.setdiff1d(np.arange(6 * len(self.model.bodies)), self.dependent)

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """See `Formulation`."""
        return super().rates(t, self.corrected(t, y))

    def corrected(self, t: float, y: FloatArray) -> FloatArray:
        """See `Formulation`; the independent positions and velocities are kept.

        Raises
        ------
        SingularPosition
            Where the mechanism gains a freedom.
        ConvergenceError
            If no dependent positions are found, or the independent ones hardly determine them.
        """
        state, history = self.state(t, y), list[float]()
        for _ in range(ITERATIONS):
            values = self.equations.rows.at(t, state)
            history.append(float(np.max(np.abs(values.defects), initial=0.0)))
            missing = values.rates - values.jacobian @ state.velocities.ravel()
            change = self._changes(t, values.jacobian, np.stack([-values.defects, missing], axis=1))
            if history[-1] < POSITION_TOLERANCE:
                velocities = state.velocities + change[:, 1].reshape(-1, 6)
                closed = State(positions=state.positions, orientations=state.orientations, velocities=velocities)
                return packed(closed)
            state = moved(state, change[:, 0].reshape(-1, 6))
        raise cannot_be_assembled(self.equations.constraints, values.defects, t, history)

    def accepted(self, t: float, y: FloatArray, course: Course | None) -> None:
        """See `Formulation`; the dependent velocities are chosen anew."""
        super().accepted(t, y, course)
        self._divide(t, self.state(t, y))

    def _changes(self, t: float, C_u: csr_array, right: FloatArray) -> FloatArray:
        """Changes of the dependent velocities or positions with C_u change = right, (6 n, k)."""
        change = np.zeros((C_u.shape[1], right.shape[1]))
        if not len(right):
            return change
        factors = lu_factor(C_u.toarray()[:, self.dependent], check_finite=False)
        pivots = np.abs(np.diag(factors[0]))
        if np.min(pivots) < _BAD * self.equations.rows.size * np.max(pivots):
            raise ConvergenceError(f"independent coordinates do not determine the others at t = {t:g} s", [])
        change[self.dependent] = lu_solve(factors, right, check_finite=False)
        return change

    def _divide(self, t: float, state: State) -> None:
        C_u = self.equations.rows.at(t, state).jacobian.toarray()
        _, _, order = qr(C_u, mode="economic", pivoting=True)
        self.dependent = np.sort(order[: len(C_u)]).astype(np.int64)
