"""Generalised coordinate partitioning in absolute coordinates, section 2.5.3 of the thesis.

    C_u = [C_ud  C_ui],   du_d = -C_ud^-1 (C_ui du_i + C),   u_d = -C_ud^-1 (C_ui u_i + C_t)

Equation 2.26 gives all accelerations; only the independent ones are integrated. The dependent positions and velocities
follow from the constraints at each evaluation, by Newton's method along the dependent directions, so that all levels
hold. The dependent columns are those that column pivoting of C_u finds best conditioned (Wehage and Haug 1982); they
are chosen anew when the motion has made others better. Verified by tests/verification/test_multibody_formulations.py
against `formulation.AbsoluteCoordinates`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, lu_factor, lu_solve, qr, svdvals
from scipy.sparse import csr_array

from rover_dynamics.multibody.assembly import ITERATIONS, POSITION_TOLERANCE, cannot_be_assembled
from rover_dynamics.multibody.formulation import AbsoluteCoordinates, Course, SingularPosition, packed
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.state import State, moved

__all__ = ["PartitionedCoordinates"]

FloatArray = NDArray[np.float64]

_SINGULAR = 1e-6
"""Of the largest pivot of C_ud: below it a position counts as singular."""
_WORSE = 5.0
"""Growth of the largest rate of a dependent velocity with an independent one, above which they are chosen anew."""


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
        self._divide(self._jacobian(0.0, self.equations.start))

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
            Where the dependent ones are hardly determined.
        ConvergenceError
            If no dependent positions are found.
        """
        state, history = self.state(t, y), list[float]()
        for _ in range(ITERATIONS):
            values = self.equations.constraints.at(t, state)
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
        """See `Formulation`; here the dependent velocities may be chosen anew."""
        C_u = self._jacobian(t, self.state(t, y))
        if self._gain(C_u) > _WORSE * self._best_gain:
            self._divide(C_u)

    def margin(self, t: float, y: FloatArray) -> float:
        """See `Formulation`."""
        C_ud = self._jacobian(t, self.state(t, y))[:, self.dependent]
        sizes = svdvals(C_ud) if C_ud.size else np.ones(1)
        return float(np.linalg.slogdet(C_ud)[0] * sizes[-1] / sizes[0])

    def _jacobian(self, t: float, state: State) -> FloatArray:
        return np.asarray(self.equations.constraints.at(t, state).jacobian.toarray())

    def _changes(self, t: float, C_u: csr_array, right: FloatArray) -> FloatArray:
        """Changes of the dependent velocities or positions with C_u change = right, (6 n, k)."""
        change = np.zeros((C_u.shape[1], right.shape[1]))
        if not len(right):
            return change
        factors = lu_factor(C_u.toarray()[:, self.dependent], check_finite=False)
        pivots = np.abs(np.diag(factors[0]))
        if np.min(pivots) < _SINGULAR * np.max(pivots):
            sign = np.prod(np.sign(np.diag(factors[0]))) * (-1.0) ** np.sum(factors[1] != np.arange(len(pivots)))
            raise SingularPosition(t, float(sign * np.min(pivots) / np.max(pivots)))
        change[self.dependent] = lu_solve(factors, right, check_finite=False)
        return change

    def _divide(self, C_u: FloatArray) -> None:
        _, _, order = qr(C_u, mode="economic", pivoting=True)
        self.dependent = np.sort(order[: len(C_u)]).astype(np.int64)
        self._best_gain = self._gain(C_u)

    def _gain(self, C_u: FloatArray) -> float:
        """Largest entry of C_ud^-1 C_ui; infinite if it is not determined."""
        try:
            rates = np.linalg.solve(C_u[:, self.dependent], C_u[:, self.independent])
        except LinAlgError:
            return np.inf
        return float(np.max(np.abs(rates), initial=1.0))
