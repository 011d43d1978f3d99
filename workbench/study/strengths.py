"""Yield strength of each part of a study's wheel. Verified by tests/unit/test_workbench_yielding.py."""

from __future__ import annotations

from workbench.study.wheel import WheelStudy
from workbench.study.wheel_design import wheel_design

__all__ = ["yield_strengths"]


def yield_strengths(study: WheelStudy) -> dict[str, float]:
    """Yield strength [Pa] of each part of the mesh."""
    return {part: material.yield_strength for part, material in wheel_design(study).materials.items()}
