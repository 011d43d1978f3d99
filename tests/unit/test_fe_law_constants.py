"""Laws as the loops' constants: what a part gets, what each law is at small strain, what forms and planes refuse."""

from __future__ import annotations

from dataclasses import replace

import pytest

from contracts.errors import InputError
from contracts.material_laws import J2Plasticity, MooneyRivlin, NeoHookean, Ogden, StVenantKirchhoff
from contracts.materials import AISI_301
from reference_fe.cells.choice import form_laws
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.law_constants import law_constants, laws_of, small_strain_lame
from reference_fe.material.principal_laws import J2, NEO_HOOKEAN, OGDEN

RUBBER = MooneyRivlin(c10=0.3e6, c01=0.1e6, bulk_modulus=1e9)


def test_a_part_without_a_law_has_the_discretisation_s() -> None:
    materials = {"tire": AISI_301, "grousers": replace(AISI_301, temperature_data=None, law=RUBBER)}
    assert laws_of(materials, MaterialLaw.ST_VENANT_KIRCHHOFF) == {"tire": StVenantKirchhoff(), "grousers": RUBBER}
    assert laws_of(materials, MaterialLaw.NEO_HOOKEAN)["tire"] == NeoHookean()


def test_constants_of_each_law() -> None:
    mu, lam = AISI_301.lame_mu, AISI_301.lame_lambda
    found = law_constants(AISI_301, RUBBER)
    assert (found.kind, found.values, found.bulk) == (OGDEN, (0.6e6, 2.0, -0.2e6, -2.0), 1e9)
    assert law_constants(AISI_301, NeoHookean()).values == (lam, mu)
    assert law_constants(AISI_301, NeoHookean()).kind == NEO_HOOKEAN
    plastic = law_constants(AISI_301, J2Plasticity(hardening_modulus=1e9))
    assert (plastic.kind, plastic.values) == (J2, (mu, 965e6, 1e9, 965e6, 0.0))
    assert plastic.bulk == pytest.approx(AISI_301.young_modulus / (3.0 * (1.0 - 2.0 * AISI_301.poisson_ratio)))


def test_rubber_at_small_strain_has_its_own_moduli() -> None:
    """E and nu of the material do not count."""
    lam, mu = small_strain_lame(AISI_301, Ogden(moduli=(2.0, -1.0), exponents=(2.0, -2.0), bulk_modulus=30.0))
    assert mu == 3.0
    assert lam + 2.0 / 3.0 * mu == pytest.approx(30.0)


def test_forms_refuse_what_they_do_not_have() -> None:
    assert form_laws({"a": NeoHookean(), "b": StVenantKirchhoff()})["a"] is MaterialLaw.NEO_HOOKEAN
    with pytest.raises(InputError, match="law of tire = mooney_rivlin"):
        form_laws({"tire": RUBBER})
