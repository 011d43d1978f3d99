"""Question: the rover on six ANCF tires beside the one on brush tires, figure by figure of the thesis.

Verified by tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from contracts.errors import InputError
from contracts.records import Check, Role
from contracts.series import TimeSeries
from workbench.execution.task import Task
from workbench.questions.model_curves import model_curves
from workbench.questions.question import Question
from workbench.questions.rover.drive import Drive, read_drive
from workbench.questions.rover_ancf.figures import rover_ancf_figures
from workbench.questions.rover_ancf.results import OBSERVED, AncfRover
from workbench.questions.rover_mission.requirements import mission_checks
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.model_parameters import fits_rover, on_tire_of_thesis, rover_ancf, rover_on_ancf
from workbench.study.sections import runs_on_ancf_tires
from workbench.verdict.rules import Claim, at_least, at_most, near

__all__ = ["LONG", "ROVER_ANCF", "SHORT", "runs_of"]

SHORT = {
    "static": 2.0,
    "drop": 1.0,
    "load_sweep": 5.0,
    "load_sweep_between": 5.0,
    "straight": 13.0,
    "traction": 10.0,
    "traction_half_step": 10.0,
    "traction_fine_grid": 9.0,
    "slope_up": 2.0,
    "slope_down": 2.0,
    "slope_across": 2.0,
    "step": 4.0,
}
LONG = {"traction_undamped": 15.0, "traction_whole": 120.0, "crevasse": 40.0, "point_turn": 16.0, "rocks": 11.0}
"""Run -> processor time it takes about [s]; names as in `workbench.questions.rover_ancf.runs`."""
_ACCOUNT = {"account": True}
_KEPT: Mapping[str, Mapping[str, object]] = {
    "straight": {**_ACCOUNT, "pressed_at": [0.0, 15.0]},
    "traction": _ACCOUNT,
    "traction_undamped": _ACCOUNT,
}
"""What is kept beside the series, see the task: energy and momentum accounted for, close looks."""


def runs_of(study: Study) -> Sequence[str]:
    """Names of the runs a study asks for."""
    return runs_on_ancf_tires(study.rover, SHORT, LONG)


def _tasks(study: Study) -> Sequence[Task]:
    tires = rover_on_ancf(study)
    return [
        Task(
            name=f"rover_ancf_{name}",
            function="workbench.questions.rover_ancf.task:drive_on_ancf_tires",
            inputs={"run": name, **tires, **_KEPT.get(name, {})},
            cost=(SHORT | LONG)[name],
            resumable=True,
        )
        for name in runs_of(study)
    ]


def _read(study: Study, folders: Mapping[str, Path]) -> AncfRover:
    brush = [name for name in (*SHORT, *LONG) if f"rover_{name}" in folders]
    return AncfRover(
        runs={name: read_drive(folders[f"rover_ancf_{name}"], name, "ancf") for name in runs_of(study)},
        brush={name: read_drive(folders[f"rover_{name}"], name, "brush") for name in brush},
        fe=model_curves("fe", folders, around(study)).average,
        preset=rover_ancf(study),
        friction=study.ground.friction,
        of_thesis=on_tire_of_thesis(study),
    )


def _claim(name: str, title: str, quantity: str, unit: str, source: str, *, gate: bool = False) -> Claim:
    role: Role = "gate" if gate else "finding"
    title = f"Rover on ANCF tires, {title}"
    return Claim(id=f"rover_ancf.{name}", title=title, quantity=quantity, unit=unit, role=role, source=source)


def _checks(study: Study, results: AncfRover) -> Sequence[Check]:
    thesis = "Samarini 2020, section 3"
    source = "320 kg on Mars, six wheels"
    gate = _carries(results, "static")
    load = _claim("load", "static equilibrium", "mean wheel load", "N", source, gate=gate)
    times = _claim(
        "period",
        "straight path: period of the deflection",
        "period",
        "s",
        "the angle between two spokes, a quarter turn of four, at the measured spin",
        gate=results.of_thesis,
    )
    speed = _claim("speed", "straight path: speed between 15 and 35 s", "speed", "m/s", f"{thesis}, Fig. 23")
    drop = _claim("drop", "drop of 10 mm: the tires carry the rover", "time reached", "s", f"{thesis}, Figs 18 and 19")
    checks = [
        near(load, lambda: results["static"].value("mean wheel load at the end"), 197.92, 2e-3),
        near(times, lambda: results.deflection_period, results.number("spoke_turn") or 0.0, 0.02),
        near(speed, lambda: results["straight"].value("mean speed between 15 and 35 s"), 70.0 / 3600.0, 0.05),
        at_least(drop, partial(_reached, results["drop"]), 1.0),
        *_traction_checks(results, thesis),
    ]
    return [
        *checks,
        *_account_checks(results),
        *_sweep_checks(results),
        *mission_checks(results.requirements, "rover_ancf.mission_", "Rover on ANCF tires"),
    ]


def _carries(results: AncfRover, name: str) -> bool:
    """Whether the run came to its end, or is that of the thesis' tires, which must; else what it lacks is a finding."""
    return results.of_thesis or results[name].stopped is None


