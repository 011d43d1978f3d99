"""What a run on ANCF tires says of one of the mission's requirements.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from dataclasses import dataclass

from rover_dynamics.rover.scenarios.outcome import Outcome

__all__ = ["MissionRow"]


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionRow:
    """One requirement.

    Attributes
    ----------
    name, title : of the scenario, ``"slope_up"``, and what it is called
    quantity : what is required
    ours : number found on ANCF tires; None where the run stopped or nothing is required
    theirs : the same on brush tires; None where there is no such run
    stopped : why the run on ANCF tires stopped, if ``ours`` is None for that
    """

    name: str
    title: str
    quantity: str
    ours: Outcome | None = None
    theirs: Outcome | None = None
    stopped: str | None = None
