"""What a study says about the rover. Verified by tests/unit/test_workbench_rover_ancf.py."""

from __future__ import annotations

from typing import Literal

from workbench.study.section import Section

__all__ = ["RoverSection"]


class RoverSection(Section):
    """What the rover does on six ANCF tires in the report.

    Nothing, the thesis' scenarios and the quick ones of the mission's (about a minute), or all of them, as `workbench
    report --full` does (some minutes more).
    """

    on_ancf_tires: Literal["none", "short", "all"] = "short"
