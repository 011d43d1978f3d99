"""What a study says about the rover. Verified by tests/unit/test_workbench_rover_ancf.py."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from workbench.study.section import Section

__all__ = ["RoverSection", "runs_on_ancf_tires"]


class RoverSection(Section):
    """What the rover does on six ANCF tires in the report, beside its runs on brush tires.

    Nothing, the thesis' scenarios and the quick ones of the mission's (about a minute), or all of them, as `workbench
    report --full` does (some minutes more).
    """

    on_ancf_tires: Literal["none", "short", "all"] = "short"
    """Runs on flexible tires beside those on brush tires: none, the thesis' and quick ones, all."""


def runs_on_ancf_tires(rover: RoverSection | None, short: Iterable[str], long: Iterable[str]) -> tuple[str, ...]:
    """Which of the short and the long runs a study asks for."""
    asked = "none" if rover is None else rover.on_ancf_tires
    return {"none": (), "short": tuple(short), "all": (*short, *long)}[asked]
