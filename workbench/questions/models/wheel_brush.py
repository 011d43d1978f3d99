"""The brush tire of a wheel: what its curves and its load cases along the ground make of Table II, line by line.

Verified by tests/unit/test_workbench_wheel_brush.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from contracts.curves import Around, StiffnessCurve
from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.travel_curve import TravelCurve
from rover_dynamics.tires.brush_settings import BrushSettings, Carcass, WheelNumbers, wheel_numbers, yielding
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters
from workbench.questions.model_curves import mean_curve

__all__ = ["Line", "WheelBrush", "carcass_of", "lines_beside_table_two", "wheel_brush"]

_LENGTH = "contact_length_m"
_RUBS = "kept: an elastic wheel whose springs touch without friction loses nothing"


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelBrush:
    """What stands in for a wheel under a rover.

    Attributes
    ----------
    load : working load, at which the two are alike [N]
    deflection : of the wheel under it, on the mean of its curves [m]
    tire : its k_r is load over deflection, so that a rover stands as deep; what a wheel that stands does not tell, slip
        stiffnesses, friction, damping and rolling resistance, is as it was given
    carcass : how the standing wheel yields along the ground [N/m]
    tangent : slope of the mean curve there [N/m]
    turning : stiffness of the wheel turned on the spot, mean [N m/rad]; None without such a load case
    contact_length : along the ground there, mean [m]; None where the curves do not tell it
    """

    load: float
    deflection: float
    tire: BrushTireParameters
    carcass: Carcass
    tangent: float
    turning: float | None
    contact_length: float | None

    @property
    def numbers(self) -> WheelNumbers:
        """What the rover's loops read of it."""
        return wheel_numbers(self.tire, yielding(BrushSettings(), self.tire, self.carcass))


class Line(NamedTuple):
    """One parameter [SI] of Table II, or of ours beside it, and of this wheel; None where there is none."""

    name: str
    unit: str
    table: float | None
    wheel: float | None
    how: str

    @property
    def ratio(self) -> float | None:
        """This wheel's over Table II's [-]."""
        return self.wheel / self.table if self.wheel is not None and self.table else None


def wheel_brush(
    curves: Sequence[StiffnessCurve],
    travels: Sequence[TravelCurve],
    load: float,
    given: BrushTireParameters,
    around: Around | None = None,
) -> WheelBrush:
    """The brush tire of a wheel at a working load [N].

    The radial spring is the secant of the mean curve, k_r = N / d(N). Forwards and sideways the tire yields as the
    wheel does at the first step of its load cases, k = dF / ds, through a carcass: bristles of two stiffnesses would
    create energy in loops of partial slip.

    Parameters
    ----------
    curves : of the wheel at some orientations
    travels : of its pressed hub forwards and to the left, at one orientation at least; turned on the spot if wanted
    load : working load [N]
    given : the tire whose other numbers it keeps
    around : how the wheel repeats itself, which weighs the curves; all alike if left out

    Raises
    ------
    InputError
        For curves that do not reach the load, and a wheel that does not resist one way.
    """
    mean = mean_curve(curves, around)
    deflection = mean.deflection_at(load)
    if not deflection > 0.0:
        raise InputError("deflection of the wheel", f"{deflection:g} m", "must be > 0 at the working load", "load it")
    source = f"{curves[0].model} curves and load cases of the wheel at {load:g} N; the rest: {given.source}"
    turned = [one for one in travels if one.way is Way.TURNING]
    return WheelBrush(
        load=load,
        deflection=deflection,
        tire=replace(given, radial_stiffness=load / deflection, source=source),
        carcass=carcass_of(travels),
        tangent=_slope(mean, load),
        turning=float(np.mean([one.stiffness for one in turned])) if turned else None,
        contact_length=_length(curves, load),
    )


def carcass_of(travels: Sequence[TravelCurve]) -> Carcass:
    """Mean stiffness of the wheel forwards and sideways.

    Raises
    ------
    InputError
        If there is no travel one way, or one that does not resist.
    """
    found = {}
    for way in (Way.FORE_AFT, Way.LATERAL):
        stiffness = [one.stiffness for one in travels if one.way is way]
        if not stiffness or not min(stiffness) > 0.0:
            rule = "must be found at one orientation at least, and be > 0 at each"
            raise InputError(f"stiffness {way} of the wheel", f"{stiffness} N/m", rule, "ask for closer points in [fe]")
        found[way] = float(np.mean(stiffness))
    return Carcass(forward=found[Way.FORE_AFT], sideways=found[Way.LATERAL])


def lines_beside_table_two(found: WheelBrush) -> tuple[Line, ...]:
    """Every number of the tire beside Table II's with our settings, and what the load cases tell besides."""
    table, wheel, at = wheel_numbers(THESIS_BRUSH, BrushSettings()), found.numbers, f"at {found.load:g} N"
    slips = "kept: a wheel that stands does not slip"
    ground = "kept: of tire and ground"
    case = f"load case {at}, first step"
    moved = f"{case}; Table II: C_s over our relaxation length"
    length = "slip stiffness over standing stiffness; Table II: ours"
    a, b, bristles = THESIS_BRUSH, found.tire, table.tangential_stiffness
    return (
        Line("radial stiffness", "N/m", a.radial_stiffness, b.radial_stiffness, f"load over mean deflection {at}"),
        Line("radial tangent stiffness", "N/m", a.radial_stiffness, found.tangent, f"{at}; not in the tire"),
        Line("radial damping", "N*s/m", a.radial_damping, b.radial_damping, _RUBS),
        Line("standing stiffness forwards", "N/m", bristles, found.carcass.forward, moved),
        Line("standing stiffness sideways", "N/m", bristles, found.carcass.sideways, moved),
        Line(
            "stiffness turned on the spot",
            "N*m/rad",
            None,
            found.turning,
            f"{case}; not in the tire",
        ),
        Line("longitudinal slip stiffness", "N", a.longitudinal_slip_stiffness, b.longitudinal_slip_stiffness, slips),
        Line("cornering stiffness", "N/rad", a.cornering_stiffness, b.cornering_stiffness, slips),
        Line("relaxation length forwards", "m", table.relaxation_x, wheel.relaxation_x, length),
        Line("relaxation length sideways", "m", table.relaxation_y, wheel.relaxation_y, length),
        Line("friction at full slip", "-", a.friction_min, b.friction_min, ground),
        Line("friction at no slip", "-", a.friction_max, b.friction_max, ground),
        Line("rolling resistance", "-", a.rolling_resistance, b.rolling_resistance, _RUBS),
        Line(
            "contact length",
            "m",
            2.0 * table.half_length,
            found.contact_length,
            f"{at}; not in the tire",
        ),
    )


def _slope(curve: StiffnessCurve, load: float) -> float:
    """Of the piece of a curve that reaches a load [N/m]."""
    i = int(np.flatnonzero(curve.load >= load)[0])
    return float((curve.load[i] - curve.load[i - 1]) / (curve.deflection[i] - curve.deflection[i - 1]))


def _length(curves: Sequence[StiffnessCurve], load: float) -> float | None:
    """Mean length of the contact under a load [m]."""
    loaded = [one for one in curves if not one.unloaded]
    if any(_LENGTH not in one.columns for one in loaded):
        return None
    return float(np.mean([np.interp(one.deflection_at(load), one.deflection, one.columns[_LENGTH]) for one in loaded]))
