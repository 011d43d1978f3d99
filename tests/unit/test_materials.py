"""Materials: Lame constants against E and nu, shipped numbers, refused values."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError, replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contracts.errors import InputError
from contracts.materials import SPRING_STEEL, TI_6AL_4V, Material


@given(st.floats(1e3, 1e12), st.floats(-0.9, 0.49))
def test_lame_constants_give_back_young_modulus_and_poisson_ratio(E: float, nu: float) -> None:
    material = replace(TI_6AL_4V, young_modulus=E, poisson_ratio=nu)
    lam, mu = material.lame_lambda, material.lame_mu
    assert mu * (3.0 * lam + 2.0 * mu) / (lam + mu) == pytest.approx(E, rel=1e-9)
    assert lam / (2.0 * (lam + mu)) == pytest.approx(nu, rel=1e-9, abs=1e-12)


def test_zero_poisson_ratio_uncouples() -> None:
    material = replace(TI_6AL_4V, young_modulus=280e3, poisson_ratio=0.0)
    assert (material.lame_lambda, material.lame_mu) == (0.0, 140e3)


@pytest.mark.parametrize(
    ("material", "E_GPa", "rho"), [(TI_6AL_4V, 113.8, 4430.0), (SPRING_STEEL, 206.0, 7850.0)], ids=["Ti", "steel"]
)
def test_shipped_materials_are_the_data_sheet_and_name_it(material: Material, E_GPa: float, rho: float) -> None:
    assert material.young_modulus == pytest.approx(E_GPa * 1e9, rel=1e-12)
    assert material.density == rho
    assert material.source


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("young_modulus", 0.0, "young modulus = 0 Pa: must be finite and greater than zero"),
        ("young_modulus", -1.0e9, "young modulus = -1e\\+09 Pa"),
        ("young_modulus", math.nan, "young modulus = nan Pa"),
        ("density", math.inf, "density = inf kg/m\\^3"),
        ("density", -4430.0, "density = -4430 kg/m\\^3"),
        ("yield_strength", 0.0, "yield strength = 0 Pa"),
        ("poisson_ratio", 0.5, "poisson ratio = 0.5: must lie in \\(-1, 0.5\\)"),
        ("poisson_ratio", -1.0, "poisson ratio = -1"),
        ("poisson_ratio", math.nan, "poisson ratio = nan"),
    ],
)
def test_values_out_of_range_are_refused(name: str, value: float, text: str) -> None:
    change: dict[str, Any] = {name: value}
    with pytest.raises(InputError, match=f"Ti-6Al-4V: {text}"):
        replace(TI_6AL_4V, **change)


def test_a_material_cannot_be_changed() -> None:
    with pytest.raises(FrozenInstanceError):
        TI_6AL_4V.density = 1.0  # type: ignore[misc]
