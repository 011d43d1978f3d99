"""Wheel loads at rest against the place of the principal body's centre of mass.

The references are statics of the rover on rigid wheels, printed to 0.1 N. The tires' deflection pitches the rover and
shifts its weight further: Table II's tires differ by up to 1.9 N, rigid ones by less than the last digit.

Verified by tests/verification/test_rover_statics.py and tests/verification/test_rover_rigid.py.
"""

from __future__ import annotations

from dataclasses import replace

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.ground import on_rigid_tires
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.scenario import Scenario, run_scenario

__all__ = ["FRAME_X", "OFFSETS", "loads_against_offset", "with_offset"]

OFFSETS = (
    (-0.10, 162.3, 269.3),
    (0.0, 184.2, 225.3),
    (0.0623, 197.92, 197.92),
    (0.10, 206.2, 181.3),
    (0.14, 215.0, 163.7),
)
"""Centre of mass ahead of the principal body's frame [m]; load on Mars of a front or centre and of a rear wheel [N]."""
FRAME_X = -0.0825
"""Place of the principal body's frame [m]."""


def loads_against_offset(scenario: Scenario, design: RoverDesign) -> tuple[Outcome, ...]:
    """Of the scenario's tires and of rigid ones, wheels free; with references for the rover that ships."""
    models = {scenario.tire_model: scenario, "rigid": on_rigid_tires(scenario)}
    return tuple(one for tired in models.values() for one in _loads(tired, design))


def with_offset(design: RoverDesign, offset: float) -> RoverDesign:
    """The rover with the principal body's centre of mass that far ahead of its frame [m]."""
    if not any(body.name == "principal" for body in design.bodies):
        raise InputError("bodies of the rover", design.name, "have none named principal", "name its main body so")
    moved = [
        replace(body, position=(FRAME_X + offset, *body.position[1:])) if body.name == "principal" else body
        for body in design.bodies
    ]
    return replace(design, bodies=tuple(moved))


def _loads(scenario: Scenario, design: RoverDesign) -> list[Outcome]:
    shipped, found = read_rover(), []
    known = replace(design, name=shipped.name, gravity=shipped.gravity) == shipped
    for offset, front, rear in OFFSETS:
        run = run_scenario(replace(scenario, settles=8.0, lasts=0.1), with_offset(design, offset))
        for end, load in (("front", front), ("center", front), ("rear", rear)):
            at = [k for k, leg in enumerate(design.legs) if leg.name.startswith(end)]
            if at:
                words = (
                    f"{scenario.tire_model} tires, {end} wheel, centre of mass {1e3 * offset:g} mm ahead of the frame"
                )
                reference = load * design.gravity / shipped.gravity if known else None
                value = float(run.loads[-1, at].mean())
                found.append(Outcome(quantity=words, value=value, unit="N", reference=reference))
    return found
