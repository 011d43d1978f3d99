"""The ANCF wheel beside the solid model. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves, RunNumbers

__all__ = ["AncfWheelRow", "AncfWheelRuns", "differences", "energy_differences"]

Array = NDArray[np.float64]
_ENERGY = "stored_energy_J"


def differences(curve: StiffnessCurve, solid: StiffnessCurve) -> tuple[Array, Array]:
    """Deflections [m] of the ANCF wheel's points and F / F_solid - 1 there [-].

    Raises
    ------
    InputError
        If no point is common to both.
    """
    common = (curve.deflection > 0.0) & (curve.deflection <= solid.deflection[-1] + 1e-12)
    if not common.any():
        raise InputError("curves", "ancf_wheel, fe", "share no point with a load", "compute them further, or closer")
    at = curve.deflection[common]
    return at, curve.load[common] / solid.load_at(np.minimum(at, solid.deflection[-1])) - 1.0


def energy_differences(curve: StiffnessCurve, solid: StiffnessCurve) -> Array:
    """The same of the strain energy, W / W_solid - 1 [-]; raises InputError where a curve does not have it."""
    at, _ = differences(curve, solid)
    if not all(_ENERGY in one.columns for one in (curve, solid)):
        raise InputError("curves", "ancf_wheel, fe", f"do not both have {_ENERGY}", "compute them anew")
    energy = [np.interp(at, one.deflection, one.columns[_ENERGY]) for one in (curve, solid)]
    return np.asarray(energy[0] / energy[1] - 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfWheelRow:
    """One orientation: runs of both models; largest differences of load and energy, their signs kept [-]."""

    orientation: float
    ancf: RunNumbers
    fe: RunNumbers
    difference: float | None
    end: float | None
    energy: float | None
    negative: int


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfWheelRuns:
    """Curves of both models."""

    ancf: ModelCurves
    fe: ModelCurves

    @property
    def pairs(self) -> list[tuple[StiffnessCurve, StiffnessCurve]]:
        """Curves at orientations where both carry load."""
        solid = self.fe.loaded
        return [(curve, solid[o]) for o, curve in self.ancf.loaded.items() if o in solid]

    def all_differences(self, of: Callable[[StiffnessCurve, StiffnessCurve], Array] | None = None) -> Array:
        """Of load, or of what else, at every point of every orientation; InputError if one has none."""
        find = of or (lambda curve, solid: differences(curve, solid)[1])
        found = [find(*pair) for pair in self.pairs]
        if len(found) < len(self.ancf.by_orientation) or not found:
            raise InputError("curves", "ancf_wheel, fe", "are not there at every orientation", "see their runs")
        return np.concatenate(found)

    @property
    def rows(self) -> list[AncfWheelRow]:
        """Orientations that both models have."""
        return [self._row(*pair) for pair in self.pairs]

    def _row(self, curve: StiffnessCurve, solid: StiffnessCurve) -> AncfWheelRow:
        assert curve.orientation_deg is not None
        at = _or_none(lambda: differences(curve, solid)[0])
        return AncfWheelRow(
            orientation=curve.orientation_deg,
            ancf=self.ancf.runs[curve.orientation_deg],
            fe=self.fe.runs[curve.orientation_deg],
            difference=_largest(_or_none(lambda: differences(curve, solid)[1])),
            end=None if at is None else float(at[-1]),
            energy=_largest(_or_none(lambda: energy_differences(curve, solid))),
            negative=int(curve.columns["negative_pivots"].max()) if "negative_pivots" in curve.columns else 0,
        )


def _or_none(find: Callable[[], Array]) -> Array | None:
    """What is found; None where nothing is in common."""
    try:
        return find()
    except InputError:
        return None


def _largest(found: Array | None) -> float | None:
    return None if found is None else float(found[np.abs(found).argmax()])
