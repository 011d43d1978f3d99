"""How far a tire's potential lies from a curve solved apart. Verified by tests/unit/test_workbench_wheel_curves.py."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["Between"]


class Between(NamedTuple):
    """Where a tire's load differs most from a curve solved apart: orientation [deg], deflection [m], relative [-]."""

    orientation_deg: float
    deflection: float
    difference: float
