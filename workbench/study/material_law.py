"""The law of a material in a study file: its kind and its constants, which `contracts.material_laws` declares.

Verified by tests/unit/test_workbench_material_law.py.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from contracts.material_laws import J2Plasticity, MooneyRivlin, NeoHookean, Ogden, StVenantKirchhoff
from workbench.study.declared import reads
from workbench.study.section import Section

__all__ = ["LawSection"]


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
