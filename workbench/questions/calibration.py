"""Strip thickness for a wanted initial tangent: the section model finds it, the solid model corrects and confirms it.

One factor f scales the thickness of the rim and of every spring set. With the tangents K_s (section) and K (solid):
solve K_s(f_1) = K*, measure r = K(f_1) / K_s(f_1), solve K_s(f_2) = K* / r, confirm K(f_2). The ratio r varies slowly
with thickness, so that one correction is enough. Verified by tests/unit/test_workbench_calibration.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from scipy.optimize import brentq

from contracts.errors import InputError
from workbench.study.model import Study
from workbench.study.wheel_design import wheel_design

__all__ = ["Calibration", "Trial", "calibrate", "scaled_study", "strip_thicknesses"]

type Tangent = Callable[[float], float]
"""Thickness factor -> initial tangent [N/m]."""

_SMALLEST, _LARGEST = 0.1, 5.0
_FIRST_STEP = 0.02
_TOLERANCE = 1e-4


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """Tangents of both models [N/m] at one thickness factor [-]."""

    factor: float
    section: float
    solid: float

    @property
    def ratio(self) -> float:
        """Solid over section tangent [-]."""
        return self.solid / self.section


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibration:
    """The trial where the section model meets the target [N/m], and the one after its correction."""

    target: float
    first: Trial
    corrected: Trial

    @property
    def difference(self) -> float:
        """Solid tangent at the corrected thickness against the target, relative [-]."""
        return self.corrected.solid / self.target - 1.0


def calibrate(target: float, section: Tangent, solid: Tangent) -> Calibration:
    """Find the factor for a target tangent [N/m] > 0.

    Raises
    ------
    InputError
        If no factor from 0.1 to 5 reaches the target.
    """
    section, solid = cache(section), cache(solid)
    start = section(1.0)
    guess = (target / start) ** (1.0 / 3.0)  # bending stiffness goes with the cube of thickness
    first = _trial(_factor(section, target, guess), section, solid)
    guess = first.factor * first.ratio ** (-1.0 / 3.0)
    return Calibration(
        target=target, first=first, corrected=_trial(_factor(section, target / first.ratio, guess), section, solid)
    )


def _trial(factor: float, section: Tangent, solid: Tangent) -> Trial:
    return Trial(factor=factor, section=section(factor), solid=solid(factor))


def _factor(section: Tangent, target: float, guess: float) -> float:
    """Root of ln(K_s(f) / target) in ln f, bracketed from a guess, then Brent's method; to 1e-4 of the thickness."""

    def excess(logarithm: float) -> float:
        return math.log(section(math.exp(logarithm)) / target)

    at = math.log(min(max(guess, _SMALLEST), _LARGEST))
    value, step = excess(at), _FIRST_STEP
    while value != 0.0:
        other, step = at - math.copysign(step, value), 2.0 * step
        if not math.log(_SMALLEST) <= other <= math.log(_LARGEST):
            rule = f"is not reached by any strip from {_SMALLEST:g} to {_LARGEST:g} times as thick as the study's"
            raise InputError("target tangent", f"{target * 1e-3:.4g} N/mm", rule, "check its unit, e.g. 8.25 N/mm")
        beyond = excess(other)
        if value * beyond <= 0.0:
            return math.exp(brentq(excess, at, other, xtol=_TOLERANCE))
        at, value = other, beyond
    return math.exp(at)


def strip_thicknesses(study: Study, factor: float = 1.0) -> dict[str, float]:
    """Thickness of the rim, of each spring set and of a lattice's walls [m], scaled, to a tenth of a micrometre."""
    design = wheel_design(study)
    for springs in design.spring_sets:
        if springs.tapered:
            rule = "varies along the strip, which calibrate does not scale"
            raise InputError(f"thickness of {springs.name}", "", rule, "vary strip_scale in [sweep] instead")
    strips = {"tire": design.tire.thickness} | {s.name: s.thickness for s in design.spring_sets}
    if design.lattice is not None:
        strips["lattice"] = design.lattice.thickness
    return {name: round(factor * thickness, 7) for name, thickness in strips.items()}


def scaled_study(study: Study, factor: float) -> Study:
    """The study with strips ``factor`` times as thick."""
    thickness = strip_thicknesses(study, factor)
    lattice = study.parametric.lattice
    wheel = study.parametric.model_copy(
        update={
            "lattice": lattice and lattice.model_copy(update={"thickness": thickness["lattice"]}),
            "tire": study.parametric.tire.model_copy(update={"thickness": thickness["tire"]}),
            "springs": tuple(s.model_copy(update={"thickness": thickness[s.name]}) for s in study.parametric.springs),
        }
    )
    return study.model_copy(update={"wheel": wheel})
