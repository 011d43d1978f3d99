"""The ANCF wheel beside the solid model. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves, RunNumbers

__all__ = ["AncfWheelRow", "AncfWheelRuns", "differences"]

Array = NDArray[np.float64]
_INNER = "inner_penetration_m"
"""Of the solid model's own parts: the ANCF wheel has no contact of springs with rim and hub."""


def differences(curve: StiffnessCurve, solid: StiffnessCurve, *, touching: bool = False) -> tuple[Array, Array]:
    """Deflections [m] of the ANCF wheel's points and F / F_solid - 1 there [-].

    touching : also where parts of the solid model touch each other; else before they first do

    Raises
    ------
    InputError
        If no such point is left.
    """
    inner = solid.columns.get(_INNER)
    free = np.ones_like(solid.load) if inner is None or touching else np.cumprod(inner <= 0.0)
    end = float((free * solid.deflection).max())
    common = (curve.deflection > 0.0) & (curve.deflection <= end + 1e-12)
    if not common.any():
        rule = "share no point with a load before springs touch rim or hub"
        raise InputError("curves", "ancf_wheel, fe", rule, "compute them further, or closer")
    at = curve.deflection[common]
    return at, curve.load[common] / solid.load_at(np.minimum(at, solid.deflection[-1])) - 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfWheelRow:
    """One orientation: runs of both models; largest difference, its sign kept [-], and up to where [m]; then of all."""

    orientation: float
    ancf: RunNumbers
    fe: RunNumbers
    difference: float | None
    end: float | None
    whole: float | None
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

    def all_differences(self, *, touching: bool = False) -> Array:
        """At every point of every orientation; raises InputError if one has none, or no orientation is common."""
        found = [differences(*pair, touching=touching)[1] for pair in self.pairs]
        if len(found) < len(self.ancf.by_orientation) or not found:
            raise InputError("curves", "ancf_wheel, fe", "are not there at every orientation", "see their runs")
        return np.concatenate(found)

    @property
    def rows(self) -> list[AncfWheelRow]:
        """Orientations that both models have."""
        return [self._row(*pair) for pair in self.pairs]

    def _row(self, curve: StiffnessCurve, solid: StiffnessCurve) -> AncfWheelRow:
        assert curve.orientation_deg is not None
        before, whole = _largest(curve, solid, touching=False), _largest(curve, solid, touching=True)
        return AncfWheelRow(
            orientation=curve.orientation_deg,
            ancf=self.ancf.runs[curve.orientation_deg],
            fe=self.fe.runs[curve.orientation_deg],
            difference=None if before is None else before[0],
            end=None if before is None else before[1],
            whole=None if whole is None else whole[0],
            negative=int(curve.columns["negative_pivots"].max()) if "negative_pivots" in curve.columns else 0,
        )


def _largest(curve: StiffnessCurve, solid: StiffnessCurve, *, touching: bool) -> tuple[float, float] | None:
    """Largest difference [-] and the last deflection [m]; None where nothing is in common."""
    try:
        at, found = differences(curve, solid, touching=touching)
    except InputError:
        return None
    return float(found[np.abs(found).argmax()]), float(at[-1])
