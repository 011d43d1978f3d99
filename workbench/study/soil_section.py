"""What a study asks of its wheel on soil."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from workbench.study.quantities import Force
from workbench.study.section import Positive, Section

__all__ = ["SoilSection"]


class SoilSection(Section):
    """The wheel on soils: drawbar pull over slip, and at rest by finite elements and plates."""

    soils: Annotated[tuple[Annotated[str, Field(min_length=1)], ...], Field(min_length=1, max_length=6)]
    """Names of known soils, or files of soils beside the study, such as "mine.toml"; the first is that of the runs at
    rest."""
    load: Annotated[Force, Positive] = 200.0
    """On the wheel [N]."""
