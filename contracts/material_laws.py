"""Constitutive laws of a material that go beyond two elastic constants, as numbers.

Stored energies per undeformed volume; J = det F, lambda_a principal stretches, a bar marks J^(-1/3) times a stretch:

    Mooney-Rivlin   c10 (I1bar - 3) + c01 (I2bar - 3) + U(J)
    Ogden           sum_p mu_p / alpha_p (sum_a lambdabar_a^alpha_p - 3) + U(J)
    J2 plasticity   mu sum_a (ln lambdabar^e_a)^2 + U(J)

with U(J) = K/2 (ln J)^2. What solves them: `reference_fe.material`. Verified by tests/unit/test_material_laws.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Annotated, Any

from contracts.declared import In, PositivePressure, require_declared
from contracts.errors import InputError

__all__ = [
    "J2Plasticity",
    "Law",
    "MooneyRivlin",
    "NeoHookean",
    "Ogden",
    "Rubber",
    "StVenantKirchhoff",
    "elastic_constants",
    "law_from",
    "law_values",
]

Modulus = Annotated[float, In("Pa")]
NotNegative = Annotated[float, In("Pa", least=0.0)]


@dataclass(frozen=True, slots=True)
class StVenantKirchhoff:
    """S = lambda tr(E) I + 2 mu E of the material's Young's modulus and Poisson's ratio."""


@dataclass(frozen=True, slots=True)
class NeoHookean:
    """Compressible: S = mu (I - C^-1) + lambda ln J C^-1 of the material's two constants."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MooneyRivlin:
    """Nearly incompressible rubber of two terms; c01 = 0 is neo-Hookean.

    Attributes
    ----------
    c10, c01 : constants of the first and the second invariant [Pa], their sum > 0; either may be zero
    bulk_modulus : K of U(J) [Pa]
    """

    c10: Modulus
    c01: Modulus = 0.0
    bulk_modulus: PositivePressure

    def __post_init__(self) -> None:
        require_declared(self, "Mooney-Rivlin")
        _require_stiff(self.shear_modulus, "c10", (self.c10,), f"with c01 = {1e-6 * self.c01:g} MPa")

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus 2 (c10 + c01) [Pa]."""
        return 2.0 * (self.c10 + self.c01)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ogden:
    """Nearly incompressible rubber by principal stretches.

    Attributes
    ----------
    moduli : mu_p of each term [Pa]
    exponents : alpha_p of each term [-], none of them zero, of either sign; what is usual is their absolute value
    bulk_modulus : K of U(J) [Pa]
    """

    moduli: tuple[Modulus, ...]
    exponents: tuple[Annotated[float, In("")], ...]
    bulk_modulus: PositivePressure

    def __post_init__(self) -> None:
        require_declared(self, "Ogden")
        if len(self.moduli) != len(self.exponents) or not self.moduli:
            rule = f"must be as many as the exponents ({_listed(self.exponents) or 'none'}), and at least one"
            value, hint = _listed(self.moduli, 1e-6, " MPa"), "give one modulus an exponent"
            raise InputError("Ogden moduli", value, rule, hint, key="moduli")
        if 0.0 in self.exponents:
            raise InputError("Ogden exponents", 0.0, "must not be zero", "leave the term out", key="exponents")
        _require_stiff(self.shear_modulus, "moduli", self.moduli, f"with the exponents {_listed(self.exponents)}")

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, half the sum of mu_p alpha_p [Pa]."""
        return 0.5 * math.fsum(m * a for m, a in zip(self.moduli, self.exponents, strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class J2Plasticity:
    """Metal with isotropic hardening: elastic by the material's two constants, yields at its yield strength R:

        R(a) = R + hardening_modulus a + (saturation_stress - R) (1 - exp(-saturation_rate a)),

    a the equivalent plastic strain (Simo & Hughes, Computational Inelasticity, 1998, ch. 9: form from memory).

    Attributes
    ----------
    hardening_modulus : slope of the linear part [Pa]
    saturation_stress : what the saturating part tends to [Pa], at least the yield strength; left out, so is that part
    saturation_rate : how fast it does [-]
    """

    hardening_modulus: NotNegative = 0.0
    saturation_stress: PositivePressure | None = None
    saturation_rate: Annotated[float, In("", least=0.0)] = 0.0

    def __post_init__(self) -> None:
        require_declared(self, "plasticity")
        if (self.saturation_stress is None) != (self.saturation_rate == 0.0):
            rule = "goes with a saturation stress, and only with one"
            hint = "give both, or neither"
            raise InputError("saturation rate", f"{self.saturation_rate:g}", rule, hint, key="saturation_rate")

    def scaled(self, factor: float) -> J2Plasticity:
        """The same hardening at stresses that are all ``factor`` [-] as large, as another temperature makes them."""
        saturation = None if self.saturation_stress is None else factor * self.saturation_stress
        return replace(self, hardening_modulus=factor * self.hardening_modulus, saturation_stress=saturation)


Rubber = MooneyRivlin | Ogden
"""Laws that bring their own stiffness and know no yield."""
Law = StVenantKirchhoff | NeoHookean | Rubber | J2Plasticity

_KINDS: dict[str, type[Law]] = {
    "st_venant_kirchhoff": StVenantKirchhoff,
    "neo_hookean": NeoHookean,
    "mooney_rivlin": MooneyRivlin,
    "ogden": Ogden,
    "j2_plasticity": J2Plasticity,
}


def law_from(values: Mapping[str, Any]) -> Law:
    """A law from its JSON, ``kind`` and its constants; raises InputError for a kind that is none or wrong constants."""
    given = dict(values)
    kind = _KINDS.get(str(given.pop("kind", None)))
    if kind is None:
        raise InputError("law", values.get("kind"), f"must be one of {', '.join(_KINDS)}", "correct it", key="kind")
    for name, value in given.items():
        if isinstance(value, list):
            given[name] = tuple(value)
    return kind(**given)


def law_values(law: Law) -> dict[str, Any]:
    """The JSON of a law, see `law_from`."""
    name = next(name for name, kind in _KINDS.items() if type(law) is kind)
    return {"kind": name} | asdict(law)


def elastic_constants(law: Rubber) -> tuple[float, float]:
    """Young's modulus [Pa] and Poisson's ratio [-] of rubber at small strain, 9 K mu / (3 K + mu) and
    (3 K - 2 mu) / (2 (3 K + mu)).
    """
    mu, bulk = law.shear_modulus, law.bulk_modulus
    return 9.0 * bulk * mu / (3.0 * bulk + mu), (3.0 * bulk - 2.0 * mu) / (2.0 * (3.0 * bulk + mu))


def _listed(values: Sequence[float], scale: float = 1.0, unit: str = "") -> str:
    return ", ".join(f"{scale * value:g}{unit}" for value in values)


def _require_stiff(shear_modulus: float, key: str, given: Sequence[float], beside: str) -> None:
    if not shear_modulus > 0.0:
        rule = f"{beside} gives no stiffness against shear at small strain: {1e-6 * shear_modulus:g} MPa, must be > 0"
        raise InputError(key, _listed(given, 1e-6, " MPa"), rule, "check signs of the constants", key=key)
