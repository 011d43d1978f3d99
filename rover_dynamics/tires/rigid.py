"""A rigid wheel: the brush tire with a radial contact so stiff that the rim keeps its radius.

Rigid means here: 1000 times the radial stiffness of Table II whatever that of the tire it is made of, unless that is
more still (24 micrometres at rest under 197.92 N on Mars instead of 24 mm), with a damper of 5 ms, critical for a sixth
of the rover. Friction, slip stiffnesses and rolling resistance stay the tire's own, so that the two differ by the
radial deflection only; the deflections over which damper and bristles build up shrink as the stiffness grows. A carcass
is none of a rigid wheel's: it has the bristles of the brush.

Verified by tests/verification/test_rover_rigid.py.
"""

from __future__ import annotations

from dataclasses import replace

from contracts.terrain import Terrain
from rover_dynamics.tires.brush_settings import BrushSettings, SlipLaw
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters
from rover_dynamics.tires.brush_wheel import BrushTire

__all__ = ["RigidTire", "rigid_parameters", "rigid_settings"]

TIMES_STIFFER = 1e3
DAMPING_TIME = 5e-3
"""c / k [s]; critical for 53.3 kg on 8.25 MN/m, 2 sqrt(m / k)."""


def rigid_parameters(parameters: BrushTireParameters = THESIS_BRUSH) -> BrushTireParameters:
    """The same friction on a radial contact that hardly gives way."""
    stiffness = max(TIMES_STIFFER * THESIS_BRUSH.radial_stiffness, parameters.radial_stiffness)
    return replace(
        parameters,
        radial_stiffness=stiffness,
        radial_damping=DAMPING_TIME * stiffness,
        source=f"{parameters.source}; rigid: radially {stiffness:g} N/m",
    )


def rigid_settings(settings: BrushSettings | None = None) -> BrushSettings:
    """Damper and bristles build up over deflections as much smaller as the contact is stiffer."""
    settings = settings or BrushSettings()
    if settings.slip_law is SlipLaw.CARCASS:
        length = BrushSettings().relaxation_length
        settings = replace(settings, slip_law=SlipLaw.BRUSH, relaxation_length=length, lateral_ratio=1.0)
    return replace(
        settings,
        damping_ramp=settings.damping_ramp / TIMES_STIFFER,
        touch_depth=settings.touch_depth / TIMES_STIFFER,
        potential=None,
    )


class RigidTire(BrushTire):
    """One rigid wheel as `contracts.tire.Tire`.

    Parameters
    ----------
    terrain : the ground
    parameters, settings : of the tire whose friction it has

    Verified by tests/verification/test_rover_rigid.py.
    """

    def __init__(
        self,
        terrain: Terrain,
        parameters: BrushTireParameters = THESIS_BRUSH,
        settings: BrushSettings | None = None,
    ) -> None:
        super().__init__(terrain, rigid_parameters(parameters), rigid_settings(settings))
