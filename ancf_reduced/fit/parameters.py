"""What may be free in an ANCF tire when it is fitted: each parameter with its bounds, and the preset that has a value.

Positive parameters are fitted in their logarithm, so that steps, sensitivities and confidence intervals are relative.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.mass import flexible_mass
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import TirePreset
from contracts.errors import InputError

__all__ = ["FreeParameter", "Parameter", "preset_at", "unknowns_of", "with_mass"]

FloatArray = NDArray[np.float64]


class Parameter(StrEnum):
    """A number of the preset, or two that are held equal."""

    YOUNG_MODULUS = "young_modulus"
    THICKNESS = "thickness"
    """Of rim and spokes, one value."""
    RIM_THICKNESS = "rim_thickness"
    SPOKE_THICKNESS = "spoke_thickness"
    HUB_RADIUS = "hub_radius"
    OUTER_RADIUS = "outer_radius"
    """Of the outer face at the nodes; deflection counts from the preset's datum radius, which stays."""
    CONTACT_STIFFNESS = "contact_stiffness"
    PHASE = "phase"
    """Where the first spoke stands; the one parameter that may be zero or negative."""

    @property
    def fields(self) -> tuple[str, ...]:
        """The preset's fields that it sets."""
        return ("rim_thickness", "spoke_thickness") if self is Parameter.THICKNESS else (self.value,)

    @property
    def unit(self) -> str:
        """SI unit."""
        return {"young_modulus": "Pa", "contact_stiffness": "N/m", "phase": "rad"}.get(self.value, "m")

    @property
    def is_relative(self) -> bool:
        """Whether it is fitted in its logarithm."""
        return self is not Parameter.PHASE

    def of(self, preset: TirePreset) -> float:
        """Its value in a preset [own unit]; that of the rim for one thickness of both."""
        return float(getattr(preset, self.fields[0]))

    def unknown(self, value: float) -> float:
        """The unknown of the fit: the logarithm of ``value``, or the phase itself [-, rad]."""
        return math.log(value) if self.is_relative else value

    def value_at(self, unknown: float) -> float:
        """The value [own unit] of an unknown [-, rad]: the inverse of `unknown`."""
        return math.exp(unknown) if self.is_relative else unknown

    def slope(self, value: float) -> float:
        """d value / d unknown [own unit]."""
        return value if self.is_relative else 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeParameter:
    """A parameter and its bounds, SI.

    Raises
    ------
    InputError
        For bounds that are not finite, not in order, or not above zero where the parameter is.

    Verified by tests/unit/test_ancf_fit_inputs.py.
    """

    parameter: Parameter
    lower: float
    upper: float

    def __post_init__(self) -> None:
        good = math.isfinite(self.lower) and math.isfinite(self.upper) and self.lower < self.upper
        if not good or (self.parameter.is_relative and self.lower <= 0.0):
            shown = f"{self.lower:g}..{self.upper:g} {self.parameter.unit}"
            rule = "must be finite and increase" + (", above zero" if self.parameter.is_relative else "")
            raise InputError(f"bounds of {self.parameter}", shown, rule, "give the lower one first")


def unknowns_of(preset: TirePreset, free: Sequence[FreeParameter]) -> FloatArray:
    """The fit's unknowns (n_free,) at a preset, inside the bounds or not."""
    return np.array([p.parameter.unknown(p.parameter.of(preset)) for p in free])


def preset_at(preset: TirePreset, free: Sequence[FreeParameter], unknowns: FloatArray) -> TirePreset:
    """The preset with the free parameters at the unknowns (n_free,); raises InputError where the tire is impossible."""
    changes: dict[str, float] = {}
    for p, unknown in zip(free, unknowns.tolist(), strict=True):
        changes |= dict.fromkeys(p.parameter.fields, p.parameter.value_at(unknown))
    return replace(preset, **changes)  # type: ignore[arg-type]


def with_mass(preset: TirePreset, mass: float) -> TirePreset:
    """The preset with the density that gives its plates a mass [kg]; statics without gravity does not depend on it.

    Verified by tests/unit/test_ancf_fit_inputs.py.
    """
    if not (math.isfinite(mass) and mass > 0.0):
        raise InputError("mass", f"{mass:g} kg", "must be finite and > 0", "4.44 kg is the thesis' wheel")
    return replace(preset, density=preset.density * mass / flexible_mass(build_tire(preset).model))