_CLOSED = {"energy": 1e-3, "momentum": 3e-4}
"""What may be missing of either."""


def _account_checks(results: AncfRover) -> list[Check]:
    """Energy and momentum of whole motions; what contact damping takes of the drives' work."""
    checks = []
    for name, words in (("straight", "straight path"), ("traction", "3.5 N m")):
        for what in ("energy", "momentum"):
            title = f"{words}: {what} is accounted for"
            gate = _carries(results, name)
            claim = _claim(f"{name}_{what}", title, "what is missing", "-", "laws of conservation", gate=gate)
            checks.append(at_most(claim, partial(results[name].closure, what), _CLOSED[what]))
    return checks


def _reached(drive: Drive) -> float:
    """Last time of a motion [s]."""
    drive.column(f"{OBSERVED}_load_N")
    assert drive.series is not None
    return float(drive.series.time[-1])


def _traction_checks(results: AncfRover, thesis: str) -> list[Check]:
    ancf = _claim(
        "ripple", "3.5 N m: tractive force oscillates", "rms of the force's ripple", "N", f"{thesis}, Fig. 25"
    )
    checks = [at_least(ancf, lambda: results.force_ripple("traction"), 1.0)]

    def kept(name: str) -> float:
        return results.force_ripple(f"traction_{name}") / results.force_ripple("traction")

    for name, what in (("half_step", "half the step"), ("fine_grid", "twice the contact points")):
        claim = _claim(
            f"ripple_{name}",
            f"3.5 N m, {what}: the ripple stays",
            "rms over that of before",
            "-",
            f"{thesis}.5: 100 contact points a plate",
        )
        checks.append(near(claim, partial(kept, name), 1.0, 0.2))
    return checks


def _sweep_checks(results: AncfRover) -> list[Check]:
    """How far the deflections lie off the FE average over the sweep."""
    claim = _claim(
        "sweep",
        "load sweep, on and between spokes: largest distance from the FE average",
        "difference / deflection of the FE average",
        "-",
        "Samarini 2020, Fig. 22",
    )

    def largest() -> float:
        misses = [abs(d / fe - 1.0) for _, _, d, fe in results.sweep if np.isfinite(fe)]
        if not misses:
            raise InputError("load sweep", "no load", "is shared with the FE average", "raise fe.max_load")
        return max(misses)

    return [at_most(claim, largest, 0.10)]


def _series(study: Study, results: AncfRover) -> Sequence[TimeSeries]:
    return [drive.series for drive in results.runs.values() if drive.series is not None]


ROVER_ANCF = Question(
    name="rover_ancf",
    title="Rover on ANCF tires",
    group="Rover",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=rover_ancf_figures,
    series=_series,
    applies=lambda study: bool(runs_of(study)) and fits_rover(study),
    budget=860,
)
