r"""Stiffnesses against the hub's travel as data of a fit, and their gradient by the implicit function theorem.

A tire stands under the load F_0: with y = (x, d), free coordinates and deflection, G = (R(y, theta), F(y, theta) - F_0)
= 0, so dy/dtheta = -(dG/dy)^-1 dG/dtheta. Its stiffness along a way is the least value over v of the quadratic energy
of `tire.travel_stiffness`, E(v; y, theta), so that at that v

    dS/dtheta = d/de E(v; y + e dy/dtheta, theta + e)

needs neither the change of v nor another solve: two evaluations, a central difference of the tangent. The points that
are stuck stay the same in it; where one more comes to touch, S jumps, and the gradient is that of those found touching.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.fit.load_sensitivity import STEP, VariedTire, partials
from ancf_reduced.fit.parameters import preset_at, unknowns_of
from ancf_reduced.motion.equilibrium import NewtonControls
from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.static import TireEquilibria
from ancf_reduced.tire.travel_stiffness import (
    WAYS,
    Stand,
    StuckGround,
    loaded_tangent,
    stand_under,
    stuck_ground,
)
from contracts.errors import ConvergenceError, InputError
from contracts.hub_travel import Way

__all__ = ["TravelData", "travel_gradient", "travel_stiffness"]

FloatArray = NDArray[np.float64]
type Neighbours = Sequence[tuple[Tire, Tire]]


@dataclass(frozen=True, slots=True, kw_only=True)
class TravelData:
    """Stiffnesses to be met, at the orientations of the load data.

    Attributes
    ----------
    ways : which ones
    load : under which the wheel stands [N], > 0
    stiffness : (n_phi, n_ways) float [N/m; N m/rad], > 0
    weight : > 0 [-]; a row is weight (S / stiffness - 1), beside rows of the loads' relative differences

    Raises
    ------
    InputError
        For ways that are none or twice, and numbers that are not above zero.

    Verified by tests/unit/test_ancf_travel_fit.py.
    """

    ways: tuple[Way, ...]
    load: float
    stiffness: FloatArray
    weight: float = 1.0

    def __post_init__(self) -> None:
        if not self.ways or len(set(self.ways)) < len(self.ways):
            raise InputError("ways", ", ".join(self.ways) or "none", "need one or more, none twice", "give lateral")
        for name, value, unit in (("load", self.load, " N"), ("weight", self.weight, "")):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} of the travels", f"{value:g}{unit}", "must be finite and > 0", "1 is usual")
        good = self.stiffness.ndim == 2 and self.stiffness.shape[1] == len(self.ways)
        if not good or not np.all(np.isfinite(self.stiffness)) or np.any(self.stiffness <= 0.0):
            rule = f"must be finite, > 0 and {len(self.ways)} an orientation"
            raise InputError("travel stiffness", str(self.stiffness.tolist()), rule, "check the travels")

    @property
    def columns(self) -> list[int]:
        """Where the ways are in `WAYS`."""
        return [WAYS.index(way) for way in self.ways]

    def weighted(self, values: FloatArray) -> FloatArray:
        """Rows of the least-squares problem from values (n_phi, n_ways, ...) [N/m; N m/rad], flat."""
        shape = self.stiffness.shape + (1,) * (values.ndim - 2)
        rows = self.weight * values / self.stiffness.reshape(shape)
        return np.asarray(rows.reshape(-1, *values.shape[2:]))


def travel_stiffness(
    tire: Tire, states: Sequence[TireEquilibria], data: TravelData, controls: NewtonControls | None = None
) -> FloatArray:
    """A tire's own stiffnesses at each orientation of its states, (n_phi, n_ways) float [N/m; N m/rad].

    Raises
    ------
    InputError, ConvergenceError
        As `tire.travel_stiffness.stand_under`.
    """
    matrices = [stuck_ground(stand_under(tire, s, data.load, controls)).stiffness_matrix() for s in states]
    return np.array([np.diag(S)[data.columns] for S in matrices])


def travel_gradient(
    varied: VariedTire, states: Sequence[TireEquilibria], data: TravelData, controls: NewtonControls | None = None
) -> FloatArray:
    """Derivative of `travel_stiffness` by every unknown of the fit, (n_phi, n_ways, n_free) float.

    Parameters
    ----------
    varied : from `load_sensitivity.vary_tire`
    states : equilibria of ``varied.tire`` at each orientation

    Verified by tests/unit/test_ancf_travel_fit.py (finite differences of whole solves).
    """
    at, step = unknowns_of(varied.tire.preset, varied.free), STEP * np.eye(len(varied.free))

    def built(unknowns: FloatArray) -> Tire:
        return build_tire(preset_at(varied.tire.preset, varied.free, unknowns))

    neighbours = [pair or (built(at - step[i]), built(at + step[i])) for i, pair in enumerate(varied.pairs)]
    stuck = [stuck_ground(stand_under(varied.tire, s, data.load, controls)) for s in states]
    return np.array([_gradient_at(varied, neighbours, one)[data.columns] for one in stuck])


def _gradient_at(varied: VariedTire, neighbours: Neighbours, stuck: StuckGround) -> FloatArray:
    """At one orientation, (3, n_free)."""
    stand, v = stuck.stand, stuck.moved()
    along = _along(varied, stand)
    gradient = np.empty((3, len(varied.free)))
    for i, (smaller, larger) in enumerate(neighbours):
        ends = (_shifted(stuck, smaller, -STEP * along[i]), _shifted(stuck, larger, STEP * along[i]))
        gradient[:, i] = (ends[1].energies(v) - ends[0].energies(v)) / (2.0 * STEP)
    return gradient


def _along(varied: VariedTire, stand: Stand) -> FloatArray:
    """dy/dtheta, (n_free, 12 n_free_nodes + 1): of the free coordinates and of the deflection under the load."""
    problem = stand.problem
    load, residual = partials(varied, problem, stand.coordinates, stand.deflection)
    K, s, by_d = loaded_tangent(problem, stand.coordinates, stand.deflection)
    bordered = np.block([[K, s[:, None]], [s[None], np.array([[by_d]])]])
    try:
        return np.asarray(-np.linalg.solve(bordered, np.column_stack([residual, load]).T).T)
    except np.linalg.LinAlgError as error:
        message = f"the derivative of the travel stiffness at {stand.deflection:.4g} m does not exist"
        raise ConvergenceError(message, []) from error


def _shifted(stuck: StuckGround, tire: Tire, step: FloatArray) -> StuckGround:
    """The same points of another tire, stuck, where it is moved by a step of the free coordinates and deflection."""
    stand = stuck.stand
    free = stand.coordinates[stand.tire.tie.free].ravel() + step[:-1]
    problem = replace(stand.problem, tire=tire)
    moved = Stand(
        tire=tire, phi=stand.phi, deflection=stand.deflection + float(step[-1]), coordinates=problem.expand(free)
    )
    ratio = tire.preset.contact_stiffness / stand.tire.preset.contact_stiffness
    return replace(stuck, stand=moved, stiffness=ratio * stuck.stiffness)
