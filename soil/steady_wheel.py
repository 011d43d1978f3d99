"""A wheel that drives steadily on soil: pull, torque and sinkage by the stresses along its contour.

Wong and Reece (1967) have a rigid circle of radius R touch the soil from theta_1 ahead of the lowest point to theta_2
behind it. From theta_1 to theta_m = (c_1 + c_2 s) theta_1 the pressure is that of the soil's depth; behind, it falls
off as it rose, over the angles scaled to reach zero at theta_2. Shear follows from how far the rim has slipped.

The same on a rim that gives way by w(theta) to the pressure on it (`soil.carcass`), with H the height of the hub over
the undisturbed soil:

    x = (R - w) sin(theta),    z = (R - w) cos(theta) - H.

With the arc S and the way X along it from the first contact,

    j = m S - (1 - s) X,    tau = t(p) (1 - exp(-|j| / K)) sign(j),    t(p) of `laws.lug_thrust`,
    load = b int (p dx - tau dz),    pull = b int (tau dx + p dz),    torque = m R b int tau dS,

m = 1 + h / (2 R) with lugs of the height h, whose faces move faster than the rim, else 1. A rigid rim has dS = R
d theta, and these are Wong and Reece's integrals. Of an inextensible rim the torque is that of the power: omega T is
pull times speed and what shear and compaction dissipate. theta_2 is where the soil has come back by its unloading line.
Slip s = 1 - v / (omega R); negative for a towed wheel.

Verified by tests/unit/test_soil_steady_wheel.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from contracts.declared import In, PositiveLength, require_declared
from contracts.errors import InputError
from soil.carcass import RIGID, Carcass, RimShape, shape_under
from soil.contour import Contour, PressureLaw, contour_of, hub_heights, integrated
from soil.laws import lug_lines, lug_thrust, mobilised, slip_sinkage
from soil.soil import Soil

__all__ = ["WheelOnSoil", "WheelState", "standing_rim", "standing_wheel", "steady_wheel", "towed_wheel"]

FloatArray = NDArray[np.float64]
_RELAXED, _MEMORY, _ROUNDS, _SETTLED = 0.5, 4, 100, 1e-8
"""Share of a new shape that is taken, rounds that are mixed, rounds at most, and how far the last moves the shape over
R."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelOnSoil:
    """What of a wheel the soil feels.

    Attributes
    ----------
    radius, width : R and b of the rim [m]
    carcass : how the rim gives way
    lug_height, lugs : of the grousers [m] and their number; 0 for a smooth rim

    Raises
    ------
    InputError
        For a number that is not above zero (lugs: at least zero).
    """

    radius: PositiveLength
    width: PositiveLength
    carcass: Carcass = field(default=RIGID)
    lug_height: Annotated[float, In("m", least=0.0)] = 0.0
    lugs: int = 0

    def __post_init__(self) -> None:
        require_declared(self, "wheel on soil")
        if self.lugs < 0:
            raise InputError("lugs", self.lugs, "must be at least 0", "leave them out")

    @property
    def lug(self) -> tuple[float, float, float]:
        """Height and pitch [m], and 1 if there are lugs, as `laws.lug_lines` takes them."""
        there = self.lugs > 0 and self.lug_height > 0.0
        return self.lug_height, 2.0 * math.pi * self.radius / max(self.lugs, 1), 1.0 if there else 0.0

    @property
    def shear_radius(self) -> float:
        """m R: of the rim, or to the middle of the lugs' faces [m]."""
        return self.radius + 0.5 * self.lug[0] * self.lug[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelState:
    """A wheel that drives, is towed or stands.

    Attributes
    ----------
    slip : s [-]
    load : [N]
    drawbar_pull : > 0 pulls the vehicle [N]
    torque : of the drive [N m]
    sinkage : deepest point of the contour below the surface [m]
    hub_height : H over the undisturbed surface [m]
    deflection : how far the rim gives way below the hub, w(0) [m]
    entry, exit : theta_1 > 0 and theta_2 <= 0 [rad]
    largest_pressure : [Pa]
    efficiency : pull times speed over torque times angular speed [-]; 0 for a wheel that pulls nothing
    """

    slip: float
    load: float
    drawbar_pull: float
    torque: float
    sinkage: float
    hub_height: float
    deflection: float
    entry: float
    exit: float
    largest_pressure: float
    efficiency: float


type _Driven = tuple[float, float] | None
"""Slip, and gravity [m/s^2]; None of a wheel that stands and does not shear."""
_NEAR = 1e-4
"""How far a changed shape moves the hub, about [m]."""


def steady_wheel(wheel: WheelOnSoil, soil: Soil, load: float, slip: float, gravity: float) -> WheelState:
    """The wheel under a load [N] at a slip, on the weight that a gravity [m/s^2] gives the soil.

    Raises
    ------
    InputError
        For a load that is not above zero, that buries the wheel or hardly touches the soil, a slip not in [-4, 1) and a
        gravity below zero.
    """
    if not (math.isfinite(slip) and -4.0 <= slip < 1.0):
        raise InputError("slip", f"{slip:g}", "must lie in [-4, 1)", "0 rolls, 0.2 is usual for a drive", key="slip")
    if not (math.isfinite(gravity) and gravity >= 0.0):
        raise InputError("gravity", f"{gravity:g} m/s^2", "must be at least 0", "Mars has 3.711, Earth 9.81")
    sunk = slip_sinkage(slip) ** soil.slip_sinkage
    top = soil.peak_rolling + soil.peak_slipping * max(slip, 0.0)
    law = PressureLaw(soil.modulus(wheel.width) / sunk**soil.exponent, soil.exponent, top)
    return _state(wheel, soil, law, load, (slip, gravity))[0]


def standing_wheel(wheel: WheelOnSoil, soil: Soil, load: float) -> WheelState:
    """The wheel pressed straight down under a load [N], without shear: the pressure that of the depth everywhere."""
    return standing_rim(wheel, soil, load)[0]


def standing_rim(wheel: WheelOnSoil, soil: Soil, load: float) -> tuple[WheelState, RimShape]:
    """`standing_wheel` with the shape of its rim."""
    return _state(wheel, soil, PressureLaw(soil.modulus(wheel.width), soil.exponent, None), load, None)


def towed_wheel(wheel: WheelOnSoil, soil: Soil, load: float, gravity: float) -> WheelState:
    """The wheel at the slip at which it takes no torque.

    Raises
    ------
    InputError
        As `steady_wheel`, and where it takes torque even while it skids.
    """
    from scipy.optimize import brentq

    def torque(slip: float) -> float:
        return steady_wheel(wheel, soil, load, slip, gravity).torque

    low = -0.05
    while torque(low) > 0.0 and low > -2.0:
        low *= 2.0
    if torque(low) > 0.0:
        rule = "takes torque even where it skids"
        raise InputError("towed wheel", f"{load:g} N on {soil.name}", rule, "give a smaller load", key="load")
    slip = float(brentq(torque, low, 0.0, xtol=1e-10))  # at no slip the rim is longer than its way: torque >= 0
    return steady_wheel(wheel, soil, load, slip, gravity)


def _state(
    wheel: WheelOnSoil, soil: Soil, law: PressureLaw, load: float, driven: _Driven
) -> tuple[WheelState, RimShape]:
    """Shape and pressure that belong together under a load, and what follows."""
    if not (math.isfinite(load) and load > 0.0):
        raise InputError("load of the wheel", f"{load:g} N", "must be above zero", "give e.g. 200 N", key="load")
    wheel = replace(wheel, carcass=wheel.carcass.at(load))
    size = max(len(wheel.carcass.compliance), 1)
    height, shapes, residuals = 0.0, [np.zeros(2 * size)], list[FloatArray]()
    for _ in range(_ROUNDS):
        shape = RimShape(shapes[-1][:size], shapes[-1][size:])
        height, contour = _carried(wheel, soil, law, (shape, load), (driven, height))
        if not wheel.carcass.compliance:
            break
        radial = contour.along * np.cos(contour.angle) - contour.down * np.sin(contour.angle)
        force = wheel.width * contour.pressure * radial * contour.weight
        residuals.append(np.concatenate(shape_under(wheel.carcass, contour.angle, force)) - shapes[-1])
        if np.abs(residuals[-1]).sum() < _SETTLED * wheel.radius:
            break
        shapes.append(_mixed(shapes, residuals))
    else:
        rule = "must find a shape of its rim on this soil"
        raise InputError("flexible wheel", f"{load:g} N on {soil.name}", rule, "give a smaller load", key="load")
    forces = _forces(wheel, soil, contour, driven)
    if forces[0] < (1.0 - _SETTLED) * load:
        rule = f"must be below {forces[0]:.3g} N, where the wheel lies in the soil nearly up to its axle"
        hint = "give firmer soil, a larger wheel or less slip"
        raise InputError("load of the wheel", _on(load, soil, driven), rule, hint, key="load")
    below = float(shape.at(np.zeros(1))[0][0])
    slip = 0.0 if driven is None else driven[0]
    return _told(wheel, contour, (height, below), forces, slip), shape


def _on(load: float, soil: Soil, driven: _Driven) -> str:
    """A load in words."""
    return f"{load:g} N on {soil.name}" + ("" if driven is None else f" at slip {driven[0]:.3g}")


def _mixed(shapes: Sequence[FloatArray], residuals: Sequence[FloatArray]) -> FloatArray:
    """The next shape of the fixed-point iteration, by Anderson's mixing of the last ones."""
    memory = min(_MEMORY, len(residuals) - 1)
    taken, left = shapes[-1], residuals[-1]
    if memory:
        moved = np.column_stack([shapes[-1] - one for one in shapes[-1 - memory : -1]])
        changed = np.column_stack([residuals[-1] - one for one in residuals[-1 - memory : -1]])
        weights = np.linalg.lstsq(changed, left, rcond=1e-10)[0]
        taken, left = taken - moved @ weights, left - changed @ weights
    return np.asarray(taken + _RELAXED * left)


def _carried(
    wheel: WheelOnSoil,
    soil: Soil,
    law: PressureLaw,
    asked: tuple[RimShape, float],
    known: tuple[_Driven, float],
) -> tuple[float, Contour]:
    """Height of the hub at which a rim of a shape carries a load, the lowest if none does, and the contour there.

    known : what drives it and the height found before, 0 if none
    """
    from scipy.optimize import brentq

    (shape, load), (driven, last) = asked, known

    def carried(height: float) -> float:
        return float(_forces(wheel, soil, contour_of(wheel.radius, soil, law, shape, height), driven)[0])

    low, high = hub_heights(wheel.radius, shape)
    if carried(low) < load:
        return low, contour_of(wheel.radius, soil, law, shape, low)
    if (least := carried(high)) > load:
        rule = f"must be above {least:.3g} N, where the wheel hardly touches the soil"
        hint = "give e.g. 200 N, and check the soil's units"
        raise InputError("load of the wheel", _on(load, soil, driven), rule, hint, key="load")
    if low + _NEAR < last < high - _NEAR and carried(last - _NEAR) > load > carried(last + _NEAR):
        low, high = last - _NEAR, last + _NEAR
    height = float(brentq(lambda at: carried(at) - load, low, high, xtol=1e-12, rtol=1e-12))
    return height, contour_of(wheel.radius, soil, law, shape, height)


def _forces(wheel: WheelOnSoil, soil: Soil, contour: Contour, driven: _Driven) -> tuple[float, float, float]:
    """Load [N], pull [N] and torque [N m]."""
    b, p, w = wheel.width, contour.pressure, contour.weight
    if driven is None:
        return b * float((p * contour.along) @ w), 0.0, 0.0
    slip, gravity = driven
    arc = np.hypot(contour.along, contour.down)
    numbers = soil.cohesion, soil.friction_angle, soil.density * gravity, soil.rim_angle
    lines = lug_lines(numbers, wheel.lug, b)
    strength = np.array([lug_thrust(one, *lines) for one in p.tolist()])
    sheared = integrated(contour, wheel.shear_radius / wheel.radius * arc - (1.0 - slip) * contour.along)
    tau = strength * np.array([mobilised(j, soil.shear_modulus)[0] for j in sheared.tolist()])
    return (
        b * float((p * contour.along - tau * contour.down) @ w),
        b * float((tau * contour.along + p * contour.down) @ w),
        wheel.shear_radius * b * float((tau * arc) @ w),
    )


def _told(
    wheel: WheelOnSoil,
    contour: Contour,
    hub: tuple[float, float],
    forces: tuple[float, float, float],
    slip: float,
) -> WheelState:
    """In numbers; ``hub`` is its height and how far the rim gives way below it."""
    load, pull, torque = forces
    works = pull > 0.0 and torque > 0.0
    return WheelState(
        slip=slip,
        load=load,
        drawbar_pull=pull,
        torque=torque,
        sinkage=contour.deepest,
        hub_height=hub[0],
        deflection=hub[1],
        entry=contour.ends[0],
        exit=contour.ends[1],
        largest_pressure=float(contour.pressure.max()),
        efficiency=pull * (1.0 - slip) * wheel.radius / torque if works else 0.0,
    )
