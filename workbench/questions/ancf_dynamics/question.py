"""Question: one ANCF wheel in motion. A 10 mm drop and a ride over a half-round, both integrators, energy account.

Verified by tests/unit/test_workbench_ancf_dynamics.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.errors import InputError
from contracts.records import Check
from contracts.series import TimeSeries, read_series
from workbench.execution.result_files import read_record
from workbench.execution.task import Task
from workbench.questions.ancf_dynamics.figures import motion_figures
from workbench.questions.ancf_dynamics.results import AncfMotion, AncfMotions
from workbench.questions.question import Question
from workbench.study.model import Study
from workbench.study.model_parameters import ancf_preset, ancf_tire
from workbench.verdict.rules import Claim, at_most

if TYPE_CHECKING:
    pass

__all__ = ["ANCF_DYNAMICS"]

HUB_MASS = 25.0
"""On the hub in drop and ride [kg]: with Mars gravity 109 N on the wheel, well within what the tire carries."""
ROVER_SHARE = 48.9
"""The hub's part of a sixth of the rover, 197.92 N (Samarini 2020, section 3.1) less the plates' own 4.4 kg [kg]."""
DAMPING_RATIO, DROP, SPEED, ROCK, ROCK_AT = 0.05, 0.010, 0.5, 0.020, 0.25
CLOSURE, AGREEMENT = {"drop": 1e-4, "ride": 0.01}, 0.002
"""Energy account: 1 % of the largest energy that changes hands; integrators: 2 % of the deflection (our targets)."""


_TITLES = {
    "drop": f"drop of {1e3 * DROP:g} mm, {HUB_MASS:g} kg on the hub",
    "drop_share": f"the same with {ROVER_SHARE:g} kg, the rover's share",
    "ride": f"ride over a half-round of {1e3 * ROCK:g} mm at {SPEED:g} m/s, {HUB_MASS:g} kg on the hub",
}


_SCENARIOS = {"drop": "wheel_drop", "drop_share": "wheel_drop_share", "ride": "wheel_half_round"}
"""Motion -> its scenario's name in ``series/{scenario}_{tire}.csv``."""


def _tasks(study: Study) -> Sequence[Task]:
    preset, tire = ancf_preset(study), ancf_tire(study)
    still = {"speed": 0.0, "spin": 0.0, "rocks": [], "law": {}, "hub": [0.0, 0.0, preset.outer_radius + DROP]}
    spin = SPEED / preset.outer_radius
    law = {"damping": 2.0, "friction": 0.6, "slip_velocity": 0.1}
    rolling = {"speed": SPEED, "spin": spin, "rocks": [[ROCK, ROCK_AT]], "law": law}
    motions: dict[str, dict[str, Any]] = {
        "drop": still | {"hub_mass": HUB_MASS, "end": 0.6, "points": 120, "implicit": True},
        "drop_share": still | {"hub_mass": ROVER_SHARE, "end": 0.6, "points": 120, "implicit": False},
        "ride": rolling
        | {"hub": [0.0, 0.0, preset.outer_radius - 0.012], "hub_mass": HUB_MASS}
        | {"end": 1.0, "points": 200, "implicit": False},
    }
    common = tire | {
        "preset": tire["preset"] | {"quadrature": (4, 4, 2)},
        "hub_inertia": 0.1,
        "damping_ratio": DAMPING_RATIO,
        "drive_gain": 20.0,
    }
    return [
        Task(
            name=f"ancf_{name}",
            function="workbench.questions.ancf_dynamics.task:move_wheel",
            inputs=common | motion,
            cost=5.0,
        )
        for name, motion in motions.items()
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> AncfMotions:
    from workbench.questions.ancf_dynamics.records import MotionNumbers

    motions = []
    for name, title in _TITLES.items():
        folder = folders[f"ancf_{name}"]
        series = read_series(folder / "series.csv", _SCENARIOS[name], "ancf")
        motions.append(AncfMotion(name=name, title=title, numbers=read_record(folder, MotionNumbers), series=series))
    return AncfMotions(radius=ancf_preset(study).outer_radius, motions=tuple(motions))


def _checks(study: Study, results: AncfMotions) -> Sequence[Check]:
    checks = [
        at_most(
            Claim(
                id=f"ancf.energy_{name}",
                title=f"ANCF wheel, {results[name].title}: how far its energy account stays open",
                quantity="spread / largest energy that changes hands",
                unit="-",
                role="gate",
                source="conservation of energy; kinetic, strain, weight, contact, damping, friction and drive",
            ),
            partial(_closure, results[name]),
            CLOSURE[name],
        )
        for name in ("drop", "ride")
    ]
    agreement = Claim(
        id="ancf.integrators",
        title="ANCF wheel, drop: largest distance of the hub between explicit and implicit integration",
        quantity="difference / largest deflection",
        unit="-",
        role="gate",
        source="the same equations by RATTLE and by generalised-alpha",
    )
    drop = results["drop"]
    difference = drop.numbers.implicit_difference_m
    assert difference is not None  # the drop is integrated both ways
    checks.append(at_most(agreement, lambda: difference / results.drop_of(drop), AGREEMENT))
    return checks


def _closure(motion: AncfMotion) -> float:
    """How far the account stays open [-]; InputError if the motion stopped."""
    if motion.numbers.closure is None:
        raise InputError("motion", motion.name, f"stopped: {motion.numbers.stopped}", "see the report")
    return motion.numbers.closure


def _series(study: Study, results: AncfMotions) -> Sequence[TimeSeries]:
    return [motion.series for motion in results.motions]


ANCF_DYNAMICS = Question(
    name="ancf_dynamics",
    title="ANCF wheel in motion",
    group="ANCF tire",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=motion_figures,
    series=_series,
    applies=lambda study: study.ancf is not None,
)
