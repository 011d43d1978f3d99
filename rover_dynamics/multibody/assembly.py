"""Bring the bodies of a model together, and find the equations that are redundant there.

Verified by tests/unit/test_multibody_assembly.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lstsq

from contracts.errors import ConvergenceError, IncrementRecord, InputError
from rover_dynamics.multibody.constraints import (
    Constraints,
    ConstraintValues,
    Equation,
    build_constraints,
    redundant_equations,
)
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.state import State, moved, start_state

__all__ = ["ITERATIONS", "POSITION_TOLERANCE", "assembly", "cannot_be_assembled"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

POSITION_TOLERANCE = 1e-11
"""Largest defect of a position [m, rad, -]; a tenth of what is promised."""
ITERATIONS = 50
_LARGEST_TURN = 0.5
"""Of a body in one iteration [rad]."""
_RANK = 1e-9
_RATE_TOLERANCE = 1e-9


def assembly(model: MultibodyModel) -> tuple[State, Constraints, IntArray]:
    """Start of a motion: assembled state, all equations, and which of them (m,) are independent.

    Positions and velocities given inconsistently are changed the least (sum of squares of displacements [m] and
    rotations [rad]), positions by the Gauss-Newton method on all equations. Of dependent equations some are left out;
    a drive is never one of them.

    Raises
    ------
    InputError
        If a drive moves what the joints, or other drives, already hold.
    ConvergenceError
        If the bodies do not come together.
    """
    every = build_constraints(model)
    state = _together(every, start_state(model.bodies))
    values = every.at(0.0, state)
    driven = np.array([equation.drive is not None for equation in every.equations], dtype=bool)
    _check_drives(every, values, driven)
    own = np.flatnonzero(~driven)
    left_out = own[redundant_equations(values.jacobian[own])]
    kept = np.setdiff1d(np.arange(len(every.equations)), left_out)
    return _with_velocities(every, values, state), every, kept


def _together(every: Constraints, state: State) -> State:
    history: list[float] = []
    for _ in range(ITERATIONS):
        values = every.at(0.0, state)
        history.append(float(np.max(np.abs(values.defects), initial=0.0)))
        if history[-1] < POSITION_TOLERANCE:
            return state
        change = lstsq(values.jacobian.toarray(), -values.defects, cond=_RANK)[0].reshape(-1, 6)
        largest = float(np.max(np.abs(change[:, 3:]), initial=0.0))
        state = moved(state, change * min(1.0, _LARGEST_TURN / max(largest, 1e-300)))
    raise cannot_be_assembled(every, values.defects, 0.0, history)


def _check_drives(every: Constraints, values: ConstraintValues, driven: NDArray[np.bool_]) -> None:
    """Each drive must find a motion that the joints and the drives before it leave free."""
    rows = values.jacobian.toarray()
    basis = _row_space(rows[~driven])
    for k in np.flatnonzero(driven):
        row = rows[k] / np.linalg.norm(rows[k])
        rest = row - basis.T @ (basis @ row)
        if np.linalg.norm(rest) < 1e-6:
            rule = "moves what the joints and the other drives already hold"
            hint = "remove the drive, or leave the mechanism one more freedom"
            raise InputError(f"drive of joint '{every.equations[k].joint}'", _asked(every.equations[k]), rule, hint)
        basis = np.vstack([basis, rest / np.linalg.norm(rest)])


def _asked(equation: Equation) -> str:
    """Value and rate of a drive's law at the start."""
    assert equation.drive is not None
    value, rate, _ = equation.drive.law.at(0.0)
    return f"{value:g} {equation.unit}, {rate:g} {equation.unit}/s"


def _row_space(rows: FloatArray) -> FloatArray:
    """Orthonormal rows that span the same space."""
    if not len(rows):
        return rows
    scaled = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    _, sizes, right = np.linalg.svd(scaled, full_matrices=False)
    return np.asarray(right[sizes > _RANK * sizes[0]])


def _with_velocities(every: Constraints, values: ConstraintValues, state: State) -> State:
    """Velocities changed the least so that they meet all equations.

    Raises
    ------
    InputError
        If no velocities do: a drive moves against a joint.
    """
    C_u, u = values.jacobian, state.velocities.ravel()
    change = lstsq(C_u.toarray(), values.rates - C_u @ u, cond=_RANK)[0] if len(values.rates) else np.zeros_like(u)
    open_rates = C_u @ (u + change) - values.rates
    if len(open_rates) and np.max(np.abs(open_rates)) > _RATE_TOLERANCE * max(1.0, float(np.max(np.abs(values.rates)))):
        worst = every.equations[int(np.argmax(np.abs(open_rates)))]
        rule = "no velocities of the bodies meet it together with the others"
        open_by = f"{worst}, open by {np.max(np.abs(open_rates)):.3g} {worst.unit}/s"
        raise InputError("velocity at the start", open_by, rule, "check the drives' laws")
    return State(
        positions=state.positions,
        orientations=state.orientations,
        velocities=(u + change).reshape(-1, 6),
    )


def cannot_be_assembled(
    constraints: Constraints, defects: FloatArray, t: float, history: list[float]
) -> ConvergenceError:
    """The error for positions that no joint allows, naming the equation that stays open.

    Parameters
    ----------
    constraints, defects : equations, and C (m,) of each in the last iteration [m, rad, -]
    t : time [s]
    history : largest |C| of each iteration [m, rad, -]
    """
    worst = int(np.argmax(np.abs(defects)))
    message = (
        f"bodies cannot be brought together at t = {t:g} s: after {len(history)} iterations "
        f"{constraints.equations[worst]} is still open by {defects[worst]:.3g} {constraints.equations[worst].unit}; "
        "start closer to a position the joints allow, or check lengths and drives"
    )
    record = IncrementRecord(target=t, step=0.0, converged=False, residuals=tuple(history))
    return ConvergenceError(message, [record])
