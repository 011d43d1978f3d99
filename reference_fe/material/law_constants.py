"""Constants of each part's law as the compiled loops want them, and what they are at small strain.

Verified by tests/unit/test_fe_law_constants.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from contracts.material_laws import J2Plasticity, Law, MooneyRivlin, NeoHookean, Ogden, StVenantKirchhoff
from contracts.materials import Material
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.principal_laws import J2, NEO_HOOKEAN, OGDEN

__all__ = ["LawConstants", "law_constants", "laws_of", "small_strain_lame"]


@dataclass(frozen=True, slots=True, kw_only=True)
class LawConstants:
    """One law as numbers.

    Attributes
    ----------
    kind, values : see `principal_laws`
    bulk : K of U = K/2 (ln theta)^2 [Pa]; 0 for the compressible neo-Hookean law, which has no pressure of its own
    """

    kind: int
    values: tuple[float, ...]
    bulk: float = 0.0


def laws_of(materials: Mapping[str, Material], default: MaterialLaw) -> dict[str, Law]:
    """Part -> its law; ``default`` where the material leaves it open."""
    otherwise: Law = StVenantKirchhoff() if default is MaterialLaw.ST_VENANT_KIRCHHOFF else NeoHookean()
    return {part: material.law or otherwise for part, material in materials.items()}


def law_constants(material: Material, law: Law) -> LawConstants:
    """The law's constants; lambda, mu, K and the yield strength are the material's where the law has none.

    Not for St. Venant-Kirchhoff, which has loops of its own.
    """
    lam, mu = small_strain_lame(material, law)
    match law:
        case NeoHookean():
            return LawConstants(kind=NEO_HOOKEAN, values=(lam, mu))
        case MooneyRivlin():
            return LawConstants(kind=OGDEN, values=(2.0 * law.c10, 2.0, -2.0 * law.c01, -2.0), bulk=law.bulk_modulus)
        case Ogden():
            terms = zip(law.moduli, law.exponents, strict=True)
            return LawConstants(kind=OGDEN, values=tuple(x for pair in terms for x in pair), bulk=law.bulk_modulus)
        case J2Plasticity():
            R = material.yield_strength
            assert R is not None  # `Material` refuses plasticity without one
            end = R if law.saturation_stress is None else law.saturation_stress
            values = (mu, R, law.hardening_modulus, end, law.saturation_rate)
            return LawConstants(kind=J2, values=values, bulk=lam + 2.0 / 3.0 * mu)
        case StVenantKirchhoff():
            raise TypeError("St. Venant-Kirchhoff material has loops of its own")


def small_strain_lame(material: Material, law: Law) -> tuple[float, float]:
    """Lambda and mu of linear elasticity that the law begins with [Pa]."""
    if isinstance(law, MooneyRivlin | Ogden):
        return law.bulk_modulus - 2.0 / 3.0 * law.shear_modulus, law.shear_modulus
    return material.lame_lambda, material.lame_mu
