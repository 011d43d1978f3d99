"""Checks of the ANCF tire: the thesis' preset against its table, its mass, its surfaces in STEP files.

Verified by tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.ancf.preset_table import COLUMNS, preset_table
from workbench.questions.model_curves import ModelCurves
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_most, near

__all__ = ["ancf_checks", "preset_error", "surfaces_check"]

_PRESET_SOURCE = (
    "two independent codes computed for this project, which agree (workbench/questions/ancf/ancf_thesis_preset.csv)"
)
_THESIS_WHEEL_MASS = 4.44157
_SMALLEST_LOAD = 5.0
"""Load [N] below which an entry of the preset's table counts absolutely."""


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
    first = next(iter(ancf.runs.values()))
    return [
        *checks,
        near(mass, lambda: first.flexible_mass, _THESIS_WHEEL_MASS, tolerances.flexible_mass),
    ]


def surfaces_check(distance: Callable[[], float], tolerances: ToleranceSection) -> Check:
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
        distance,
        tolerances.surface_distance,
    )
