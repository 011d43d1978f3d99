"""What the rover is compared at between our code and EXUDYN, and the limits; see `rover_of_file` for the model there.

Ours are the scenarios of `rover_dynamics.rover.scenarios` with a hundred times smaller error a step, theirs the same
rover from the file, with steps as long as change nothing of the limits' size. Both start pressed in by the mean
deflection and keep the same history of the bristles: what a braked wheel holds on a slope depends on it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.peer_codes.rover_of_file import Law, PeerMotion, PeerRover, peer_motion, rover_content
from rover_dynamics.multibody.implicit_steps import ImplicitSteps
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.level_ground import all_drives
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.vehicle.vehicle import drive_vehicle

__all__ = ["CASES", "Case", "our_run", "peer_run", "rows"]

FloatArray = NDArray[np.float64]
FINE = ImplicitSteps(tolerance=0.01 * ImplicitSteps().tolerance)
SPEED, ACCELERATES = 70.0 / 3600.0, 5.0
"""The thesis' speed [m/s], reached in [s]."""
REST, PATH, DROP = 1e-3, 0.016, 4.5e-6
"""Limits [N], [N], [m]: what an earlier model in EXUDYN, written apart from this one, differed by."""
ROUNDING = 1e-9
"""Of a time [s]."""
UNITS = {"loads": "N", "tractive": "N", "place": "m"}
QUANTITIES = {"loads": "wheel load", "tractive": "tractive force", "place": "place of the body"}
ANGLE = math.radians(25.0)
DOWNHILL = {"up": (-1.0, 0.0), "down": (1.0, 0.0), "across": (0.0, -1.0)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One run of both codes.

    Attributes
    ----------
    words : of the table
    scenario : ours
    downhill : direction in the ground's plane of a slope of 25 degrees, x ahead and y left; none on level ground
    steps : EXUDYN's, see `peer_motion`
    drives : "held", "free" or "driven" at the thesis' speed
    since : time from which the two are compared, from the scenario's time zero [s]
    limits : largest difference allowed, by what is compared: loads, tractive [N], place [m]
    """

    words: str
    scenario: Scenario
    downhill: tuple[float, float] = (0.0, 0.0)
    steps: tuple[tuple[float, float], ...]
    drives: str
    since: float
    limits: Mapping[str, float]


def _slope(name: str) -> Scenario:
    return SCENARIOS[f"slope_{name}"]


def _braked(name: str) -> Scenario:
    held = replace(_slope(name), actuators=lambda rover: all_drives(rover, Hold()))
    return replace(held, settles=0.0, lasts=20.0, every=1.0)


_SETTLING = ((0.2, 5e-4), (1.0, 2.5e-3))
_STICKING = ((0.2, 5e-4), (4.0, 5e-3))
"""Downhill the rear wheels come within 2 % of sliding, where longer steps do not converge."""
_WAYS = {"up": _SETTLING, "down": _STICKING, "across": _SETTLING}
CASES = {
    "level": Case(
        words="at rest on level ground, wheels free",
        scenario=replace(SCENARIOS["static"], settles=0.0, lasts=20.0, every=1.0),
        steps=((2.0, 0.02), (20.0, 0.1)),
        drives="free",
        since=20.0,
        limits={"loads": REST},
    ),
    **{
        f"rest_{name}": Case(
            words=f"braked on 25 degrees {name}",
            scenario=_braked(name),
            downhill=DOWNHILL[name],
            steps=(*steps, (20.0, 0.05)),
            drives="held",
            since=20.0,
            limits={"loads": REST},
        )
        for name, steps in _WAYS.items()
    },
    "drop": Case(
        words="drop of 10 mm, 1 s",
        scenario=replace(SCENARIOS["drop"], lasts=1.0, every=0.01, closer=None),
        steps=((0.07, 0.01), (0.2, 5e-4), (1.0, 5e-3)),
        drives="held",
        since=0.0,
        limits={"place": DROP},
    ),
    **{
        f"drop_{name}": Case(
            words=f"drop of 10 mm, braked, on 25 degrees {name}, 1 s",
            scenario=replace(_braked(name), height=0.01, lasts=1.0, every=0.01),
            downhill=DOWNHILL[name],
            steps=((0.05, 5e-3), (0.3, 2.5e-4), (1.0, 2.5e-3)),
            drives="held",
            since=0.0,
            limits={"place": DROP},
        )
        for name in ("up", "across")
    },
    "straight": Case(
        words="straight path at 70 m/h, 15 s",
        scenario=replace(SCENARIOS["straight"], settles=0.0, lasts=15.0),
        steps=((0.2, 1e-3), (15.0, 0.02)),
        drives="driven",
        since=0.0,
        limits={"loads": PATH},
    ),
    **{
        f"drive_{name}": Case(
            words=f"driven on 25 degrees {name}, 10 s",
            scenario=replace(_slope(name), lasts=10.0, every=0.1),
            downhill=DOWNHILL[name],
            steps=(*steps, (15.0, 0.05)),
            drives="driven",
            since=0.0,
            limits={"loads": PATH, "tractive": PATH},
        )
        for name, steps in _WAYS.items()
    },
}


def our_run(case: Case) -> ScenarioRun:
    """The scenario in small steps."""
    fine = replace(case.scenario, ride=lambda s, design: drive_vehicle(s.vehicle(design), s.times(), FINE))
    return run_scenario(fine, read_rover())


def peer_run(case: Case, file: Mapping[str, Any] | None = None, tire: Mapping[str, Any] | None = None) -> PeerMotion:
    """The same in EXUDYN, of a file with another content or with other numbers of the tire where given."""
    content = file or rover_content()
    x, y, angle = *case.downhill, ANGLE if any(case.downhill) else 0.0
    g = float(content["gravity"])
    drives: str | Law = case.drives
    if case.drives == "driven":
        drives = _law(SPEED / content["wheel"]["radius"], case.scenario.settles)
    rover = PeerRover(
        file=content,
        gravity=(g * math.sin(angle) * x, g * math.sin(angle) * y, -g * math.cos(angle)),
        height=case.scenario.height,
        drives=drives,
        tire=tire or {},
    )
    return peer_motion(rover, case.steps)


def _law(speed: float, begins: float) -> Law:
    """Speed that rises by 3 s^2 - 2 s^3, and its integral."""

    def at(t: float) -> tuple[float, float]:
        s = min(max((t - begins) / ACCELERATES, 0.0), 1.0)
        after = max(t - begins - ACCELERATES, 0.0)
        return speed * (ACCELERATES * (s**3 - 0.5 * s**4) + after), speed * s * s * (3.0 - 2.0 * s)

    return at


def rows(case: Case, ours: ScenarioRun, peer: PeerMotion) -> list[dict[str, Any]]:
    """What is compared, each where the two are furthest apart, as `workbench.questions.rover.peer.PeerRow` [SI]."""
    times = ours.motion.times + case.scenario.settles
    late = ours.motion.times >= case.since - ROUNDING
    at = np.abs(peer.times[:, None] - times[late]).argmin(axis=0)
    if np.abs(peer.times[at] - times[late]).max() > ROUNDING:
        raise ValueError(f"{case.words}: EXUDYN's steps miss our samples")
    found = []
    for name, limit in case.limits.items():
        a, b = getattr(ours, name)[late], getattr(peer, name)[at]
        worst = np.unravel_index(np.abs(a - b).argmax(), a.shape)
        values = {"ours": float(a[worst]), "peer": float(b[worst]), "difference": float(abs(a - b)[worst])}
        words = {"key": name, "case": case.words, "quantity": QUANTITIES[name], "unit": UNITS[name]}
        found.append({**words, **values, "limit": limit})
    return found
