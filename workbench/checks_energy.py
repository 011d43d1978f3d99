"""Check that the work of the ground is found again as elastic energy.

Verified by tests/unit/test_workbench_energy.py and tests/verification/test_fe_energy.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.check_rules import Claim, at_most

__all__ = ["energy_check", "energy_error", "quadrature_error"]

ENERGY = "stored_energy_J"


def energy_error(curve: StiffnessCurve) -> float:
    """|work - change of stored energy| / work at the curve's end [-].

    The work of the rising ground is the integral of load over deflection, by the trapezoid rule over the points.
    What the springs of the contact penalty store, at most half the load times the penetration, is not counted.
    """
    if ENERGY not in curve.columns:
        raise InputError("curve", curve.source, f"has no column {ENERGY}", "compute it again")
    work = float(np.trapezoid(curve.load, curve.deflection))
    energy = curve.columns[ENERGY]
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
    claim = Claim(
        id="fe.energy",
        title=f"FE: work of the ground against stored energy (the trapezoid rule errs by {100.0 * estimate:.2g} %)",
        quantity="difference",
        unit="-",
        role="gate",
        source="conservation of energy: elastic, frictionless",
    )
    return at_most(claim, lambda: max((energy_error(curve) for curve in loaded), default=math.nan), limit)
