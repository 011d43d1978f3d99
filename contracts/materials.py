"""Materials as numbers with their source."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from contracts.declared import In, PositiveDensity, PositivePressure, require_declared
from contracts.errors import InputError
from contracts.material_laws import J2Plasticity, Law, MooneyRivlin, Ogden
from contracts.materials_temperature import REFERENCE_TEMPERATURE, temperature_data

__all__ = ["AISI_301", "SPRING_STEEL", "TI_6AL_4V", "TI_6AL_4V_AGED", "Material"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """Isotropic material at one temperature.

    Attributes
    ----------
    name : name as printed in reports
    young_modulus : E > 0 [Pa], of rubber that of its law at small strain
    poisson_ratio : nu, -1 < nu < 0.5 [-], of rubber that of its law at small strain
    density : rho > 0 [kg/m^3]
    yield_strength : R_p0.2 > 0 [Pa]; left out for what does not yield, such as rubber
    source : where the numbers come from
    temperature_data : name of its data in `contracts.materials_temperature`; None if its change is not known
    temperature : temperature of these values [K]
    thermal_strain : relative change of length from 20 C, free of stress [-]
    law : how stress follows from deformation; None is the law that the solver is asked for elsewhere

    Raises
    ------
    InputError
        For a value that is not finite or out of its range, or a law that does not go with the others.

    Verified by tests/unit/test_materials.py.
    """

    name: str
    young_modulus: PositivePressure
    poisson_ratio: Annotated[float, In("", above=-1.0, below=0.5)]
    density: PositiveDensity
    yield_strength: PositivePressure | None
    source: str
    temperature_data: str | None = None
    temperature: Annotated[float, In("K", above=0.0)] = REFERENCE_TEMPERATURE
    thermal_strain: Annotated[float, In("", above=-1.0)] = 0.0
    law: Law | None = None

    def __post_init__(self) -> None:
        if self.temperature_data is not None:
            temperature_data(self.temperature_data)
        require_declared(self, f"{self.name}:")
        if isinstance(self.law, J2Plasticity) and self.yield_strength is None:
            hint = "give it, or take another law"
            raise InputError(
                f"{self.name}: yield strength", "", "is where plasticity begins", hint, key="yield_strength"
            )
        self._require_hardening()
        if self.temperature_data is not None and isinstance(self.law, MooneyRivlin | Ogden):
            rule = "has no temperature data: there are those of metals alone, and its law is of rubber"
            what = f"{self.name}:"
            raise InputError(what, self.temperature_data, rule, "leave temperature_data out", key="temperature_data")

    def _require_hardening(self) -> None:
        """Refuse plasticity whose saturating part goes down from the yield strength."""
        saturation = self.law.saturation_stress if isinstance(self.law, J2Plasticity) else None
        if saturation is not None and self.yield_strength is not None and saturation < self.yield_strength:
            rule = f"lies below yield_strength = {1e-6 * self.yield_strength:g} MPa: the metal would soften"
            value, hint = f"{1e-6 * saturation:g} MPa", "give what its stress tends to, or a lower strength"
            raise InputError(f"{self.name}:", value, rule, hint, key="law.saturation_stress")

    def at(self, temperature: float) -> Material:
        """The material at another temperature [K], from its values at 20 C and its temperature data.

        Poisson's ratio and density stay (the mesh, and with it the mass, is that at 20 C). Without a source for the
        yield strength it stays too; `temperature_data(name).yield_ratio` is then None.

        Raises
        ------
        InputError
            Without temperature data, outside their range, or if these values are not those of 20 C.
        """
        if self.temperature_data is None:
            rule = "has no temperature data"
            raise InputError("material", self.name, rule, 'give temperature_data = "Ti-6Al-4V" or "AISI 301"')
        if self.temperature != REFERENCE_TEMPERATURE:
            rule = "must be that at 20 C, from which the data count"
            raise InputError("material", f"{self.name} at {self.temperature:g} K", rule, "start from 20 C")
        data, law, strength = temperature_data(self.temperature_data), self.law, self.yield_strength
        yielding = 1.0 if data.yield_ratio is None else data.yield_ratio.at(temperature)
        return replace(
            self,
            young_modulus=self.young_modulus * data.modulus_ratio.at(temperature),
            yield_strength=None if strength is None else strength * yielding,
            law=law.scaled(yielding) if isinstance(law, J2Plasticity) else law,
            temperature=temperature,
            thermal_strain=data.thermal_strain.at(temperature),
        )

    @property
    def thermal_stretch(self) -> float:
        """Length over length at 20 C, free of stress [-]."""
        return 1.0 + self.thermal_strain

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
    temperature_data="Ti-6Al-4V",
)
TI_6AL_4V_AGED = replace(
    TI_6AL_4V,
    yield_strength=1100.0e6,
    source="MatWeb/ASM data sheets, Ti-6Al-4V grade 5, 20 C: modulus annealed, strength solution treated and aged",
)
AISI_301 = Material(
    name="AISI 301 full hard",
    young_modulus=193.0e9,
    poisson_ratio=0.3,
    density=7880.0,
    yield_strength=965.0e6,
    source="data sheets of AISI 301 full hard (AMS 5519, ASTM A666): 193 GPa, 965 MPa least yield, 20 C",
    temperature_data="AISI 301",
)
SPRING_STEEL = Material(
    name="spring steel",
    young_modulus=206.0e9,
    poisson_ratio=0.3,
    density=7850.0,
    yield_strength=1300.0e6,
    source="EN 10270-1 (E 206 GPa); yield of hardened and tempered strip, typical",
)
