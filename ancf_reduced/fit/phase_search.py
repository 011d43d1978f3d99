"""A fit begun from several phases of the spokes, since the sum of squares has a valley for each.

Turning a tire's spokes past the ground exchanges stiff and soft orientations, so the least squares of `curve_fit`
hardly leave the phase they begin with: within 7 degrees for three spokes. Each phase is searched coarsely, and the best
of them to the end.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.fit.curve_fit import CurveFit, LoadData, fit_curves
from ancf_reduced.fit.parameters import FreeParameter, Parameter
from ancf_reduced.tire.preset import TirePreset
from contracts.errors import ConvergenceError, InputError

__all__ = ["PhaseSearch", "PhaseTrial", "fit_from_phases", "phases_over_a_turn"]

FloatArray = NDArray[np.float64]
_COARSE, _COARSE_EVALUATIONS = 1e-3, 25


@dataclass(frozen=True, slots=True, kw_only=True)
class PhaseTrial:
    """One coarse search.

    Attributes
    ----------
    start, found : phase of the first spoke before and after [rad]; ``found`` None where there was no equilibrium
    sum_of_squares : of the weighted residual [-]; None likewise
    """

    start: float
    found: float | None
    sum_of_squares: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class PhaseSearch:
    """The best tire, and what every start came to (empty for a single one)."""

    fit: CurveFit
    trials: tuple[PhaseTrial, ...]


def phases_over_a_turn(phase: float, spokes: int, starts: int, bounds: tuple[float, float]) -> list[float]:
    """Phases [rad] in equal steps over 2 pi / spokes, after which the tire repeats itself, from ``phase`` on.

    Each is taken to its equivalent within the bounds; one that has none there is left out.

    Verified by tests/unit/test_ancf_phase_search.py.
    """
    period, (lower, upper) = 2.0 * math.pi / spokes, bounds
    wanted = [phase + k * period / starts for k in range(starts)]
    inside = [p - period * math.floor((p - lower) / period + 1e-9) for p in wanted]
    return [p for p in inside if p <= upper + 1e-9]


def fit_from_phases(
    start: TirePreset, free: Sequence[FreeParameter], data: LoadData, starts: int, tolerance: float = 1e-6
) -> PhaseSearch:
    """Fit from one phase or several; ``starts`` of 1 is `curve_fit.fit_curves`.

    Parameters
    ----------
    start, free, data, tolerance [-] : as `fit_curves`
    starts : phases to begin with, see `phases_over_a_turn`; more than one needs the phase to be free

    Raises
    ------
    InputError
        If the phase is not free, or as `fit_curves`.
    ConvergenceError
        If no start has an equilibrium at every deflection.

    Verified by tests/unit/test_ancf_phase_search.py.
    """
    if starts == 1:
        return PhaseSearch(fit=fit_curves(start, free, data, tolerance), trials=())
    phase = next((p for p in free if p.parameter is Parameter.PHASE), None)
    if phase is None:
        raise InputError("phase starts", starts, "need the phase to be free", "add it, or begin once")
    begun = phases_over_a_turn(start.phase, start.spokes, starts, (phase.lower, phase.upper))
    if not begun:
        rule = f"leave no phase of the tire between {phase.lower:g} and {phase.upper:g} rad"
        raise InputError("phase starts", starts, rule, "begin at least once, or widen the bounds")
    fits, failures = list[CurveFit | None](), list[ConvergenceError]()
    for p in begun:
        try:
            fits.append(fit_curves(replace(start, phase=p), free, data, _COARSE, _COARSE_EVALUATIONS))
        except ConvergenceError as error:
            fits.append(None)
            failures.append(error)
    good = [fit for fit in fits if fit is not None]
    if not good:
        raise failures[-1]
    trials = [_trial(p, fit) for p, fit in zip(begun, fits, strict=True)]
    best = min(good, key=lambda fit: fit.sum_of_squares)
    found = fit_curves(best.preset, free, data, tolerance, known=best)
    spent = sum(fit.evaluations for fit in good)
    return PhaseSearch(fit=replace(found, start=start, evaluations=found.evaluations + spent), trials=tuple(trials))


def _trial(start: float, fit: CurveFit | None) -> PhaseTrial:
    if fit is None:
        return PhaseTrial(start=start, found=None, sum_of_squares=None)
    return PhaseTrial(start=start, found=fit.preset.phase, sum_of_squares=fit.sum_of_squares)
