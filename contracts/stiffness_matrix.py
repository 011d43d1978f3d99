"""Stiffness of a standing wheel against small motions of its hub, six by six, and its CSV.

Verified by tests/unit/test_stiffness_matrix.py and tests/end_to_end/test_travel.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import CsvTable, table_text
from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, TravelCurve

__all__ = ["MOTIONS", "StiffnessMatrix", "stiffness_matrix", "write_matrix"]

MOTIONS = ("forward", "left", "up", "about_forward", "about_left", "about_up")
"""Of the hub's centre along the ground's axes [m], and of the hub about it by the right hand [rad]."""
_MOVES = {
    Way.FORE_AFT: 0,
    Way.LATERAL: 1,
    Way.RADIAL: 2,
    Way.LEANING: 3,
    Way.WIND_UP: 4,
    Way.TURNING: 5,
}
_DOWN = -1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class StiffnessMatrix:
    """K = -d(force, moment of the ground on the wheel) / d(motion of the hub) at a load.

    Attributes
    ----------
    model : fe or ancf_wheel
    orientation_deg : circumferential position that faces the ground [deg]
    load, deflection : where the wheel stands [N, m]
    values : (6, 6) rows and columns in the order of `MOTIONS` [N/m, N/rad = N m/m, N m/rad]
    """

    model: str
    orientation_deg: float
    load: float
    deflection: float
    values: NDArray[np.float64]

    @property
    def asymmetry(self) -> float:
        """Norm of K - K^T over that of K, angles as lengths at a radius that makes both halves of the trace alike [-].

        Zero where nothing slides and the ground exerts no moment about the hub: among turns K - K^T is that moment.
        """
        radius = np.sqrt(np.trace(self.values[3:, 3:]) / np.trace(self.values[:3, :3]))
        scale = np.array([1.0, 1.0, 1.0, *[1.0 / radius] * 3])
        K = self.values * np.outer(scale, scale)
        return float(np.linalg.norm(K - K.T) / np.linalg.norm(K))


def stiffness_matrix(curves: Sequence[TravelCurve]) -> StiffnessMatrix:
    """From the first step of each of the six ways, one model's wheel at one orientation.

    Raises
    ------
    InputError
        If a way is missing.
    """
    found = {curve.way: curve for curve in curves}
    lacking = [way.value for way in Way if way not in found]
    if lacking:
        rule = "ended before their first step, so that a column of the matrix is not known"
        raise InputError("travels", ", ".join(lacking), rule, "choose a smaller load")
    K = np.empty((6, 6))
    for way, column in _MOVES.items():
        curve = found[way]
        force = np.array([curve.columns[name] for name in WRENCH])
        K[:, column] = -(force[:, 1] - force[:, 0]) / curve.travel[1] * (_DOWN if way is Way.RADIAL else 1.0)
    first = found[Way.RADIAL]
    return StiffnessMatrix(
        model=first.model,
        orientation_deg=first.orientation_deg,
        load=float(first.columns["load_N"][0]),
        deflection=first.deflection,
        values=K,
    )


def write_matrix(matrix: StiffnessMatrix, path: Path) -> None:
    """Write the six columns as CSV, rows in the order of `MOTIONS`, SI units."""
    path.parent.mkdir(parents=True, exist_ok=True)
    at = f"{matrix.model} at {matrix.orientation_deg:g} deg, {matrix.load:.6g} N, {1e3 * matrix.deflection:.6g} mm"
    source = f"stiffness of the standing wheel: {at}; rows as columns; N/m, N/rad, N m/m, N m/rad"
    table = CsvTable(names=MOTIONS, values=matrix.values, source=source, partial=False)
    path.write_text(table_text(table), encoding="utf-8", newline="")
