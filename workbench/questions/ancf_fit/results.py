"""The ANCF tires fitted to the FE curves, beside the study's own.

Verified by tests/unit/test_workbench_ancf_fit.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.ancf_fit.fit import FittedTire
from workbench.questions.model_curves import ModelCurves

if TYPE_CHECKING:
    from workbench.questions.ancf_fit.records import Fitted, Held

__all__ = ["AncfFits"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfFits:
    """The study's own tire, the fitted ones, and what they are held against.

    Attributes
    ----------
    own : the tire of [ancf] as it is; None without result
    fitted : those of [ancf_fit], in their order; none without result
    kept : name of the one that ``workbench calibrate ancf`` writes into a study
    fe : the continuum curves
    period : turn after which the FE wheel repeats itself [deg]
    failure : why there is no result, else None
    """

    own: FittedTire[Held] | None
    fitted: tuple[FittedTire[Fitted], ...]
    kept: str
    fe: ModelCurves
    period: float
    failure: InputError | None = None

    @property
    def best(self) -> FittedTire[Fitted]:
        """The one that is kept; raises the reason if there is no result."""
        if self.failure is not None:
            raise self.failure
        return next(tire for tire in self.fitted if tire.name == self.kept)

    @property
    def all(self) -> tuple[FittedTire[Held], ...]:
        """The study's own tire, then the fitted ones."""
        return self.fitted if self.own is None else (self.own, *self.fitted)

    @property
    def periods(self) -> Mapping[str, float]:
        """Turn after which each tire repeats itself [deg]: 360 deg over its spokes."""
        return {tire.name: 360.0 / tire.numbers.preset.spokes for tire in self.all}

    @property
    def half_period(self) -> float | None:
        """How far the FE curves at 0 and half a period differ [-]: rms over load; None where there are not both."""
        pair = [self.fe.loaded.get(o) for o in (0.0, 0.5 * self.period)]
        return _difference(pair[0], pair[1]) if pair[0] is not None and pair[1] is not None else None


def _difference(one: StiffnessCurve, other: StiffnessCurve) -> float:
    """Root mean square of the difference of two curves over that of their mean, where both have points [-]."""
    d = np.linspace(max(one.deflection[0], other.deflection[0]), min(one.deflection[-1], other.deflection[-1]), 101)
    a, b = one.load_at(d), other.load_at(d)
    return float(np.linalg.norm(a - b) / np.linalg.norm(0.5 * (a + b)))
