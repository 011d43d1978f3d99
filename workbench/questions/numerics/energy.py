"""Check that the work of the ground is found again as elastic energy and as heat of friction.

Verified by tests/unit/test_workbench_energy.py and tests/verification/test_fe_energy.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.verdict.rules import Claim, at_most

__all__ = ["energy_check", "energy_error", "quadrature_error"]

ENERGY = "stored_energy_J"
FRICTION = ("slip_energy_J", "friction_dissipation_J")
"""Stored by elastic slip, dissipated by sliding; both are zero without friction."""
FLOW = "plastic_dissipation_J"
"""Work of plastic flow; absent where no part can yield."""


def energy_error(curve: StiffnessCurve) -> float:
    """|work - change of stored energy - dissipation| / work at the curve's end [-].

    The work of the rising ground is the integral of load over deflection, by the trapezoid rule over the points; so is
    what friction dissipates, see `reference_fe.contact.friction_energy`. Elastic slip stores energy as the body does;
    plastic flow takes up the rest.
    What the springs of the contact penalty store, at most half the load times the penetration, is not counted.
    """
    if ENERGY not in curve.columns:
        raise InputError("curve", curve.source, f"has no column {ENERGY}", "compute it again")
    work = float(np.trapezoid(curve.load, curve.deflection))
    energy = np.sum([curve.columns[name] for name in (ENERGY, *FRICTION, FLOW) if name in curve.columns], axis=0)
    return abs(work - float(energy[-1] - energy[0])) / work


def quadrature_error(curve: StiffnessCurve) -> float:
    """Estimated error of the trapezoid rule over the work [-]: a third of the change without every other point."""
    n = len(curve.load)
    kept = np.unique([*range(0, n, 2), n - 1])
    fine = float(np.trapezoid(curve.load, curve.deflection))
    coarse = float(np.trapezoid(curve.load[kept], curve.deflection[kept]))
    return abs(fine - coarse) / (3.0 * fine)


def energy_check(curves: Sequence[StiffnessCurve], limit: float) -> Check:
    """The largest difference of work and energy of any curve; the rule's own error is named in the title."""
    loaded = [curve for curve in curves if not curve.unloaded]
    estimate = max((quadrature_error(curve) for curve in loaded), default=0.0)
    title = "FE: work of the ground against stored and dissipated energy"
    claim = Claim(
        id="fe.energy",
        title=f"{title} (the trapezoid rule errs by {100.0 * estimate:.2g} %)",
        quantity="difference",
        unit="-",
        role="gate",
        source="conservation of energy: elastic wheel, plastic flow, friction on the ground",
    )
    return at_most(claim, lambda: max((energy_error(curve) for curve in loaded), default=math.nan), limit)
