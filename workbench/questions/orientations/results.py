"""How the load goes around the wheel.

Verified by tests/unit/test_workbench_full_study.py and tests/end_to_end/test_full_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError

__all__ = ["OrientationMap"]


@dataclass(frozen=True, slots=True, kw_only=True)
class OrientationMap:
    """Curves of the continuum model around the wheel.

    Attributes
    ----------
    curves : by orientation [deg], ascending; without those of which no point converged
    missing : orientations of the latter [deg]
    period : turn after which the wheel repeats itself [deg]
    mirrored : whether the wheel is its own mirror image about position 0
    """

    curves: Mapping[float, StiffnessCurve]
    missing: Sequence[float]
    period: float
    mirrored: bool

    @property
    def orientations(self) -> NDArray[np.float64]:
        """(n,) [deg]; InputError if there is none."""
        if not self.curves:
            raise InputError("orientations", 0, "converged anywhere", "see the runs' messages")
        return np.array(list(self.curves))

    @property
    def complete(self) -> bool:
        """Whether the orientations cover one period in equal steps."""
        steps = np.diff([*self.orientations, self.orientations[0] + self.period])
        return bool(np.allclose(steps, steps[0]))

    def deflections(self, step: float) -> NDArray[np.float64]:
        """Multiples of ``step`` [m] that every curve reaches, zero left out, (m,) [m]."""
        end = min(self.curves[o].deflection[-1] for o in self.orientations)
        return np.asarray(step * np.arange(1, int(np.floor(end / step + 1e-9)) + 1), dtype=np.float64)

    def loads(self, deflections: NDArray[np.float64]) -> NDArray[np.float64]:
        """(m, n) load [N] at each of (m,) deflections [m] and each orientation."""
        return np.column_stack([curve.load_at(deflections) for curve in self.curves.values()])

    @property
    def mirror_pairs(self) -> tuple[tuple[float, float], ...]:
        """Two different orientations [deg] each that the wheel's symmetry maps onto each other."""
        if not self.mirrored:
            return ()
        known = self.orientations
        images = [(phi, (-phi) % self.period) for phi in known]
        found = [(phi, known[np.abs(known - image) < 1e-6]) for phi, image in images]
        return tuple((float(phi), float(image[0])) for phi, image in found if len(image) and image[0] > phi + 1e-6)

    def mirror_error(self) -> float:
        """Largest difference of load within a pair over their mean, at points that were solved for both [-]."""
        if not self.mirror_pairs:
            raise InputError("orientations", len(self.curves), "hold no two mirror images", "add the image of one")
        return max(_distance(self.curves[a], self.curves[b]) for a, b in self.mirror_pairs)


def _distance(one: StiffnessCurve, other: StiffnessCurve) -> float:
    n = min(len(one.load), len(other.load))
    same = np.isclose(one.deflection[:n], other.deflection[:n], rtol=0.0, atol=1e-9) & (one.load[:n] > 0.0)
    if not same.any():
        raise InputError(
            "curves of mirror images", "0 points", "share no point", "a curve is partial: compute it further"
        )
    a, b = one.load[:n][same], other.load[:n][same]
    return float(np.max(np.abs(a - b) / (0.5 * (a + b))))
