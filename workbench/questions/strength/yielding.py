"""Stress against yield along a curve: utilisation of each part, peak stress at a load, load at first yield.

Strips are judged by their stress linearised through the thickness, one thickness from every joint and four from free
edges: the elastic stress at a weld's end has no limit under refinement. What is no strip (grousers, hubs) has its
largest von Mises stress. A part that flows is judged alike: its linearised stress grows with the moment, to one and a
half times yield where the whole thickness flows; a part without lines comes to its limit where it begins to flow.

Verified by tests/unit/test_workbench_yielding.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.model_curves import ModelCurves

__all__ = [
    "FirstYield",
    "PeakStress",
    "StrengthResults",
    "first_yield",
    "judged_stress",
    "largest_utilisation",
    "peak_stresses",
    "plastic_strain",
    "smallest_yield_load",
    "utilisation",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstYield:
    """Where the stress that is judged first reaches yield on a curve.

    Attributes
    ----------
    load, deflection : where it happens [N, m]; the curve's end if it does not
    part : the part that yields; None if none does
    """

    load: float
    deflection: float
    part: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class PeakStress:
    """Stress of a part that is held against its yield strength, at a load.

    Attributes
    ----------
    load, deflection : where on the curve [N, m]
    part : name of the part
    stress : the one that is judged [Pa], see `judged_stress`
    used : that stress over yield strength, see `utilisation` [-]
    strength : yield strength [Pa]
    local : largest von Mises stress anywhere in the part [Pa], which near a weld's end has no limit under refinement;
        the judged one of a curve that has no other
    """

    load: float
    deflection: float
    part: str
    stress: float
    used: float
    strength: float
    local: float


def peak_stresses(curve: StiffnessCurve, yield_strength: Mapping[str, float], load: float) -> list[PeakStress]:
    """Peak stress of each part that has a stress column, at a load [N], interpolated linearly between increments.

    Raises
    ------
    InputError
        If the curve does not reach the load.
    """
    there, found = _up_to(curve, load), []
    for part, used in utilisation(there, yield_strength).items():
        judged = judged_stress(there, part)
        assert judged is not None
        one = PeakStress(
            load=load,
            deflection=float(there.deflection[-1]),
            part=part,
            stress=float(judged[-1]),
            used=float(used[-1]),
            strength=yield_strength[part],
            local=float(there.columns.get(f"max_von_mises_{part}_Pa", judged)[-1]),
        )
        found.append(one)
    return found


def _up_to(curve: StiffnessCurve, load: float) -> StiffnessCurve:
    """The curve up to a load [N] and there, linear between increments; InputError if it does not reach it."""
    end = curve.deflection_at(load)
    deflection = np.append(curve.deflection[curve.deflection < end], end)
    columns = {name: np.interp(deflection, curve.deflection, column) for name, column in curve.columns.items()}
    loads = np.interp(deflection, curve.deflection, curve.load)
    return replace(curve, deflection=deflection, load=loads, columns=columns, partial=True)


def plastic_strain(curve: StiffnessCurve, part: str) -> NDArray[np.float64] | None:
    """Largest equivalent plastic strain of a part at each point of the curve [-]; None where it does not flow."""
    strain = curve.columns.get(f"max_plastic_strain_{part}")
    return strain if strain is not None and strain.any() else None


def judged_stress(curve: StiffnessCurve, part: str) -> NDArray[np.float64] | None:
    """The stress [Pa] of a part that is held against yield, at each point of the curve; None for one without stress.

    Linearised through the thickness where the part has lines for it, the largest von Mises stress else.
    """
    linearised = curve.columns.get(f"max_linearised_{part}_Pa")
    return linearised if linearised is not None and linearised.any() else curve.columns.get(f"max_von_mises_{part}_Pa")


def utilisation(
    curve: StiffnessCurve, yield_strength: Mapping[str, float], allowed: float = 1.0
) -> dict[str, NDArray[np.float64]]:
    """Stress that is judged over yield strength at each point of the curve, by part that has a stress [-].

    At least 1 where a part without lines has flowed; as many times as ``allowed`` [-].
    """
    found = {}
    for part, strength in yield_strength.items():
        stress, strain = judged_stress(curve, part), plastic_strain(curve, part)
        if stress is not None:
            used = stress / strength
            if strain is not None and stress is curve.columns.get(f"max_von_mises_{part}_Pa"):
                used = np.maximum(used, strain > 0.0)
            found[part] = used / allowed
    return found


def first_yield(curve: StiffnessCurve, yield_strength: Mapping[str, float], allowed: float = 1.0) -> FirstYield:
    """First point at which any part comes to its limit, see `utilisation`, linear between increments."""
    found = FirstYield(load=float(curve.load.max()), deflection=float(curve.deflection[-1]), part=None)
    for part, used in utilisation(curve, yield_strength, allowed).items():
        above = np.flatnonzero(used >= 1.0)
        if not len(above):
            continue
        i = int(above[0])
        fraction = 1.0 if i == 0 else (1.0 - used[i - 1]) / (used[i] - used[i - 1])
        deflection, load = (
            float(y[max(i - 1, 0)] + fraction * (y[i] - y[max(i - 1, 0)])) for y in (curve.deflection, curve.load)
        )
        if found.part is None or deflection < found.deflection:
            found = FirstYield(load=load, deflection=deflection, part=part)
    return found


def largest_utilisation(
    curve: StiffnessCurve, yield_strength: Mapping[str, float], up_to: float, allowed: float = 1.0
) -> float:
    """Largest `utilisation` of any part, up to a load [N] and there, linear between increments [-].

    Raises
    ------
    InputError
        If the curve does not reach the load, or no part has a stress.
    """
    found = utilisation(_up_to(curve, up_to), yield_strength, allowed)
    if not found:
        raise InputError("curve", curve.model, "has no stress of any part", "compute it with stresses")
    return max(float(used.max()) for used in found.values())


def smallest_yield_load(found: Sequence[FirstYield], needed: float) -> float:
    """Smallest load at first yield [N]; where nothing yields, the curve's largest load counts.

    Raises
    ------
    InputError
        If a curve ends below the load ``needed`` [N] without yielding, and none yields below it: then it is not known.
    """
    load = min(y.load for y in found if y.part is not None) if any(y.part for y in found) else float("inf")
    end = min((y.load for y in found if y.part is None), default=float("inf"))
    if load >= needed > end:
        rule = f"ends before {needed:g} N without yielding"
        raise InputError("curve", f"{end:.4g} N", rule, "raise fe.max_deflection or fe.max_load")
    return min(load, end)


@dataclass(frozen=True, slots=True, kw_only=True)
class StrengthResults:
    """FE curves, yield strengths by part that is stressed [Pa], first yield by orientation [deg] and by part.

    ``uncertainty`` : of the stress, by the mesh study [-]; None where it is not known. Parts without yield strength
    are ``unjudged``.

    Orientations of which no point converged are ``missing`` [deg], and have no first yield.
    """

    fe: ModelCurves
    yield_strength: Mapping[str, float]
    uncertainty: float | None
    unjudged: tuple[str, ...]
    by_orientation: Mapping[float, FirstYield]
    by_part: Mapping[str, tuple[float, FirstYield]]

    @property
    def curves(self) -> Mapping[float, StiffnessCurve]:
        """Those with a point behind first contact, by orientation [deg]."""
        return self.fe.loaded

    @property
    def linearised(self) -> frozenset[str]:
        """Parts judged by their linearised stress."""
        first = next(iter(self.curves.values()), None)
        columns = first.columns if first is not None else {}
        return frozenset(p for p in self.yield_strength if np.any(columns.get(f"max_linearised_{p}_Pa", 0.0)))

    @property
    def flows(self) -> dict[str, tuple[float, float]]:
        """Part that flows -> load [N] up to which no orientation flows, and largest plastic strain of any point [-]."""
        found: dict[str, tuple[float, float]] = {}
        for curve in self.curves.values():
            for part in self.yield_strength:
                if (strain := plastic_strain(curve, part)) is not None:
                    begins = float(curve.load[max(0, int(np.flatnonzero(strain)[0]) - 1)])
                    least, most = found.get(part, (math.inf, 0.0))
                    found[part] = min(least, begins), max(most, float(strain.max()))
        return found

    @property
    def missing(self) -> tuple[float, ...]:
        """Orientations [deg] of which no point converged."""
        return tuple(self.fe.missing)
