"""A parked rover has every drive held, whatever moves it; steering stays as it is."""

from __future__ import annotations

import pytest

from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.parking import parked

DESIGN = read_rover()
DRIVES = {f"drive_{leg.name}" for leg in DESIGN.legs}


@pytest.mark.parametrize("name", ["straight", "traction", "static", "point_turn"])
def test_every_drive_is_held(name: str) -> None:
    """By law, by torque and free; negative control: before, none of them is."""
    scenario = SCENARIOS[name]

    def held(vehicle_of: object) -> set[str]:
        model = vehicle_of.vehicle(DESIGN).model  # type: ignore[attr-defined]
        return {drive.joint for drive in model.drives if drive.joint in DRIVES and isinstance(drive.law, Hold)}

    assert held(parked(scenario)) == DRIVES
    assert not held(scenario)
    assert not parked(scenario).vehicle(DESIGN).efforts


def test_steering_keeps_its_laws() -> None:
    own, still = (one.actuators(DESIGN).laws for one in (SCENARIOS["point_turn"], parked(SCENARIOS["point_turn"])))
    steering = {name: law for name, law in own.items() if name.startswith("steer_")}
    assert steering
    assert {name: still[name] for name in steering} == steering
