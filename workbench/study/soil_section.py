"""What a study asks of its wheel on soil, and what such a wheel cannot have."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from workbench.study.quantities import Force
from workbench.study.section import Positive, Section

if TYPE_CHECKING:
    from workbench.study.model import Study

__all__ = ["SoilSection", "without_soil"]


class SoilSection(Section):
    """The wheel on soils: drawbar pull over slip, and at rest by finite elements and plates."""

    soils: Annotated[tuple[Annotated[str, Field(min_length=1)], ...], Field(min_length=1, max_length=6)]
    """Names of known soils, or files of soils beside the study, such as "mine.toml"; the first is that of the runs at
    rest."""
    load: Annotated[Force, Positive] = 200.0
    """On the wheel [N]."""


def without_soil(study: Study) -> tuple[str, str, str, str] | None:
    """What keeps a study's wheel off soil: what, value, rule and hint of a message; None if nothing does."""
    from workbench.study.laws import plastic_parts
    from workbench.study.own_mesh import own_mesh

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
