"""What a record says of the ANCF wheel beside the solid model. Verified by tests/unit/test_workbench_ancf_wheels.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.hub_travel import OVER_GROUND
from workbench.questions.ancf_wheels.cases import ComparedWheel

__all__ = ["Agreement", "agreement", "largest"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """Loads of one wheel at the plates' points, F / F_solid - 1 [-].

    Attributes
    ----------
    orientations : [deg]
    ends : smallest and largest last deflection compared, over orientations [m]
    partial : whether a run of either model ended before its target
    largest, at_deg, at_m : the difference of largest size, its sign kept, with orientation [deg] and deflection [m]
    mean : of the differences' sizes
    plates_mesh, solid_mesh : what a mesh twice as fine moves each model's load by, largest at any point, sign kept
    finer : largest difference of the two finer models, sign kept
    stress, stress_finer : of the springs' largest stress before they touch anything, sign kept; at any orientation, and
        of the two finer models; None where they touch from the first point on
    unknowns, seconds : of plates and solid, means over orientations
    travels : stiffness of plates and solid by way and orientation [deg] [N/m; N m/rad of a turn]
    """

    orientations: int
    ends: tuple[float, float]
    partial: bool
    largest: float
    at_deg: float
    at_m: float
    mean: float
    plates_mesh: float
    solid_mesh: float
    finer: float
    stress: float | None
    stress_finer: float | None
    unknowns: tuple[float, float]
    seconds: tuple[float, float]
    travels: Mapping[tuple[str, float], tuple[float, float]]

    @property
    def travel(self) -> float | None:
        """Largest difference of a stiffness along the ground, sign kept [-]; None where none was asked."""
        return largest(np.array([a / b - 1.0 for a, b in self.travels.values()])) if self.travels else None


def agreement(wheel: ComparedWheel, found: Mapping[str, Any]) -> Agreement:
    """Read a record's ``curves`` (one an orientation) and ``fine``: each has ``deflection_m``, ``fe_N``, ``plates_N``.

    Raises
    ------
    InputError
        Where orientations are missing, or no point of the finer meshes is among the curves'.
    """
    curves = {float(one["orientation_deg"]): one for one in found["curves"]}
    if sorted(curves) != sorted(float(o) for o in wheel.orientations):
        raise InputError("record", wheel.record, "does not have the orientations that are asked", "make it anew")
    apart = {o: _apart(one["plates_N"], one["fe_N"]) for o, one in curves.items()}
    at_deg = max(apart, key=lambda o: float(np.abs(apart[o]).max()))
    k = int(np.abs(apart[at_deg]).argmax())
    every, fine, coarse = np.concatenate(list(apart.values())), found["fine"], curves[float(wheel.fine)]
    points = [np.round(one["deflection_m"], 9) for one in (fine, coarse)]
    _, at_fine, at_coarse = np.intersect1d(*points, return_indices=True)
    if not len(at_fine):
        raise InputError("record", wheel.record, "has finer meshes at other points", "make it anew")
    moved = {
        name: _apart(np.array(fine[name])[at_fine], np.array(coarse[name])[at_coarse]) for name in ("plates_N", "fe_N")
    }
    ends = [float(one["deflection_m"][-1]) for one in curves.values()]
    return Agreement(
        orientations=len(curves),
        ends=(min(ends), max(ends)),
        partial=any(bool(one["partial"]) for one in (*curves.values(), fine)),
        largest=float(apart[at_deg][k]),
        at_deg=at_deg,
        at_m=float(curves[at_deg]["deflection_m"][k]),
        mean=float(np.abs(every).mean()),
        plates_mesh=largest(moved["plates_N"]),
        solid_mesh=largest(moved["fe_N"]),
        finer=largest(_apart(fine["plates_N"], fine["fe_N"])),
        stress=_stress(list(curves.values())),
        stress_finer=_stress([fine]),
        unknowns=_means(found["unknowns"]),
        seconds=_means(found["solve_s"]),
        travels=_travels(wheel, found.get("travels", [])),
    )


def _travels(wheel: ComparedWheel, rows: Sequence[Mapping[str, Any]]) -> dict[tuple[str, float], tuple[float, float]]:
    found = {(str(row["way"]), float(row["orientation_deg"])): (row["plates"], row["fe"]) for row in rows}
    if found and set(found) != {(way.value, float(o)) for way in OVER_GROUND for o in wheel.moved}:
        raise InputError("record", wheel.record, "does not have the travels that are asked", "make it anew")
    if not all(np.isfinite(one) and one > 0.0 for pair in found.values() for one in pair):
        raise ValueError("stiffnesses are numbers above zero")
    return found


def _apart(one: Any, other: Any) -> Array:
    """One over the other, less one; ValueError for loads that are none."""
    both = np.array(one, dtype=float), np.array(other, dtype=float)
    if (
        both[0].shape != both[1].shape
        or both[0].ndim != 1
        or not len(both[0])
        or not all((b > 0.0).all() for b in both)
    ):
        raise ValueError("loads are lists of equal length, all above zero")
    return np.asarray(both[0] / both[1] - 1.0)


def _stress(curves: Sequence[Mapping[str, Any]]) -> float | None:
    found = [float(one["stress_apart"]) for one in curves if one["stress_apart"] is not None]
    return largest(np.array(found)) if found else None


def largest(values: Array) -> float:
    """The value of largest size, its sign kept."""
    return float(values[np.abs(values).argmax()])


def _means(of: Mapping[str, Any]) -> tuple[float, float]:
    return float(np.mean(of["plates"])), float(np.mean(of["fe"]))
