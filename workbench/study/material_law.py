"""The law of a material in a study file: its kind and its constants, which `contracts.material_laws` declares.

Verified by tests/unit/test_workbench_material_law.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal, get_args

from pydantic import Field

from contracts.material_laws import J2Plasticity, MooneyRivlin, NeoHookean, Ogden, StVenantKirchhoff
from workbench.study.declared import reads
from workbench.study.section import Section

__all__ = ["LawSection", "hint_of_its_place"]


@reads(StVenantKirchhoff)
class StVenantKirchhoffSection(Section):
    """Metal that stays elastic, by Young's modulus and Poisson's ratio."""

    kind: Literal["st_venant_kirchhoff"]
    """``"st_venant_kirchhoff"``, for small strain at any rotation."""


@reads(NeoHookean)
class NeoHookeanSection(Section):
    """Compressible neo-Hookean material, by Young's modulus and Poisson's ratio."""

    kind: Literal["neo_hookean"]
    """``"neo_hookean"``, for strain that may be large in compression."""


@reads(MooneyRivlin)
class MooneyRivlinSection(Section):
    """Rubber of two terms; Young's modulus and Poisson's ratio follow from its constants."""

    kind: Literal["mooney_rivlin"]
    """``"mooney_rivlin"``."""


@reads(Ogden)
class OgdenSection(Section):
    """Rubber by principal stretches; Young's modulus and Poisson's ratio follow from its constants."""

    kind: Literal["ogden"]
    """``"ogden"``."""


@reads(J2Plasticity)
class J2PlasticitySection(Section):
    """Metal that yields at its yield strength and hardens."""

    kind: Literal["j2_plasticity"]
    """``"j2_plasticity"``: von Mises' criterion, isotropic hardening."""


LawSection = Annotated[
    StVenantKirchhoffSection | NeoHookeanSection | MooneyRivlinSection | OgdenSection | J2PlasticitySection,
    Field(discriminator="kind"),
]


def hint_of_its_place(key: Sequence[str | int]) -> str | None:
    """Where a law stands, for a key that is wrong since it is a law's somewhere else; None for any other."""
    names = {name for kind in get_args(get_args(LawSection)[0]) for name in kind.model_fields}
    below = len(key) == 3 and tuple(key[:2]) == ("materials", "law") and key[2] in names
    if key[-1] == "law" or tuple(key) == ("fe", "material_law") or below:
        return "other laws stand with their material: [materials.NAME.law]"
    return None
