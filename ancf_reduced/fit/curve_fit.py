"""Free parameters of an ANCF tire from load-deflection curves at several orientations: bounded nonlinear least squares.

The residuals are differences of load over a scale. At each deflection they are split into the mean over the
orientations and the deviations from it, r_i = m + (r_i - m), and the mean may weigh more: sum_i r_i^2 becomes
n w^2 m^2 + sum_i (r_i - m)^2, which is ordinary least squares for w = 1. Trust-region reflective steps of scipy, with
the gradient of `load_sensitivity`; a trial where no equilibrium is found only shrinks the step. Stiffnesses against the
hub's travel may be data too (`travel_fit`): one row more for each orientation and way, w_t (S / S_data - 1).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ancf_reduced.fit.fit_statistics import FitStatistics, fit_statistics
from ancf_reduced.fit.load_sensitivity import load_gradient, vary_tire
from ancf_reduced.fit.parameters import FreeParameter, preset_at, unknowns_of
from ancf_reduced.fit.travel_fit import TravelData, travel_gradient, travel_stiffness
from ancf_reduced.motion.equilibrium import NewtonControls
from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.preset import TirePreset
from ancf_reduced.tire.static import TireEquilibria, solve_near, solve_tire
from contracts.errors import ConvergenceError, InputError, MeshError

__all__ = ["CurveFit", "LoadData", "fit_curves"]

FloatArray = NDArray[np.float64]
_CONTROLS = NewtonControls(tolerance=1e-9, smallest_step=1e-4)
_AT_BOUND = 5e-3
"""An unknown closer than this to its bound lies on it: relative, or radians."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadData:
    """Loads to be met, all at the same deflections.

    Attributes
    ----------
    phi : (n_phi,) float [rad], circumferential positions that face the ground
    deflection : (n,) float [m], hub drop from the nominal radius, increasing, > 0
    load : (n_phi, n) float [N]
    scale : (n_phi, n) float [N], > 0; a difference of this size counts as 1
    mean_weight : w >= 1 [-], see the module
    travel : stiffnesses to be met besides, at the same orientations; None for none

    Raises
    ------
    InputError
        For shapes that do not match, values that are not finite, or a scale or weight out of range.

    Verified by tests/unit/test_ancf_fit_inputs.py.
    """

    phi: FloatArray
    deflection: FloatArray
    load: FloatArray
    scale: FloatArray
    mean_weight: float = 1.0
    travel: TravelData | None = None

    def __post_init__(self) -> None:
        shape = (len(self.phi), len(self.deflection))
        if self.load.shape != shape or self.scale.shape != shape or 0 in shape:
            shown = f"loads {self.load.shape}, scales {self.scale.shape}"
            raise InputError("data of the fit", shown, f"must have shape {shape}, not empty", "one row an orientation")
        if not all(np.all(np.isfinite(x)) for x in (self.phi, self.deflection, self.load, self.scale)):
            raise InputError("data of the fit", "NaN or infinity", "must be finite", "check the curves")
        if np.any(self.scale <= 0.0) or not (math.isfinite(self.mean_weight) and self.mean_weight >= 1.0):
            shown = f"smallest scale {self.scale.min():g} N, weight {self.mean_weight:g}"
            raise InputError("weights of the fit", shown, "need a scale > 0 and a weight >= 1", "use 1 for all")
        if self.travel is not None and len(self.travel.stiffness) != len(self.phi):
            shown = f"{len(self.travel.stiffness)} orientations"
            raise InputError("travel stiffness", shown, f"must be given at {len(self.phi)}", "one row an orientation")

    @property
    def size(self) -> int:
        """Rows of the least-squares problem."""
        return self.load.size + (0 if self.travel is None else self.travel.stiffness.size)

    def weighted(self, values: FloatArray) -> FloatArray:
        """Rows of the least-squares problem from values (n_phi, n, ...) [N]: over the scale, mean weighed, flat."""
        rows = values / self.scale.reshape(self.scale.shape + (1,) * (values.ndim - 2))
        rows = rows + (self.mean_weight - 1.0) * rows.mean(axis=0)
        return np.asarray(rows.reshape(-1, *values.shape[2:]))


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveFit:
    """The tire that fits best.

    Attributes
    ----------
    start, preset : tire before and after
    free : what was free
    data : what was to be met
    states : equilibria of the fitted tire at the data's deflections, for each orientation
    travel : the fitted tire's stiffnesses against travel, (n_phi, n_ways) float [N/m; N m/rad]; None without such data
    sum_of_squares : of the weighted residual [-]
    statistics : intervals, correlation, condition of the free parameters at the optimum
    evaluations : tires solved
    settled : False if the search ended at its limit of tires
    """

    start: TirePreset
    preset: TirePreset
    free: tuple[FreeParameter, ...]
    data: LoadData
    states: tuple[TireEquilibria, ...]
    travel: FloatArray | None
    sum_of_squares: float
    statistics: FitStatistics
    evaluations: int
    settled: bool

    @property
    def values(self) -> FloatArray:
        """The free parameters' values (n_free,), SI."""
        return np.array([p.parameter.of(self.preset) for p in self.free])

    @property
    def load(self) -> FloatArray:
        """Loads of the fitted tire [N], (n_phi, n)."""
        return np.array([states.load for states in self.states])

    @property
    def residual(self) -> FloatArray:
        """Load minus data [N], (n_phi, n)."""
        return self.load - self.data.load

    @property
    def relative_error(self) -> FloatArray:
        """Root mean square of the residual over that of the data, for each orientation [-], (n_phi,)."""
        return np.asarray(np.linalg.norm(self.residual, axis=1) / np.linalg.norm(self.data.load, axis=1))


