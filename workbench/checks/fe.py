"""Checks of the continuum model: mesh, solver, curve against the band.

Verified by tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check, Role
from workbench.checks.rules import Claim, at_least, at_most, near, within
from workbench.comparison.curves import ModelCurves, mean_curve
from workbench.comparison.mesh_study import MeshRun
from workbench.comparison.metrics import largest_spread
from workbench.study.model import Band
from workbench.study.sections import ToleranceSection

__all__ = ["band_checks", "mesh_checks", "reach_check", "solver_checks", "spread_checks", "yield_check"]

_EQUILIBRIUM = "equilibrium of the discrete weak form, Bonet & Wood 2008, ch. 8; the limit is the solver's own"
_SUMS = "Euler's laws of motion at rest; the limit is ours"
_SWEEP = "Samarini 2020, section 3.2 and Fig. 20: 160 to 250 N on a wheel; the room beyond is ours"
_SHAPE = "scaled Jacobian of a hexahedron, Stimpson et al. 2007, SAND2007-1751; the limit is ours"
_SPREAD_AT = (0.005, 0.020, 0.030)


def band_checks(fe: ModelCurves, band: Band, tolerances: ToleranceSection) -> list[Check]:
    """Average curve against the band: tangent near first contact, deflection at each of the band's loads.

    The tangent is a gate for the wheel that the band describes, a finding for any other.
    """
    checks = [_tangent_check(fe, band, tolerances)]
    for point in band.points:
        name, title = f"fe.deflection_at_{point.load:g}N", f"Average FE curve: deflection at {point.load:g} N"
        claim = _claim(name, title, "deflection", "m", "finding", band.source)
        checks.append(within(claim, partial(fe.average.deflection_at, point.load), point.low, point.high))
    return checks


def _tangent_check(fe: ModelCurves, band: Band, tolerances: ToleranceSection) -> Check:
    up_to, named = tolerances.initial_tangent_up_to, tolerances.initial_tangent_orientations
    average, which = fe.average, "Average FE curve"
    if named is not None and len(named) < len(fe.by_orientation):
        chosen = {o: c for o, c in fe.by_orientation.items() if any(abs(math.degrees(n) - o) < 1e-6 for n in named)}
        average = mean_curve(list(chosen.values()))
        which = f"Average FE curve of {', '.join(f'{o:g}' for o in chosen)} degrees alone"
    title = f"{which}: slope from first contact to {up_to * 1e3:g} mm"
    claim = _claim("fe.initial_tangent", title, "initial tangent", "N/m", _role(tolerances), band.source)
    return near(claim, lambda: average.initial_tangent(up_to), band.initial_tangent, tolerances.initial_tangent)


def spread_checks(fe: ModelCurves, tolerances: ToleranceSection, up_to: float) -> list[Check]:
    """How much the load varies around the wheel at those of three deflections that lie within ``up_to`` [m].

    A single orientation of any but the reference's wheel is asked none.
    """
    curves = list(fe.by_orientation.values())
    return [
        at_most(
            _claim(
                f"fe.spread_{d * 1e3:g}mm",
                f"FE: (largest - smallest) / mean load over the orientations at {d * 1e3:g} mm",
                "spread",
                "-",
                "finding",
                "the thesis says that stiffness varies around the wheel, not how much; the limit is ours",
            ),
            partial(_spread, curves, d),
            tolerances.orientation_spread,
        )
        for d in _SPREAD_AT
        if d <= up_to and (len(curves) > 1 or tolerances.reference_wheel)
    ]


def _spread(curves: list[StiffnessCurve], deflection: float) -> float:
    if len(curves) < 2:
        rule = "needs at least two to have a spread"
        raise InputError("orientations", len(curves), rule, "add another to fe.orientations")
    return largest_spread(curves, deflection)


def reach_check(fe: ModelCurves, tol: ToleranceSection) -> Check:
    """How far every orientation came: a gate for the wheel of the reference, a finding for any other."""

    def reach() -> float:
        ends = [
            (c.deflection[-1] / tol.reach_deflection, c.load.max() / tol.reach_load) for c in fe.by_orientation.values()
        ]
        return float(min(max(pair) for pair in ends))

    goal = f"{tol.reach_deflection * 1e3:g} mm or {tol.reach_load:g} N"
    claim = _claim("fe.reach", f"FE: every orientation reaches {goal}", "part reached", "-", _role(tol), _SWEEP)
    return at_least(claim, reach, 1.0)


def solver_checks(fe: ModelCurves, others: Sequence[MeshRun], tol: ToleranceSection) -> list[Check]:
    """Residual and balance of every run, those of the mesh study included."""
    curves = [*fe.by_orientation.values(), *(run.curve for run in others)]
    numbers = [*fe.numbers.values(), *(run.numbers for run in others)]
    moments = "FE: largest imbalance of moments about the hub's centre over contact force times radius"
    residual = "FE: largest residual of any converged increment, relative to the nodal support and contact forces"
    return [
        at_most(
            _claim("fe.residual", residual, "residual", "-", "gate", _EQUILIBRIUM),
            lambda: largest_residual(numbers),
            tol.fe_residual,
        ),
        at_most(
            _claim("fe.balance", "FE: largest imbalance of forces over contact force", "imbalance", "-", "gate", _SUMS),
            partial(_largest, curves, "force_imbalance"),
            tol.fe_balance,
        ),
        at_most(
            _claim("fe.moment_balance", moments, "imbalance", "-", "gate", _SUMS),
            partial(_largest, curves, "moment_imbalance"),
            tol.fe_balance,
        ),
    ]


def _largest(curves: Sequence[StiffnessCurve], column: str) -> float:
    """Largest absolute value of a column on any curve that carries load; NaN without any."""
    return max((float(np.abs(c.columns[column]).max()) for c in curves if not c.unloaded), default=math.nan)


def largest_residual(runs: Sequence[Mapping[str, Any]]) -> float:
    """Largest relative residual at the end of any converged increment of any run [-]."""
    found = [float(r["residuals"][-1]) for n in runs for r in n["increments"] if r["converged"]]
    if not found:
        raise InputError("increments", 0, "converged", "see the runs' messages")
    return max(found)


def yield_check(fe: ModelCurves, yield_strength: Mapping[str, float], up_to: float) -> Check:
    """Largest von Mises stress over yield strength in any part, up to a load [N]."""

    def utilisation() -> float:
        lowest = min(float(curve.load.max()) for curve in fe.by_orientation.values())
        if lowest < up_to:
            rule = f"does not reach {up_to:g} N at every orientation"
            raise InputError("load", f"{lowest:g} N", rule, "raise fe.max_deflection or fe.max_load")
        return max(
            _largest_up_to(curve, f"max_von_mises_{part}_Pa", up_to) / strength
            for curve in fe.by_orientation.values()
            for part, strength in yield_strength.items()
            if f"max_von_mises_{part}_Pa" in curve.columns
        )

    title = f"FE: largest von Mises stress over yield strength up to {up_to:g} N"
    claim = _claim("fe.yield", title, "stress / yield", "-", "finding", "yield strengths of the study's materials")
    return at_most(claim, utilisation, 1.0)


def _largest_up_to(curve: StiffnessCurve, column: str, load: float) -> float:
    inside = curve.load <= load
    inside[: min(int(inside.sum()) + 1, len(inside))] = True
    return float(curve.columns[column][inside].max())


def mesh_checks(mesh: Mapping[str, Any], whole: Mapping[str, Any], tolerances: ToleranceSection) -> list[Check]:
    """Volume and mass of the whole wheel against closed form; the worst cell of both meshes."""
    form = "closed form of the design"

    def worst() -> float:
        return min(float(m["quality"]["min_scaled_jacobian"]) for m in (mesh, whole))

    return [
        near(
            _claim("mesh.volume", "Mesh of the whole wheel: volume", "volume", "m^3", "gate", form),
            lambda: float(whole["total_volume"]),
            float(whole["total_volume_closed_form"]),
            tolerances.mesh_mass,
        ),
        near(
            _claim("mesh.mass", "Mesh of the whole wheel: mass", "mass", "kg", "gate", form),
            lambda: float(whole["total_mass"]),
            float(whole["total_mass_closed_form"]),
            tolerances.mesh_mass,
        ),
        at_least(
            _claim(
                "mesh.min_scaled_jacobian",
                "Smallest scaled Jacobian of any cell",
                "scaled Jacobian",
                "-",
                "gate",
                _SHAPE,
            ),
            worst,
            tolerances.min_scaled_jacobian,
        ),
    ]


def _role(tolerances: ToleranceSection) -> Role:
    """What the reference demands binds the reference's wheel only."""
    return "gate" if tolerances.reference_wheel else "finding"


def _claim(id: str, title: str, quantity: str, unit: str, role: Role, source: str) -> Claim:
    return Claim(id=id, title=title, quantity=quantity, unit=unit, role=role, source=source)
