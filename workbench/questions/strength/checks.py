"""Checks of stress against yield. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

from collections.abc import Mapping

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.model_curves import ModelCurves
from workbench.verdict.rules import Claim, at_most

__all__ = ["yield_check"]


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
    claim = Claim(
        id="fe.yield",
        title=title,
        quantity="stress / yield",
        unit="-",
        role="finding",
        source="yield strengths of the study's materials",
    )
    return at_most(claim, utilisation, 1.0)


def _largest_up_to(curve: StiffnessCurve, column: str, load: float) -> float:
    inside = curve.load <= load
    inside[: min(int(inside.sum()) + 1, len(inside))] = True
    return float(curve.columns[column][inside].max())