class _Trials:
    """Loads and their gradient at trial unknowns; the last equilibria are kept, for the gradient at the same place."""

    def __init__(self, start: TirePreset, free: Sequence[FreeParameter], data: LoadData) -> None:
        self.start, self.free, self.data, self.evaluations = start, tuple(free), data, 0
        self.last: tuple[FloatArray, Tire, list[TireEquilibria]] | None = None

    def solve(self, unknowns: FloatArray) -> tuple[Tire, list[TireEquilibria]]:
        """The tire at trial unknowns (n_free,) [-, rad] and its equilibria at each orientation."""
        if self.last is None or not np.array_equal(self.last[0], unknowns):
            self.evaluations += 1
            tire = build_tire(preset_at(self.start, self.free, unknowns))
            if self.last is None:
                states = [solve_tire(tire, phi, self.data.deflection, _CONTROLS) for phi in self.data.phi.tolist()]
            else:
                states = [solve_near(tire, near, _CONTROLS) for near in self.last[2]]
            self.last = unknowns.copy(), tire, states
        return self.last[1:]

    def residual(self, unknowns: FloatArray) -> FloatArray:
        """Weighted residual [-] of load minus data, (n_phi n,), orientation after orientation, then of the travels.

        NaN where the tire is impossible or has no equilibrium, which scipy steps back from; the first trial raises.
        """
        first = self.last is None
        try:
            tire, states = self.solve(unknowns)
            rows = self.data.weighted(np.array([s.load for s in states]) - self.data.load)
            if (data := self.data.travel) is None:
                return rows
            stiffness = travel_stiffness(tire, states, data, _CONTROLS)
            return np.concatenate([rows, data.weighted(stiffness - data.stiffness)])
        except (ConvergenceError, MeshError, InputError):
            if first:
                raise
            return np.full(self.data.size, np.nan)

    def jacobian(self, unknowns: FloatArray) -> FloatArray:
        """Its derivative by the unknowns, (n_rows, n_free) [-, 1/rad]."""
        tire, states = self.solve(unknowns)
        varied = vary_tire(tire, self.free)
        rows = self.data.weighted(np.array([load_gradient(varied, s) for s in states]))
        if (data := self.data.travel) is None:
            return rows
        return np.concatenate([rows, data.weighted(travel_gradient(varied, states, data, _CONTROLS))])


def fit_curves(
    start: TirePreset,
    free: Sequence[FreeParameter],
    data: LoadData,
    tolerance: float = 1e-6,
    max_evaluations: int = 60,
    known: CurveFit | None = None,
) -> CurveFit:
    """Find the free parameters that meet the data best, within their bounds.

    Parameters
    ----------
    start : where the search begins; all that is not free stays as it is here
    free : parameters and their bounds [SI], no number of the preset twice
    data : loads to be met, more than there are parameters
    tolerance : relative change of the sum of squares or of the unknowns, or largest component of the scaled gradient,
        at which the search ends [-]
    max_evaluations : tires solved at most; the best one so far is returned then, marked as not settled
    known : an earlier fit to data at the same places; its equilibria are where Newton's method begins

    Raises
    ------
    InputError
        For parameters that overlap, a start outside the bounds, or less data than parameters.
    ConvergenceError
        If the start itself has no equilibrium at some deflection.

    Verified by tests/unit/test_ancf_fit_inputs.py and tests/verification/test_ancf_curve_fit.py.
    """
    _check(start, free, data)
    lower, upper = (np.array([p.parameter.unknown(b) for p, b in zip(free, bounds, strict=True)])
                    for bounds in ([p.lower for p in free], [p.upper for p in free]))  # fmt: skip
    trials = _Trials(start, free, data)
    if known is not None:
        trials.last = unknowns_of(known.preset, free), build_tire(known.preset), list(known.states)
    found = least_squares(
        trials.residual,
        np.clip(unknowns_of(start, free), lower, upper),
        trials.jacobian,
        bounds=(lower, upper),
        x_scale="jac",
        ftol=tolerance,
        xtol=tolerance,
        gtol=tolerance,
        max_nfev=max_evaluations,
    )
    tire, states = trials.solve(found.x)
    inside = (found.x - lower > _AT_BOUND) & (upper - found.x > _AT_BOUND)
    return CurveFit(
        start=start,
        preset=preset_at(start, free, found.x),
        free=tuple(free),
        data=data,
        states=tuple(states),
        travel=None if data.travel is None else travel_stiffness(tire, states, data.travel, _CONTROLS),
        sum_of_squares=2.0 * float(found.cost),
        statistics=fit_statistics(np.asarray(found.jac), found.fun, found.x, inside),
        evaluations=trials.evaluations,
        settled=found.status > 0,
    )


def _check(start: TirePreset, free: Sequence[FreeParameter], data: LoadData) -> None:
    """Raise InputError for what cannot be fitted."""
    fields = [name for p in free for name in p.parameter.fields]
    if not free or len(set(fields)) < len(fields):
        shown = ", ".join(p.parameter for p in free) or "none"
        raise InputError("free parameters", shown, "need one or more, none twice", "thickness is rim and spokes")
    if data.size <= len(free):
        shown = f"{data.size} data for {len(free)} parameters"
        raise InputError("data of the fit", shown, "must be more than the parameters", "add deflections")
    for p in free:
        value = p.parameter.of(start)
        if not p.lower * (1 - 1e-12) <= value <= p.upper * (1 + 1e-12):
            rule = f"must lie within its bounds, {p.lower:g}..{p.upper:g} {p.parameter.unit}"
            raise InputError(f"start of {p.parameter}", f"{value:g} {p.parameter.unit}", rule, "widen them or move it")
