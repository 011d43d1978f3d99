"""The thesis' brush-type tire (Table II): its parameters and its static radial line.

The brush stands for the whole wheel by one radial spring, so that its static curve is the straight line
F = k_r d for d > 0, the same at every orientation. The slip laws that use the remaining parameters belong to the
rover's tire force, not to the static curve.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.declared import In, PositiveStiffness, require_declared
from contracts.errors import InputError

__all__ = [
    "THESIS_BRUSH",
    "BrushTireParameters",
    "Lever",
    "line_source",
    "radial_load",
    "stiffness_curve",
    "with_friction",
]


type Lever = Literal["radius", "loaded"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BrushTireParameters:
    """Parameters of the brush-type tire, in SI.

    The names are those of a Fiala tire. Table II prints the two slip stiffnesses in N/m^2 and N/(deg m^2), which fit
    neither a Fiala slip stiffness (a force per unit slip) nor a bristle stiffness (N/m^3). We read them as N per unit
    slip and N per degree; the lateral one is held in N/rad.

    Attributes
    ----------
    radial_stiffness : k_r > 0, ground on hub, per radial deflection [N/m]
    radial_damping : c_r >= 0 [N s/m]
    longitudinal_slip_stiffness : C_s > 0, force per unit slip ratio at zero slip [N]
    cornering_stiffness : C_alpha > 0, lateral force per slip angle at zero slip [N/rad]
    friction_min : friction coefficient at full slip, 0 < friction_min <= friction_max [-]
    friction_max : friction coefficient at zero slip [-]
    rolling_resistance : rolling resistance coefficient >= 0 [-]; resistance moment per load and loaded radius
    source : where the numbers come from
    lever : of the tractive force about the hub: the wheel's radius, or the loaded one, less by the deflection; no
        source says which, and the rolling radius is the wheel's in both

    Raises
    ------
    InputError
        For a value that is not finite or out of its range, and another lever.

    Verified by tests/unit/test_brush_tire.py.
    """

    radial_stiffness: PositiveStiffness
    radial_damping: Annotated[float, In("N*s/m", least=0.0)]
    longitudinal_slip_stiffness: Annotated[float, In("N", above=0.0)]
    cornering_stiffness: Annotated[float, In("N/rad", above=0.0)]
    friction_min: Annotated[float, In("", above=0.0)]
    friction_max: Annotated[float, In("", above=0.0)]
    rolling_resistance: Annotated[float, In("", least=0.0)]
    source: str
    lever: Lever = "radius"

    def __post_init__(self) -> None:
        require_declared(self, "brush")
        if self.lever not in get_args(Lever.__value__):
            hint = 'give "radius" or "loaded"'
            raise InputError("brush lever", repr(self.lever), "is not known", hint, key="lever")
        if self.friction_max < self.friction_min:
            rule = f"must not be below friction_min, {self.friction_min:g}"
            raise InputError(
                "brush friction max", f"{self.friction_max:g}", rule, "exchange the two values", key="friction_max"
            )

    def lever_at(self, radius: float, deflection: float) -> float:
        """Lever of the tractive force [m] of a wheel of this radius [m] at a radial deflection [m]."""
        return radius if self.lever == "radius" else radius - deflection


THESIS_BRUSH = BrushTireParameters(
    radial_stiffness=8250.0,
    radial_damping=8140.0,
    longitudinal_slip_stiffness=8250.0,
    cornering_stiffness=850.0 * 180.0 / math.pi,
    friction_min=0.597,
    friction_max=0.757,
    rolling_resistance=0.015,
    source="Samarini 2020, Table II",
)
"""Table II as printed; the slip stiffnesses read as N and N/deg (see BrushTireParameters)."""


def with_friction(parameters: BrushTireParameters, friction: float | None) -> BrushTireParameters:
    """The same tire on ground of one coefficient of friction [-], mu(s) = friction at every slip; None leaves its own.

    Table II's two numbers are one ground's coefficient at full slip and at none; Coulomb's law has one for both.

    Verified by tests/unit/test_brush_tire.py.
    """
    return parameters if friction is None else replace(parameters, friction_min=friction, friction_max=friction)


def radial_load(parameters: BrushTireParameters, deflection: NDArray[np.float64]) -> NDArray[np.float64]:
    """Static load of the ground on the wheel, F = k_r max(d, 0): never tensile.

    Parameters
    ----------
    parameters : the tire
    deflection : any shape, radial deflection, positive in compression, negative for an open gap [m]

    Returns
    -------
    load : same shape, positive in compression [N]

    Verified by tests/unit/test_brush_tire.py.
    """
    return parameters.radial_stiffness * np.maximum(deflection, 0.0)


def stiffness_curve(parameters: BrushTireParameters, max_deflection: float, points: int = 71) -> StiffnessCurve:
    """Static stiffness curve of the brush tire from first contact to ``max_deflection``.

    Parameters
    ----------
    parameters : the tire
    max_deflection : last deflection > 0 [m]
    points : number of points >= 2, equally spaced; a line needs no more, plots and averages like them

    Returns
    -------
    curve : ``model="brush"`` and no orientation, because the brush has none

    Raises
    ------
    InputError
        If ``max_deflection`` or ``points`` breaks its rule.

    Verified by tests/unit/test_brush_tire.py.
    """
    if not (math.isfinite(max_deflection) and max_deflection > 0.0):
        raise InputError("brush max deflection", f"{max_deflection * 1e3:g} mm", "must be finite and > 0", "try 35 mm")
    if points < 2:
        raise InputError("brush curve points", points, "must be 2 or more", "leave it at its default")
    deflection = np.linspace(0.0, max_deflection, points)
    return StiffnessCurve(
        model="brush",
        orientation_deg=None,
        deflection=deflection,
        load=radial_load(parameters, deflection),
        source=line_source(parameters),
    )


def line_source(parameters: BrushTireParameters) -> str:
    """What the static line is, and where its parameters come from."""
    return f"radial line of the brush tire, {parameters.radial_stiffness:g} N/m ({parameters.source})"
