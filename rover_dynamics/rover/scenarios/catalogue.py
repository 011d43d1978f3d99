"""All scenarios by name.

Verified by tests/unit/test_rover_scenarios.py.
"""

from __future__ import annotations

from contracts.errors import InputError
from rover_dynamics.rover.scenarios.level_ground import LEVEL_GROUND
from rover_dynamics.rover.scenarios.obstacles import OBSTACLES
from rover_dynamics.rover.scenarios.point_turn import POINT_TURN
from rover_dynamics.rover.scenarios.scenario import Scenario
from rover_dynamics.rover.scenarios.slopes import SLOPES
from rover_dynamics.rover.scenarios.stability import STABILITY

__all__ = ["SCENARIOS", "scenario_named"]

SCENARIOS = {scenario.name: scenario for scenario in (*LEVEL_GROUND, *SLOPES, *OBSTACLES, POINT_TURN, STABILITY)}
"""Name -> scenario, in the order of the thesis and of its requirements."""


def scenario_named(name: str) -> Scenario:
    """The scenario of that name; raises InputError, with all names, if there is none."""
    if name not in SCENARIOS:
        raise InputError("scenario", repr(name), "is not known", f"give one of {', '.join(SCENARIOS)}")
    return SCENARIOS[name]
