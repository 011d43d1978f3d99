"""Yield strength of each part of a study's wheel. Verified by tests/unit/test_workbench_yielding.py."""

from __future__ import annotations

from workbench.study.model import Study
from workbench.study.own_mesh import materials_by_part

__all__ = ["yield_strengths"]


def yield_strengths(study: Study) -> dict[str, float]:
    """Yield strength [Pa] of each part of the mesh whose material has one."""
    found = {part: material.yield_strength for part, material in materials_by_part(study).items()}
    return {part: strength for part, strength in found.items() if strength is not None}
