"""Which law each part of a study's wheel deforms by, and what is refused for it.

Verified by tests/unit/test_workbench_material_law.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from contracts.errors import InputError
from contracts.material_laws import J2Plasticity
from workbench.study.own_mesh import material_names, materials_by_part

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["HUB_PARTS", "other_law", "plastic_parts", "require_elastic"]

HUB_PARTS = ("outer_hub", "cone", "impact_springs", "inner_hub")
"""Parts within the springs' welds on the hub, outside to inside."""
_LINEAR = "st_venant_kirchhoff"


def other_law(study: Study) -> tuple[str, str] | None:
    """Key and kind of the first law of a part that deforms that is not St. Venant and Kirchhoff's; None without one."""
    for material in _names_of_what_deforms(study).values():
        law = study.materials[material].law
        if law is None and study.fe.material_law != _LINEAR:
            return "fe.material_law", study.fe.material_law
        if law is not None and law.kind != _LINEAR:
            return f"materials.{material}.law.kind", law.kind
    return None


def plastic_parts(study: Study) -> tuple[str, ...]:
    """Parts that deform and can yield for good."""
    found, deforming = materials_by_part(study), _names_of_what_deforms(study)
    return tuple(part for part in deforming if isinstance(found[part].law, J2Plasticity))


def require_elastic(study: Study, what: str) -> None:
    """Raise InputError about a plastic part, for ``what`` takes load as a function of where the wheel stands."""
    if plastic := plastic_parts(study):
        material = material_names(study)[plastic[0]]
        rule = f"is not in {what}: what yielded before decides the load, too"
        hint = "give the material another law; curves, travels and strength go with this one"
        raise InputError(f"materials.{material}.law.kind", "j2_plasticity", rule, hint)


def _names_of_what_deforms(study: Study) -> dict[str, str]:
    """Part -> name of its material, without hubs that are held rigid."""
    rigid = HUB_PARTS if study.fe.hub == "rigid" else ()
    held = getattr(study.mesh, "hub", ())
    return {part: name for part, name in material_names(study).items() if part not in rigid and part not in held}
