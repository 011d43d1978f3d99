"""Elastic materials as numbers with their source."""

from __future__ import annotations

import math
from dataclasses import dataclass

from contracts.errors import InputError

__all__ = ["SPRING_STEEL", "TI_6AL_4V", "Material"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """Isotropic elastic material at one temperature.

    Attributes
    ----------
    name : name as printed in reports
    young_modulus : E > 0 [Pa]
    poisson_ratio : nu, -1 < nu < 0.5 [-]
    density : rho > 0 [kg/m^3]
    yield_strength : R_p0.2 > 0 [Pa]
    source : where the numbers come from

    Raises
    ------
    InputError
        For a value that is not finite or out of its range.

    Verified by tests/unit/test_materials.py.
    """

    name: str
    young_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float
    source: str

    def __post_init__(self) -> None:
        for what, value, unit in (
            ("young modulus", self.young_modulus, "Pa"),
            ("density", self.density, "kg/m^3"),
            ("yield strength", self.yield_strength, "Pa"),
        ):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{self.name}: {what}", f"{value:g} {unit}", "must be finite and > 0", "check the unit"
                )
        if not -1.0 < self.poisson_ratio < 0.5:
            raise InputError(
                f"{self.name}: poisson ratio",
                f"{self.poisson_ratio:g}",
                "must lie in (-1, 0.5)",
                "metals have about 0.3",
            )

    @property
    def lame_lambda(self) -> float:
        """First Lame parameter lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa]."""
        E, nu = self.young_modulus, self.poisson_ratio
        return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

    @property
    def lame_mu(self) -> float:
        """Shear modulus mu = E / (2 (1 + nu)) [Pa]."""
        return self.young_modulus / (2.0 * (1.0 + self.poisson_ratio))


TI_6AL_4V = Material(
    name="Ti-6Al-4V",
    young_modulus=113.8e9,
    poisson_ratio=0.342,
    density=4430.0,
    yield_strength=880.0e6,
    source="MatWeb/ASM data sheet, Ti-6Al-4V grade 5 annealed, 20 C",
)
SPRING_STEEL = Material(
    name="spring steel",
    young_modulus=206.0e9,
    poisson_ratio=0.3,
    density=7850.0,
    yield_strength=1300.0e6,
    source="EN 10270-1 (E 206 GPa); yield of hardened and tempered strip, typical",
)
