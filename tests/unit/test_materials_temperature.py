"""Data against temperature, re-derived from the published fits they are taken from.

Sources: NIST Cryogenic Material Properties (fits of expansion and modulus), Fisher & Renken, Phys. Rev. 135 (1964) A482
(single crystal of alpha titanium, quadratic fit of their table IV), data sheets. Tolerances: rounding of the rows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.materials import AISI_301, SPRING_STEEL, TI_6AL_4V
from contracts.materials_temperature import REFERENCE_TEMPERATURE, TEMPERATURE_DATA, temperature_data

ZERO = 273.15
FISHER_RENKEN = {
    "C11": (162.5, -5.915e-2, 1.156e-5),
    "C12": (91.8, 2.192e-2, -1.621e-5),
    "C13": (68.9, 2.965e-3, -5.767e-6),
    "C33": (180.6, -4.110e-2, 7.330e-6),
    "C44": (46.8, -1.857e-2, -3.745e-6),
}
"""C [GPa] = a + b t + c t^2 with t = T - 293.15 K, 77 to 923 K."""


def polycrystal_modulus(T: float) -> float:
    """Young's modulus of alpha titanium [GPa]: Voigt-Reuss-Hill mean of the single crystal."""
    t = T - 293.15
    c = {name: a + b * t + q * t * t for name, (a, b, q) in FISHER_RENKEN.items()}
    C = np.zeros((6, 6))
    C[:2, :2] = [[c["C11"], c["C12"]], [c["C12"], c["C11"]]]
    C[2, :2] = C[:2, 2] = c["C13"]
    C[2, 2], C[3, 3], C[4, 4], C[5, 5] = c["C33"], c["C44"], c["C44"], (c["C11"] - c["C12"]) / 2.0
    S = np.linalg.inv(C)
    diagonal, coupled, shear = np.trace(C[:3, :3]), C[0, 1] + C[0, 2] + C[1, 2], np.trace(C[3:, 3:])
    voigt = (diagonal + 2.0 * coupled) / 9.0, (diagonal - coupled + 3.0 * shear) / 15.0
    diagonal, coupled, shear = np.trace(S[:3, :3]), S[0, 1] + S[0, 2] + S[1, 2], np.trace(S[3:, 3:])
    reuss = 1.0 / (diagonal + 2.0 * coupled), 15.0 / (4.0 * diagonal - 4.0 * coupled + 3.0 * shear)
    K, G = (voigt[0] + reuss[0]) / 2.0, (voigt[1] + reuss[1]) / 2.0
    return float(9.0 * K * G / (3.0 * K + G))


def test_titanium_follows_the_measured_course_scaled_to_the_alloys_slope() -> None:
    """The slope of Ti-6Al-4V above 23 C over that of alpha titanium there is 0.714."""
    modulus = TEMPERATURE_DATA["Ti-6Al-4V"].modulus_ratio
    for row in modulus.rows[:8]:
        alpha = polycrystal_modulus(row.temperature) / polycrystal_modulus(293.15)
        assert row.value - 1.0 == pytest.approx(0.71417 * (alpha - 1.0), abs=1e-5)


@pytest.mark.parametrize(("T", "contraction"), [(77.0, 162.4e-5), (200.0, 78.6e-5)])
def test_titanium_contracts_as_nist_has_it(T: float, contraction: float) -> None:
    assert -TEMPERATURE_DATA["Ti-6Al-4V"].thermal_strain.at(T) == pytest.approx(contraction, abs=0.1e-5)


def test_austenitic_steel_is_nists() -> None:
    """NIST's 304 has 214.4 GPa at 77 K against 199.5 GPa at 20 C, and contracts by 0.28 % on the way."""
    data = TEMPERATURE_DATA["AISI 301"]
    assert data.modulus_ratio.at(77.0) == pytest.approx(214.41 / 199.52, rel=1e-4)
    assert data.thermal_strain.at(77.0) == pytest.approx(-280.2e-5, abs=0.1e-5)


def test_mean_expansion_is_that_of_the_data_sheets() -> None:
    """Room temperature: 8.6e-6 1/K of titanium, 16.6e-6 of AISI 301, each 12 % (NIST's fits bend down at their end)."""
    for name, sheet in (("Ti-6Al-4V", 8.6e-6), ("AISI 301", 16.6e-6)):
        data = TEMPERATURE_DATA[name]
        assert data.mean_expansion(373.15) == pytest.approx(sheet, rel=1e-12)
        assert data.mean_expansion(REFERENCE_TEMPERATURE) == pytest.approx(sheet, rel=0.12)
        assert 0.8 * sheet < data.mean_expansion(ZERO - 143.0) < sheet


def test_every_row_has_a_source_and_20_c_is_the_reference() -> None:
    for data in TEMPERATURE_DATA.values():
        assert data.modulus_ratio.at(REFERENCE_TEMPERATURE) == 1.0
        assert data.thermal_strain.at(REFERENCE_TEMPERATURE) == 0.0
        assert data.yield_ratio is None or data.yield_ratio.at(REFERENCE_TEMPERATURE) == 1.0
        tables = (data.modulus_ratio, data.thermal_strain, data.yield_ratio)
        assert all(row.source for table in tables if table is not None for row in table.rows)


def test_a_material_in_the_cold_is_stiffer_stronger_and_shorter() -> None:
    cold = TI_6AL_4V.at(ZERO - 143.0)
    assert cold.young_modulus == pytest.approx(1.0732 * 113.8e9, rel=1e-4)
    assert cold.thermal_strain == pytest.approx(-1.3332e-3, abs=1e-7)
    assert cold.thermal_stretch == 1.0 + cold.thermal_strain
    assert 1.2 < cold.yield_strength / TI_6AL_4V.yield_strength < 1.44  # below the chord: the rows are convex
    assert (cold.poisson_ratio, cold.density) == (TI_6AL_4V.poisson_ratio, TI_6AL_4V.density)
    assert cold.temperature == ZERO - 143.0


def test_20_c_changes_nothing() -> None:
    assert TI_6AL_4V.at(REFERENCE_TEMPERATURE) == TI_6AL_4V


def test_yield_without_a_source_stays() -> None:
    assert AISI_301.at(ZERO - 143.0).yield_strength == AISI_301.yield_strength
    assert temperature_data("AISI 301").yield_ratio is None


def test_what_cannot_be_known_is_refused() -> None:
    with pytest.raises(InputError, match="has no temperature data"):
        SPRING_STEEL.at(250.0)
    with pytest.raises(
        InputError, match=r"modulus of AISI 301 = 226.85 C: must lie within the data, -196.1 to 126.9 C"
    ):
        AISI_301.at(500.0)
    with pytest.raises(InputError, match="must be that at 20 C"):
        TI_6AL_4V.at(250.0).at(200.0)
    with pytest.raises(InputError, match=r"temperature data = unobtainium: is not known; use one of Ti-6Al-4V"):
        replace(TI_6AL_4V, temperature_data="unobtainium")
