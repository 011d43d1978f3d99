"""Constants of the material laws: what they give, and what is refused."""

from __future__ import annotations

from typing import Any

import pytest

from contracts.errors import InputError
from contracts.material_laws import (
    J2Plasticity,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    StVenantKirchhoff,
    law_from,
    law_values,
)

_LAWS = (
    StVenantKirchhoff(),
    NeoHookean(),
    MooneyRivlin(c10=0.3e6, c01=0.05e6, bulk_modulus=1e9),
    Ogden(moduli=(0.63e6, 0.0012e6, -0.01e6), exponents=(1.3, 5.0, -2.0), bulk_modulus=1e9),
    J2Plasticity(hardening_modulus=129.24e6, saturation_stress=715e6, saturation_rate=16.93),
)


@pytest.mark.parametrize("law", _LAWS, ids=lambda law: type(law).__name__)
def test_a_law_comes_back_from_its_values(law: Any) -> None:
    assert law_from(law_values(law)) == law


def test_ogden_with_two_and_minus_two_is_mooney_rivlin_at_small_strain() -> None:
    ogden = Ogden(moduli=(0.6e6, -0.1e6), exponents=(2.0, -2.0), bulk_modulus=1e9)
    assert ogden.shear_modulus == pytest.approx(MooneyRivlin(c10=0.3e6, c01=0.05e6, bulk_modulus=1e9).shear_modulus)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"kind": "rubber"}, "must be one of"),
        ({"kind": "mooney_rivlin", "c10": -1e6, "bulk_modulus": 1e9}, "no stiffness against shear"),
        ({"kind": "mooney_rivlin", "c10": 1e6, "bulk_modulus": 0.0}, "greater than zero"),
        ({"kind": "ogden", "moduli": [1e6], "exponents": [2.0, 3.0], "bulk_modulus": 1e9}, "as many as"),
        ({"kind": "ogden", "moduli": [1e6], "exponents": [0.0], "bulk_modulus": 1e9}, "must not be zero"),
        ({"kind": "j2_plasticity", "hardening_modulus": -1.0}, "at least 0"),
        ({"kind": "j2_plasticity", "saturation_rate": 3.0}, "goes with a saturation stress"),
    ],
)
def test_constants_that_cannot_be_are_told(values: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        law_from(values)
