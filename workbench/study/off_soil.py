"""What keeps a study's wheel from being driven on soil. Verified by tests/unit/test_workbench_soil.py."""

from __future__ import annotations

import math

from workbench.study.laws import plastic_parts
from workbench.study.model import Study
from workbench.study.own_mesh import own_mesh

__all__ = ["without_soil"]


def without_soil(study: Study) -> tuple[str, str, str, str] | None:
    """What keeps a study's wheel off soil: what, value, rule and hint of a message; None if nothing does."""
    if own_mesh(study) is not None:
        return "mesh.file", "", "has no rim of known radius and grousers", "describe the wheel by its parts"
    if study.fe.obstacle.shape != "plane" or study.fe.camber:
        value = f"{study.fe.obstacle.shape}, camber {math.degrees(study.fe.camber):g} deg"
        return (
            "ground of [fe]",
            value,
            "is not level, as soil is",
            'give fe.obstacle = { shape = "plane" } and no camber',
        )
    if study.fe.friction:
        return "fe.friction", f"{study.fe.friction:g}", "shapes the rim that soil presses", "leave it at 0"
    if parts := plastic_parts(study):
        return "materials", parts[0].replace("_", " "), "yields, and a rim on soil springs back", "give it another law"
    return None
