"""How metals change with temperature: modulus and yield strength relative to 20 C, thermal strain from 20 C.

Everything is relative to 20 C, so that a study keeps its own values there. Poisson's ratio is taken as constant (alpha
titanium: 0.306 at -143 C, 0.321 at 20 C, from the constants below). docs/theory.md 2.6 has the sources in words.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from contracts.errors import InputError
from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS, PropertyRow, PropertyTable

__all__ = ["REFERENCE_TEMPERATURE", "TEMPERATURE_DATA", "TemperatureData", "temperature_data"]

REFERENCE_TEMPERATURE = 20.0 + KELVIN_AT_ZERO_CELSIUS
"""20 C [K]: where tables give 1 (ratios) or 0 (strain)."""
_PA_PER_KSI = 6.894757293e6


@dataclass(frozen=True, slots=True, kw_only=True)
class TemperatureData:
    """One metal against temperature.

    Attributes
    ----------
    name : as a study names it
    modulus_ratio : E(T) / E(20 C) [-]
    thermal_strain : relative change of length from 20 C, the integral of the expansion coefficient [-]
    yield_ratio : R_p0.2(T) / R_p0.2(20 C) [-]; None where we have no source
    doubt : what a reader must know of these data
    """

    name: str
    modulus_ratio: PropertyTable
    thermal_strain: PropertyTable
    yield_ratio: PropertyTable | None
    doubt: str

    def mean_expansion(self, temperature: float) -> float:
        """Mean expansion coefficient between 20 C and a temperature [1/K]."""
        change = temperature - REFERENCE_TEMPERATURE
        if change == 0.0:
            return self.thermal_strain.at(temperature + 0.5) - self.thermal_strain.at(temperature - 0.5)
        return self.thermal_strain.at(temperature) / change


def _rows(values: Mapping[float, float], source: str) -> list[PropertyRow]:
    return [PropertyRow(temperature=T, value=value, source=source) for T, value in values.items()]


def _polynomial(coefficients: Sequence[float], T: float) -> float:
    return float(sum(c * T**power for power, c in enumerate(coefficients)))


_NIST = "NIST Cryogenic Material Properties, "
_NIST_PAPER = "; Marquardt, Le & Radebaugh, 11th Int. Cryocooler Conf. (2000)"
_COLD = (77.0, 100.0, 130.15, 160.0, 190.0, 220.0, 233.15, 250.0, 273.15)
_20_C = PropertyRow(temperature=REFERENCE_TEMPERATURE, value=1.0, source="definition of the ratio")
_NO_STRAIN = PropertyRow(temperature=REFERENCE_TEMPERATURE, value=0.0, source="definition of the strain")


def _nist_strain(coefficients: Sequence[float], source: str, last: PropertyRow) -> PropertyTable:
    """Rows of a NIST fit (L - L_293)/L_293 in 1e-5, moved to zero at 20 C; the fit ends at 300 K, then one row more."""
    zero = _polynomial(coefficients, REFERENCE_TEMPERATURE)
    fit = {T: 1e-5 * (_polynomial(coefficients, T) - zero) for T in (*_COLD, 300.0)}
    rows = _rows(fit, source)
    return PropertyTable(what="thermal strain", rows=(*rows[:-1], _NO_STRAIN, rows[-1], last))


_ALPHA_TITANIUM = {
    77.0: 1.13614,
    100.0: 1.12158,
    130.15: 1.10250,
    150.0: 1.08996,
    173.15: 1.07536,
    200.0: 1.05844,
    233.15: 1.03760,
    263.15: 1.01877,
}
"""E(T) / E(20 C) of alpha titanium: Voigt-Reuss-Hill mean of the single crystal of Fisher & Renken (1964)."""
_ALLOY_SLOPE = -4.3838e-4
"""dE/dT / E(20 C) of Ti-6Al-4V [1/K]: straight line through the points of Fukuhara & Sanpei (1993), 23 to 328 C."""
_ALPHA_SLOPE = -6.1383e-4
"""The same of alpha titanium, at the same temperatures."""
_FISHER = (
    "course of alpha titanium (Fisher & Renken, Phys. Rev. 135, A482, 1964, 77 to 923 K, Voigt-Reuss-Hill), scaled to "
    "the slope of Ti-6Al-4V above 23 C (Fukuhara & Sanpei, J. Mater. Sci. Lett. 12, 1993, 10.1007/BF00420541)"
)
_FUKUHARA = "Fukuhara & Sanpei, J. Mater. Sci. Lett. 12 (1993), 10.1007/BF00420541, straight line 23 to 328 C"

_TI_6AL_4V = TemperatureData(
    name="Ti-6Al-4V",
    modulus_ratio=PropertyTable(
        what="Young's modulus of Ti-6Al-4V",
        rows=(
            *_rows({T: 1.0 + (r - 1.0) * _ALLOY_SLOPE / _ALPHA_SLOPE for T, r in _ALPHA_TITANIUM.items()}, _FISHER),
            _20_C,
            PropertyRow(temperature=373.15, value=1.0 + 80.0 * _ALLOY_SLOPE, source=_FUKUHARA),
        ),
    ),
    thermal_strain=_nist_strain(
        (-1.711e2, -2.140e-1, 4.807e-3, -7.111e-6),
        f"{_NIST}Ti-6Al-4V, 24 to 300 K{_NIST_PAPER}",
        PropertyRow(temperature=373.15, value=80.0 * 8.6e-6, source="ASM data sheet: mean 8.6e-6 1/K, 20 to 100 C"),
    ),
    yield_ratio=PropertyTable(
        what="yield strength of Ti-6Al-4V",
        rows=(
            *_rows(
                {20.37: 248.0 * _PA_PER_KSI / 880e6, 77.0: 202.0 * _PA_PER_KSI / 880e6},
                "President Titanium, data sheet of grade 23 (ELI): typical 248 ksi at -423 F, 202 ksi at -320 F; over "
                "880 MPa (ASM, annealed, 20 C)",
            ),
            _20_C,
            PropertyRow(
                temperature=423.15,
                value=724.0 / 880.0,
                source="North Steel, data sheet of grade 5: typical 724 MPa at 150 C; over 880 MPa (ASM, 20 C)",
            ),
        ),
    ),
    doubt="modulus below 23 C not measured on this alloy here: with pure titanium's own slope it would be 2.7 % higher "
    "at -143 C; yield between -196 and 20 C is interpolated",
)

_NIST_304 = (2.100593e2, 1.534883e-1, -1.617390e-3, 5.117060e-6, -6.154600e-9)
_AISI_301 = TemperatureData(
    name="AISI 301",
    modulus_ratio=PropertyTable(
        what="Young's modulus of AISI 301",
        rows=(
            *_rows(
                {T: _polynomial(_NIST_304, T) / _polynomial(_NIST_304, REFERENCE_TEMPERATURE) for T in _COLD},
                f"{_NIST}AISI 304, 57 to 293 K",
            ),
            _20_C,
            PropertyRow(
                temperature=400.0,
                value=1.0 + (400.0 - REFERENCE_TEMPERATURE) * (188.49 / 194.18 - 1.0) / 100.0,
                source="AISI 316, 194.18 GPa at 300 K, 188.49 GPa at 400 K: Karditsas & Baptiste, UKAEA FUS 294 (1995)",
            ),
        ),
    ),
    thermal_strain=_nist_strain(
        (-2.9554e2, -3.9811e-1, 9.2683e-3, -2.0261e-5, 1.7127e-8),
        f"{_NIST}AISI 304, 23 to 300 K{_NIST_PAPER}",
        PropertyRow(
            temperature=373.15, value=80.0 * 16.6e-6, source="data sheet AMS 5519: mean 16.6e-6 1/K, 20 to 100 C"
        ),
    ),
    yield_ratio=None,
    doubt="relative changes are those of AISI 304, and 316 above 20 C, annealed; no source for yield off 20 C",
)

TEMPERATURE_DATA: Mapping[str, TemperatureData] = {data.name: data for data in (_TI_6AL_4V, _AISI_301)}
"""Every metal whose data we have, by name. Verified by tests/unit/test_materials_temperature.py."""


def temperature_data(name: str) -> TemperatureData:
    """Data of a metal by name; InputError for one we do not have."""
    if name not in TEMPERATURE_DATA:
        hint = f"use one of {', '.join(TEMPERATURE_DATA)}"
        raise InputError("temperature data", name, "is not known", hint, key="temperature_data")
    return TEMPERATURE_DATA[name]
