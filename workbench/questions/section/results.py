"""The planar section model beside the solid one.

Verified by tests/unit/test_workbench_section.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves, RunNumbers

__all__ = ["SectionRow", "SectionRuns", "first_difference", "largest_difference"]


_SMALLEST_LOAD = 5.0


def largest_difference(curve: StiffnessCurve, solid: StiffnessCurve | None) -> float:
    """Largest |F - F_solid| / max(F_solid, 5 N) at the solid curve's points that both reach [-]."""
    if solid is None:
        raise InputError("solid curve", "none", "is needed at the same orientation", "add it to fe.orientations")
    common = (solid.deflection <= curve.deflection[-1] + 1e-12) & (solid.load > 0.0)
    if not common.any():
        raise InputError("curves", "section, fe", "share no point with a load", "compute the curves further")
    loads = solid.load[common]
    difference = np.abs(curve.load_at(np.minimum(solid.deflection[common], curve.deflection[-1])) - loads)
    return float((difference / np.maximum(loads, _SMALLEST_LOAD)).max())


def first_difference(curve: StiffnessCurve, solid: StiffnessCurve) -> float:
    """|F - F_solid| / F_solid at the solid curve's first point with a load [-]."""
    loaded = solid.load > 0.0
    if not loaded.any() or solid.deflection[loaded][0] > curve.deflection[-1]:
        raise InputError("curves", "section, fe", "share no point with a load", "compute the curves further")
    return abs(float(curve.load_at(solid.deflection[loaded][0])) / float(solid.load[loaded][0]) - 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionRow:
    """One orientation in the table: runs of both models, largest difference of their curves [-].

    The difference is None where a partial curve leaves no common point.
    """

    orientation: float
    section: RunNumbers
    fe: RunNumbers
    difference: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionRuns:
    """Curves of the planar and of the solid model."""

    section: ModelCurves
    fe: ModelCurves

    @property
    def rows(self) -> list[SectionRow]:
        """Orientations that both models have."""
        solid = self.fe.by_orientation
        return [
            SectionRow(
                orientation=o, section=self.section.runs[o], fe=self.fe.runs[o], difference=_difference(curve, solid[o])
            )
            for o, curve in self.section.by_orientation.items()
            if o in solid
        ]


def _difference(curve: StiffnessCurve, solid: StiffnessCurve) -> float | None:
    try:
        return largest_difference(curve, solid)
    except InputError:
        return None
