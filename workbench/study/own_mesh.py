"""A study whose wheel's mesh comes from another program: its section, and what stands in [wheel]'s place then.

Verified by tests/unit/test_workbench_own_mesh.py.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.errors import InputError
from contracts.materials import Material
from workbench.study.own_mesh_section import OwnMeshSection
from workbench.study.wheel_design import SectionInputError, in_section, materials, part_materials, wheel_design

if TYPE_CHECKING:
    from geometry.own_mesh.roles import Placement, Roles
    from geometry.own_mesh.step_body import FaceRule, StepSizes
    from workbench.study.model import Study
    from workbench.study.sections import MeshSection

__all__ = [
    "material_names",
    "materials_by_part",
    "own_mesh",
    "placement_and_roles",
    "sized_mesh",
    "sizes_and_rules",
    "without_wheel",
]

_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 25.4e-3}
_AROUND = 12
"""Elements around a full circle: of second order they leave 2e-5 of the radius [-]."""


def own_mesh(study: Study) -> OwnMeshSection | None:
    """The section of a mesh from another program; None for a wheel of [wheel]."""
    return study.mesh if isinstance(study.mesh, OwnMeshSection) else None


def without_wheel(study: Study, what: str) -> InputError | None:
    """Why a study cannot have ``what``, which needs the wheel's dimensions; None if it has them."""
    if own_mesh(study) is None:
        return None
    rule = f"is the wheel's own mesh, and {what} needs the dimensions of [wheel]"
    return InputError("mesh.file", Path(own_file(study)).name, rule, "leave it out, or describe the wheel in [wheel]")


def own_file(study: Study) -> str:
    """Path of the mesh file; empty without one."""
    section = own_mesh(study)
    return "" if section is None else section.file


def sized_mesh(study: Study) -> MeshSection:
    """The sizes by which [wheel] is meshed; raises InputError for a mesh from another program."""
    if (reason := without_wheel(study, "a mesh of other sizes")) is not None:
        raise reason
    assert not isinstance(study.mesh, OwnMeshSection)
    return study.mesh


def material_names(study: Study) -> dict[str, str]:
    """Material name of each part of the mesh."""
    section = own_mesh(study)
    return part_materials(study) if section is None else {name: part.material for name, part in section.parts.items()}


def materials_by_part(study: Study) -> dict[str, Material]:
    """Material of each part of the mesh; raises SectionInputError for one that the study does not have."""
    section = own_mesh(study)
    if section is None:
        return dict(wheel_design(study).materials)
    known = materials(study)
    for name, part in section.parts.items():
        if part.material not in known:
            rule = f"is not in [materials], which has {', '.join(known) or 'none'}"
            hint = f"add [materials.{part.material}] or correct the name"
            error = InputError("material", part.material, rule, hint, key="material")
            raise SectionInputError(f"mesh.parts.{name}", error)
    return {name: known[part.material] for name, part in section.parts.items()}


def placement_and_roles(section: dict[str, Any]) -> tuple[Placement, Roles]:
    """Where the wheel lies and what names stand for, from the section as JSON."""
    from geometry.own_mesh.roles import Placement, Roles

    unit, centre = _UNITS[section["units"] or "m"], tuple(section["centre"])
    parts = _groups(section)
    pairs = tuple((slave, master) for slave, master in section["contact"])
    return (
        in_section("mesh", partial(Placement, unit=unit, axle=section["axle"], up=section["up"], centre=centre)),
        Roles(
            parts=parts,
            hub=tuple(section["hub"]),
            ground=tuple(section["ground"]),
            contact=pairs,
            symmetry=section["symmetry"] or "",
        ),
    )


def sizes_and_rules(section: dict[str, Any]) -> tuple[StepSizes, dict[str, FaceRule]]:
    """How a STEP file is meshed and which of its faces names stand for, from the section as JSON."""
    from geometry.own_mesh.step_body import FaceRule, StepSizes

    groups = _groups(section)
    own = {name: part["element_size"] for name, part in section["parts"].items() if part["element_size"]}
    around = _AROUND if section["around"] is None else section["around"]
    of_solids = {solid: size for name, size in own.items() for solid in groups[name]}
    rules = {
        name: FaceRule(
            solids=groups[rule["part"]] if rule["part"] else (),
            numbers=tuple(rule["numbers"]),
            radius=tuple(rule["radius"]) if rule["radius"] else None,
            position=tuple(rule["position"]) if rule["position"] else None,
        )
        for name, rule in section["faces"].items()
    }
    part_of = {solid: name for name, mine in groups.items() for solid in mine}
    sizes = StepSizes(element_size=section["element_size"], of_solids=of_solids, around=around, part_of=part_of)
    return sizes, rules


def _groups(section: dict[str, Any]) -> dict[str, tuple[str, ...]]:
    """Part -> the file's groups of cells, or solids, that it consists of."""
    return {name: tuple(part["groups"]) or (name,) for name, part in section["parts"].items()}
