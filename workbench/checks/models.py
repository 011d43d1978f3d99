"""Checks of the reduced models, and of each model against the continuum.

Verified by tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from contracts.errors import InputError
from contracts.records import Check
from workbench.checks.preset_table import COLUMNS, preset_table
from workbench.checks.rules import Claim, at_least, at_most, near
from workbench.comparison.curves import ModelCurves, UserCurve
from workbench.study.sections import ToleranceSection

__all__ = ["agreement_checks", "ancf_checks", "preset_error", "surfaces_check", "user_checks"]

_PRESET_SOURCE = "two independent codes computed for this project, which agree (workbench/data/ancf_thesis_preset.csv)"
_PLATE_SOURCE = "exact quadrature of thesis eq. 2.13; Project Chrono's reference matrices to 1e-11"
_THESIS_WHEEL_MASS = 4.44157
_SMALLEST_LOAD = 5.0
"""Load [N] below which an entry of the preset's table counts absolutely."""
_UNKNOWN: Mapping[str, Any] = dict.fromkeys(("relative_l2", "max_error", "tangent"), math.nan) | {
    "reference_load": 0.0,
    "tangent_reference": 0.0,
    "iso_rating": None,
}
"""Distances from an FE average that does not exist."""


def preset_error(ancf: ModelCurves, orientation_deg: float) -> float:
    """Largest |F - F_table| / max(F_table, 5 N) over the table's entries [-].

    Each entry above 5 N counts relative to itself; at or below 5 N, 1 % of this error is 0.05 N.
    """
    if orientation_deg not in ancf.by_orientation:
        known = ", ".join(f"{o:g}" for o in ancf.by_orientation)
        rule = f"was not computed (only {known} deg)"
        raise InputError("orientation", f"{orientation_deg:g} deg", rule, "add it to ancf.orientations")
    table = preset_table()
    known_loads = table[:, COLUMNS[orientation_deg]]
    found = ancf.by_orientation[orientation_deg].load_at(table[:, 0])
    return float((np.abs(found - known_loads) / np.maximum(known_loads, _SMALLEST_LOAD)).max())


def ancf_checks(ancf: ModelCurves, tolerances: ToleranceSection) -> list[Check]:
    """The thesis preset's curves against their table, and its flexible mass against Table I."""
    checks = [
        at_most(
            Claim(
                id=f"ancf.preset_phi{o:03.0f}",
                title=f"ANCF thesis preset at {o:g} deg against its known table, 2 to 35 mm",
                quantity="largest difference / load, 5 N at least",
                unit="-",
                role="gate",
                source=_PRESET_SOURCE,
            ),
            partial(preset_error, ancf, o),
            tolerances.ancf_preset,
        )
        for o in COLUMNS
    ]
    mass = Claim(
        id="ancf.flexible_mass",
        title="ANCF thesis preset: mass of the flexible plates against the wheel of Table I",
        quantity="mass",
        unit="kg",
        role="gate",
        source="Samarini 2020, Table I",
    )
    first = next(iter(ancf.numbers.values()))
    return [
        *checks,
        near(mass, lambda: float(first["flexible_mass_kg"]), _THESIS_WHEEL_MASS, tolerances.flexible_mass),
    ]


def surfaces_check(read_back: Mapping[str, float], tolerances: ToleranceSection) -> Check:
    """The ANCF tire's surfaces in STEP files, unloaded and loaded, against the plates' own [m]."""
    return at_most(
        Claim(
            id="ancf.surfaces",
            title="ANCF tire as B-spline surfaces in STEP files, read back by gmsh: unloaded and loaded",
            quantity="largest distance",
            unit="m",
            role="gate",
            source="thesis eq. 2.13 at points of every plate's faces and mid-surface",
        ),
        lambda: max(read_back.values()),
        tolerances.surface_distance,
    )


def agreement_checks(
    models: Sequence[str], metrics: Mapping[str, Mapping[str, Any]], tolerances: ToleranceSection
) -> list[Check]:
    """Those of ``"ancf"`` and ``"brush"`` that there are against the FE average, over the range they share up to 250 N:
    findings."""
    ancf, brush = metrics.get("ancf_average", _UNKNOWN), metrics.get("brush", _UNKNOWN)
    agree = tolerances.model_agreement
    against = "ANCF average against FE average"
    checks = [
        at_most(
            _agreement_claim(ancf, "ancf_vs_fe.relative_l2", against, "relative L2 difference"),
            lambda: ancf["relative_l2"],
            agree,
        ),
        at_most(
            _agreement_claim(ancf, "ancf_vs_fe.max_error", f"{against}: largest difference", "load", "N"),
            lambda: ancf["max_error"],
            agree * ancf["reference_load"],
        ),
        near(
            _agreement_claim(ancf, "ancf_vs_fe.tangent", f"{against}: mean slope", "tangent", "N/m"),
            lambda: ancf["tangent"],
            ancf["tangent_reference"],
            agree,
        ),
        at_least(
            _agreement_claim(ancf, "ancf_vs_fe.iso_18571", f"{against}: ISO/TS 18571 rating", "rating"),
            partial(_rating, ancf),
            tolerances.iso_rating,
        ),
        at_most(
            _agreement_claim(
                brush, "brush_vs_fe.relative_l2", "Brush line against FE average", "relative L2 difference"
            ),
            lambda: brush["relative_l2"],
            agree,
        ),
    ]
    unknown = {"ancf": ancf is _UNKNOWN, "brush": brush is _UNKNOWN}
    return [
        replace(check, reference=None, tolerance="not known") if unknown[model] else check
        for check in checks
        if (model := check.id.partition("_")[0]) in models
    ]


def _agreement_claim(numbers: Mapping[str, Any], id: str, title: str, quantity: str, unit: str = "-") -> Claim:
    if numbers is _UNKNOWN:
        source = "no point of any FE curve converged"
    else:
        title += f", {numbers['start'] * 1e3:.1f} to {numbers['end'] * 1e3:.1f} mm"
        source = f"comparison where the FE average carries up to {numbers['reference_load']:.4g} N; the limit is ours"
    return Claim(id=id, title=title, quantity=quantity, unit=unit, role="finding", source=source)


def _rating(numbers: Mapping[str, Any]) -> float:
    if numbers["iso_rating"] is None:
        raise InputError("rating", "not defined", "needs curves that vary", "check the curves")
    return float(numbers["iso_rating"])


def user_checks(
    users: Sequence[UserCurve], metrics: Mapping[str, Mapping[str, Any]], tolerances: ToleranceSection
) -> list[Check]:
    """The FE curve against each curve the user dropped in: findings."""
    return [
        at_most(
            Claim(
                id=f"user_{i}.relative_l2",
                title=f"FE {_place(user)} against the user's curve '{user.label}'",
                quantity="relative L2 difference",
                unit="-",
                role="finding",
                source=user.curve.source,
            ),
            partial(_difference_from_user, metrics, i),
            tolerances.model_agreement,
        )
        for i, user in enumerate(users)
    ]


def _difference_from_user(metrics: Mapping[str, Mapping[str, Any]], i: int) -> float:
    if f"user_{i}" not in metrics:
        raise InputError("FE curve", "no point", "converged at the user curve's orientation", "see its run's message")
    return float(metrics[f"user_{i}"]["relative_l2"])


def _place(user: UserCurve) -> str:
    return "average" if user.orientation_deg is None else f"at {user.orientation_deg:g} deg"
