"""Yield strength of each part of a study's wheel. Verified by tests/unit/test_workbench_yielding.py."""

from __future__ import annotations

from workbench.study.model import Study
from workbench.study.own_mesh import material_names, materials_by_part, own_mesh

__all__ = ["judges_strength", "parts_without_strength", "yield_strengths"]

_NOT_JUDGED = "lattice_joints"


def yield_strengths(study: Study) -> dict[str, float]:
    """Yield strength [Pa] of each part that is judged: its material has one; a lattice's joints are not, as welds."""
    found = {part: material.yield_strength for part, material in materials_by_part(study).items()}
    judged = {part: strength for part, strength in found.items() if own_mesh(study) or part != _NOT_JUDGED}
    return {part: strength for part, strength in judged.items() if strength is not None}


def parts_without_strength(study: Study) -> tuple[str, ...]:
    """Parts that do not yield, such as rubber, and are not judged."""
    return tuple(part for part, name in material_names(study).items() if not _yields(study, name))


def judges_strength(study: Study) -> bool:
    """Whether any part has a yield strength."""
    return any(_yields(study, name) for name in material_names(study).values())


def _yields(study: Study, material: str) -> bool:
    section = study.materials.get(material)
    return section is not None and getattr(section, "yield_strength", None) is not None
