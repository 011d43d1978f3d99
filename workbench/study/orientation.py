"""What a task for one orientation of the wheel is called.

Verified by tests/unit/test_workbench_graph.py.
"""

from __future__ import annotations

import math

__all__ = ["deep_name", "degrees", "orientation_name"]


def degrees(angle: float) -> float:
    """Angle in degrees, free of the last digits' noise."""
    return round(math.degrees(angle), 9)


def orientation_name(model: str, orientation_deg: float) -> str:
    """``fe_phi015``; fractions of a degree as ``fe_phi022.5``."""
    whole, _, fraction = f"{orientation_deg:.6f}".partition(".")
    fraction = fraction.rstrip("0")
    return f"{model}_phi{int(whole):03d}" + (f".{fraction}" if fraction else "")


def deep_name(model: str, orientation_deg: float) -> str:
    """Name of the task that goes on beyond the study's curve."""
    return orientation_name(f"{model}_deep", orientation_deg)
