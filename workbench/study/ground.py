"""What a study says about the ground under the rover. Verified by tests/unit/test_workbench_rover_inputs.py."""

from __future__ import annotations

from typing import Annotated

from workbench.study.quantities import Number
from workbench.study.section import Positive, Section

__all__ = ["GroundSection"]


class GroundSection(Section):
    """Coulomb's coefficient between the ground and the rover's tires, of whatever kind.

    Without it the brush tire has the friction of [brush], falling with slip, ANCF tires the thesis' 0.6, and all of
    them 0.6 in the scenario that the thesis drives with it. [fe] friction is that of the static runs.
    """

    friction: Annotated[Number, Positive] | None = None
    """Of every tire under the rover [-]; each tire's own without it."""
