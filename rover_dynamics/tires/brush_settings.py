"""What the brush tire's force needs beyond Table II, and all of it as the numbers compiled loops read."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import IntEnum
from typing import NamedTuple

from contracts.errors import InputError
from rover_dynamics.tires.brush_tire import BrushTireParameters
from rover_dynamics.tires.wheel_potential import NO_POTENTIAL, WheelPotential

__all__ = ["BrushSettings", "Carcass", "DamperLaw", "SlipLaw", "WheelNumbers", "wheel_numbers", "yielding"]


class SlipLaw(IntEnum):
    """Steady slip law."""

    BRUSH = 0
    """Brush with parabolic pressure; the friction force never exceeds the friction circle."""
    FIALA = 1
    """Fiala's law, whose names Table II uses; longitudinal and lateral force each reach the friction limit."""
    CARCASS = 2
    """A carcass that yields in proportion to the force while its tread sticks, up to the friction circle."""


class DamperLaw(IntEnum):
    """Radial damper, with the deflection d and its rate; the force is never tensile in either."""

    BUILDS_UP = 0
    """max(0, k d + c d_dot ramp(d / d_0)): no force at first touch."""
    AS_PRINTED = 1
    """max(0, k d + c d_dot) while d > 0, as Table II prints it: c times the speed at first touch."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BrushSettings:
    """Choices for the brush tire that Table II leaves open.

    Attributes
    ----------
    wheel_radius, wheel_width : [m]
    slip_law, damper_law : see `SlipLaw` and `DamperLaw`
    damping_ramp : d_0, deflection at which the damper has built up [m]; a fifth of the static one on Mars
    relaxation_length : sigma_x, longitudinal [m]. Bristles are as stiff forward as k_x = C_s / sigma_x
    lateral_ratio : k_y / k_x, how stiff they are sideways [-]; the lateral length is sigma_y = C_alpha / k_y.
        Other than 1 for a carcass only: the brush's bristles would then create energy in loops of partial slip
    contact_half_length : a, half the length of the patch, for the brush's aligning moment [m]
    retardation_time : tau of the bristles, which damps oscillations at standstill and nothing in steady rolling [s]
    touch_depth : deflection over which the bristles' rate goes over from fading to that of the contact [m]
    potential : of a wheel that carries differently on every orientation; k_r is only its mean then
    standstill_speed : below it the wheel counts as standing for friction falling with slip, and the rolling
        resistance passes smoothly through zero [m/s]

    Raises
    ------
    InputError
        For a number that is not finite or not above zero.

    Verified by tests/unit/test_brush_settings.py.
    """

    wheel_radius: float = 0.1425
    wheel_width: float = 0.120
    slip_law: SlipLaw = SlipLaw.BRUSH
    damper_law: DamperLaw = DamperLaw.BUILDS_UP
    damping_ramp: float = 0.005
    relaxation_length: float = 0.03
    lateral_ratio: float = 1.0
    contact_half_length: float = 0.03
    retardation_time: float = 0.005
    standstill_speed: float = 0.001
    touch_depth: float = 1e-4
    potential: WheelPotential | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name in (
            "wheel_radius",
            "wheel_width",
            "damping_ramp",
            "relaxation_length",
            "contact_half_length",
            "touch_depth",
        ):
            _positive(name, getattr(self, name), "m")
        _positive("lateral_ratio", self.lateral_ratio, "-")
        if self.lateral_ratio != 1.0 and self.slip_law is not SlipLaw.CARCASS:
            rule = f"must be 1 for the slip law {self.slip_law.name.lower()}"
            raise InputError("brush lateral ratio", f"{self.lateral_ratio:g}", rule, "take the carcass")
        _positive("retardation_time", self.retardation_time, "s")
        _positive("standstill_speed", self.standstill_speed, "m/s")


class Carcass(NamedTuple):
    """How stiffly a wheel that sticks to the ground holds its hub, forwards and sideways [N/m]."""

    forward: float
    sideways: float


def yielding(settings: BrushSettings, parameters: BrushTireParameters, carcass: Carcass) -> BrushSettings:
    """The same on a carcass that gives way to a force as it says while the tread sticks.

    Rolling steadily the tire slips as before: relaxation lengths are slip stiffness over stiffness,
    sigma_x = C_s / k_x and sigma_y = C_alpha / k_y.

    Verified by tests/unit/test_workbench_wheel_brush.py.
    """
    return replace(
        settings,
        slip_law=SlipLaw.CARCASS,
        relaxation_length=parameters.longitudinal_slip_stiffness / carcass.forward,
        lateral_ratio=carcass.sideways / carcass.forward,
    )


class WheelNumbers(NamedTuple):
    """All numbers of a wheel [SI], as `BrushTireParameters` and `BrushSettings` define them.

    ``damping_ramp`` is 0 for the damper as printed, ``lever_to_rim`` 1 for the wheel's radius as lever of the tractive
    force and 0 for the loaded one, ``law`` the value of `SlipLaw`; ``potential`` stands for the radial stiffness
    where it has pieces.
    """

    radius: float
    width: float
    radial_stiffness: float
    radial_damping: float
    damping_ramp: float
    friction_min: float
    friction_max: float
    rolling_resistance: float
    tangential_stiffness: float
    lateral_ratio: float
    relaxation_x: float
    relaxation_y: float
    half_length: float
    retardation_time: float
    standstill_speed: float
    touch_depth: float
    lever_to_rim: float
    law: float
    potential: WheelPotential


def wheel_numbers(parameters: BrushTireParameters, settings: BrushSettings) -> WheelNumbers:
    """Everything the compiled loops read of one kind of wheel.

    Verified by tests/unit/test_brush_settings.py.
    """
    stiffness = parameters.longitudinal_slip_stiffness / settings.relaxation_length
    return WheelNumbers(
        radius=settings.wheel_radius,
        width=settings.wheel_width,
        radial_stiffness=parameters.radial_stiffness,
        radial_damping=parameters.radial_damping,
        damping_ramp=settings.damping_ramp if settings.damper_law is DamperLaw.BUILDS_UP else 0.0,
        friction_min=parameters.friction_min,
        friction_max=parameters.friction_max,
        rolling_resistance=parameters.rolling_resistance,
        tangential_stiffness=stiffness,
        lateral_ratio=settings.lateral_ratio,
        relaxation_x=settings.relaxation_length,
        relaxation_y=parameters.cornering_stiffness / (settings.lateral_ratio * stiffness),
        half_length=settings.contact_half_length,
        retardation_time=settings.retardation_time,
        standstill_speed=settings.standstill_speed,
        touch_depth=settings.touch_depth,
        lever_to_rim=1.0 if parameters.lever == "radius" else 0.0,
        law=float(settings.slip_law),
        potential=NO_POTENTIAL if settings.potential is None else settings.potential,
    )


def _positive(name: str, value: float, unit: str) -> None:
    if not (math.isfinite(value) and value > 0.0):
        what = f"brush {name.replace('_', ' ')}"
        raise InputError(what, f"{value:g} {unit}", "must be finite and > 0", "leave it at its default")
