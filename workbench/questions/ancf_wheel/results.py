"""The ANCF wheel beside the solid model. Verified by tests/unit/test_workbench_ancf_wheel.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves, RunNumbers

__all__ = ["AncfWheelRow", "AncfWheelRuns", "differences", "energy_differences", "stress_differences"]

Array = NDArray[np.float64]
_ENERGY, _INNER, _STRESS = "stored_energy_J", "inner_penetration_m", "max_linearised_"


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


def stress_differences(curve: StiffnessCurve, solid: StiffnessCurve, *, touching: bool) -> Array:
    """The same of the largest stress of each spring set, one thickness from welds on, (points x sets,) [-].

    touching : where springs of the solid lie on rim, hub or each other; else before they first do
    """
    at, _ = differences(curve, solid)
    names = [name for name in curve.columns if name.startswith(_STRESS)]  # the ANCF wheel's: of springs alone
    if not names or any(name not in solid.columns for name in (*names, _INNER)):
        raise InputError("curves", "ancf_wheel, fe", f"do not both have {_STRESS}...", "compute them anew")
    inner = np.interp(at, solid.deflection, np.cumsum(solid.columns[_INNER]))
    chosen = (inner > 0.0) == touching
    both = [[np.interp(at, one.deflection, one.columns[n]) for one in (curve, solid)] for n in names]
    return np.concatenate([(a[chosen] / b[chosen] - 1.0) for a, b in both])


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfWheelRow:
    """One orientation: runs of both models; largest differences, their signs kept [-].

    Of load and energy; of the springs' stress before they first touch rim or hub, and after.
    """

    orientation: float
    ancf: RunNumbers
    fe: RunNumbers
    difference: float | None
    end: float | None
    energy: float | None
    stress: float | None
    stress_touching: float | None
    negative: int


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfWheelRuns:
    """Curves of both models, and distances of their shapes: rows of ``ancf_wheel_shape``, None where not asked for."""

    ancf: ModelCurves
    fe: ModelCurves
    shapes: Sequence[Mapping[str, float]] | None = None

    @property
    def shape_parts(self) -> list[str]:
        """Parts whose middle surfaces are compared."""
        first = self.shapes[0] if self.shapes else {}
        return [
            name.removeprefix("rms_").removesuffix("_m")
            for name in first
            if name.startswith("rms_") and name != "rms_m"
        ]

    @property
    def last_shapes(self) -> list[Mapping[str, float]]:
        """The row of each orientation's last point."""
        return list({row["orientation_deg"]: row for row in self.shapes or ()}.values())

    def shape_distance(self) -> float:
        """Of all parts together, largest at any orientation and point [m]; InputError if there is none."""
        if not self.shapes:
            raise InputError("shapes", "ancf_wheel, fe", "have no point in common", "see the runs of both")
        return max(row["rms_m"] for row in self.shapes)

    @property
    def touching(self) -> list[Mapping[str, float]]:
        """Rows at which springs lie on the rim in either model."""
        return [row for row in self.shapes or () if max(row["rim_force_N"], row["solid_rim_force_N"]) > 0.0]

    def rim_force_difference(self) -> float:
        """Between the two models' forces of springs on the rim, over the load, largest at any orientation and point."""
        return max(abs(row["rim_force_N"] - row["solid_rim_force_N"]) / row["load_N"] for row in self.touching)

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
            stress=_largest(_or_none(lambda: stress_differences(curve, solid, touching=False))),
            stress_touching=_largest(_or_none(lambda: stress_differences(curve, solid, touching=True))),
            negative=int(curve.columns["negative_pivots"].max()) if "negative_pivots" in curve.columns else 0,
        )


def _or_none(find: Callable[[], Array]) -> Array | None:
    """What is found; None where nothing is in common."""
    try:
        return find()
    except InputError:
        return None


def _largest(found: Array | None) -> float | None:
    return None if found is None or not len(found) else float(found[np.abs(found).argmax()])
