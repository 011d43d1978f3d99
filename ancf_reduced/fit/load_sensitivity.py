r"""Gradient of a static curve with respect to the tire's parameters, by the implicit function theorem.

In equilibrium R(x, theta) = 0 with the free coordinates x, and the load is F(x, theta). One adjoint solve a point,

    K lambda = dF/dx,    dF/dtheta = partial F/partial theta - lambda . partial R/partial theta,

with the exact tangent K = dR/dx of `plane_problem` (symmetric) gives the gradient for all parameters at once. R is
linear in the modulus and in the contact stiffness: their derivatives are exact. Those of geometry are central
differences of R and F at the same x, the tire rebuilt: two force evaluations and no solve, right to about 1e-9.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.fit.parameters import FreeParameter, Parameter, preset_at, unknowns_of
from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.plane_problem import PlaneProblem
from ancf_reduced.tire.static import TireEquilibria
from ancf_reduced.tire.travel_stiffness import load_of, loaded_tangent
from contracts.errors import ConvergenceError
from contracts.frames import ground_direction_h

__all__ = ["STEP", "VariedTire", "load_gradient", "partials", "vary_tire"]

FloatArray = NDArray[np.float64]
STEP = 1e-5
"""Step of the central differences, in the unknowns: relative, or radians."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VariedTire:
    """A tire, and the same tire with each geometric parameter a little smaller and larger.

    Attributes
    ----------
    tire : at the parameters themselves
    free : what is varied
    pairs : smaller and larger tire for each of ``free``; None where the derivative is exact
    """

    tire: Tire
    free: tuple[FreeParameter, ...]
    pairs: tuple[tuple[Tire, Tire] | None, ...]


def vary_tire(tire: Tire, free: Sequence[FreeParameter]) -> VariedTire:
    """Build the neighbours of a tire that `load_gradient` needs, once for all orientations."""
    at = unknowns_of(tire.preset, free)
    pairs: list[tuple[Tire, Tire] | None] = []
    for i, p in enumerate(free):
        if p.parameter in (Parameter.YOUNG_MODULUS, Parameter.CONTACT_STIFFNESS):
            pairs.append(None)
            continue
        step = STEP * np.eye(len(free))[i]
        smaller, larger = (build_tire(preset_at(tire.preset, free, at + sign * step)) for sign in (-1.0, 1.0))
        pairs.append((smaller, larger))
    return VariedTire(tire=tire, free=tuple(free), pairs=tuple(pairs))


def load_gradient(varied: VariedTire, states: TireEquilibria) -> FloatArray:
    """Derivative of the load at every solved deflection with respect to every free parameter's unknown.

    Parameters
    ----------
    varied : from `vary_tire`
    states : equilibria of ``varied.tire``

    Returns
    -------
    gradient : (n, n_free) float [N], dF / d ln(theta), or [N/rad] for the phase. Zero where nothing touches. Contact
        points that switch exactly there have one-sided derivatives; the one of the points found closed is given.

    Verified by tests/unit/test_ancf_load_sensitivity.py (finite differences of whole solves).
    """
    problem = PlaneProblem(tire=varied.tire, direction=ground_direction_h(states.phi))
    rows = zip(states.coordinates, states.deflection.tolist(), strict=True)
    return np.array([_gradient_at(varied, problem, p, deflection) for p, deflection in rows])


def partials(
    varied: VariedTire, problem: PlaneProblem, p: FloatArray, deflection: float
) -> tuple[FloatArray, FloatArray]:
    """Partial derivatives at fixed coordinates p (n_nodes, 4, 3) and deflection [m] by every free unknown.

    Returns
    -------
    load, residual : (n_free,) float [N] and (n_free, 12 n_free_nodes) float [N, N m]; [N/rad, ...] for the phase
    """
    free = varied.tire.tie.free
    contact, elastic = problem.contact_force(p, deflection), varied.tire.model.elastic_force(p)
    loads, residuals = np.zeros(len(varied.free)), np.zeros((len(varied.free), 12 * len(free)))
    for i, (kind, pair) in enumerate(zip(varied.free, varied.pairs, strict=True)):
        if pair is not None:
            smaller, larger = (_load_and_residual(other, problem.direction, p[free], deflection) for other in pair)
            loads[i], residuals[i] = (larger[0] - smaller[0]) / (2.0 * STEP), (larger[1] - smaller[1]) / (2.0 * STEP)
        elif kind.parameter is Parameter.YOUNG_MODULUS:
            residuals[i] = elastic[free].ravel()
        else:
            loads[i], residuals[i] = load_of(contact, problem.direction), -contact[free].ravel()
    return loads, residuals


def _gradient_at(varied: VariedTire, problem: PlaneProblem, p: FloatArray, deflection: float) -> FloatArray:
    """One row, (n_free,)."""
    if load_of(problem.contact_force(p, deflection), problem.direction) == 0.0:
        return np.zeros(len(varied.free))
    load, residual = partials(varied, problem, p, deflection)
    return np.asarray(load - residual @ _adjoint(problem, p, deflection))


def _adjoint(problem: PlaneProblem, p: FloatArray, deflection: float) -> FloatArray:
    """lambda = K^-1 dF/dx on the free coordinates, (12 n_free,)."""
    tangent, slope, _ = loaded_tangent(problem, p, deflection)
    try:
        return np.asarray(np.linalg.solve(tangent, slope))
    except np.linalg.LinAlgError as error:
        message = f"the load's derivative at {deflection:.4g} m does not exist: the tangent is singular there"
        raise ConvergenceError(message, []) from error


def _load_and_residual(tire: Tire, direction: FloatArray, x: FloatArray, deflection: float) -> tuple[float, FloatArray]:
    """Contact load [N] and generalised residual on the free nodes (flat) of another tire at the same coordinates."""
    problem = PlaneProblem(tire=tire, direction=direction)
    p = problem.expand(x)
    contact = problem.contact_force(p, deflection)
    return load_of(contact, direction), (tire.model.elastic_force(p) - contact)[tire.tie.free].ravel()
