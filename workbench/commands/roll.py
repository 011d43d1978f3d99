"""``workbench roll``: the study's wheel as thin plates rolls, falls, or rolls over a half-round; series, short table.

Verified by tests/end_to_end/test_roll.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import read_rover
from workbench.commands.computing import (
    complain_of_early_ends,
    computed,
    console,
    naming,
    read_and_warn,
    tell_kept,
    warn,
)
from workbench.execution.result_files import FAILURE, early_ends, read_result
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.ancf_wheel.motion_graph import CASES, MotionCase, motion_task
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import put_files
from workbench.report.series import SERIES_FOLDER
from workbench.study.magnitudes import above_zero
from workbench.study.reading import built_in_study

__all__ = ["RollChoices", "run_roll"]

_HEIGHT, _RADIUS, _SPEED = "10 mm", "10 mm", 70.0
_SERIES = "series.csv"
_OPEN = 0.02
"""Share by which an account of energy may be open without a word."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RollChoices:
    """What a user may choose; None for what is usual.

    Attributes
    ----------
    case : rolling, drop or half_round
    seconds : simulated [s]
    speed : of the drive [m/h]
    height : of the drop, such as ``"10 mm"``
    radius : of the half-round, such as ``"10 mm"``
    load : weight on the ground [N]
    """

    case: str = "rolling"
    seconds: float | None = None
    speed: float | None = None
    height: str | None = None
    radius: str | None = None
    load: float | None = None

    def __post_init__(self) -> None:
        for name, of in (("speed", ("rolling", "half_round")), ("height", ("drop",)), ("radius", ("half_round",))):
            value = getattr(self, name)
            if value is not None and self.case in CASES and self.case not in of:
                raise InputError(name, str(value), f"is of no use to --case {self.case}", "leave it out")

    def asked(self) -> MotionCase:
        """In SI; the load is that of a wheel of the thesis' rover on Mars where none is given."""
        rover = read_rover()
        return MotionCase(
            case=self.case,
            seconds=CASES.get(self.case, 1.0) if self.seconds is None else self.seconds,
            speed=(_SPEED if self.speed is None else self.speed) / 3600.0,
            height=above_zero(
                "height", _HEIGHT if self.height is None else self.height, "m", "fe.obstacle.height", _HEIGHT
            ),
            radius=above_zero(
                "radius", _RADIUS if self.radius is None else self.radius, "m", "fe.obstacle.radius", _RADIUS
            ),
            load=rover.static_load if self.load is None else self.load,
            gravity=rover.gravity,
        )


def run_roll(study_path: Path | None, choices: RollChoices, out: Path, store: Path) -> int:
    """Move the wheel, write ``series/roll_{case}.csv``, print what it comes to.

    Raises
    ------
    InputError
        For choices and studies that cannot be used.
    RunError
        If the motion stops early; its series is written, marked partial.
    """
    asked, path = choices.asked(), study_path or built_in_study()
    study, file = read_and_warn(path), f"{SERIES_FOLDER}/roll_{choices.case}.csv"
    check_folder(out)
    check_targets(out, (file,))
    with naming(path):
        task = motion_task(study, asked)
    entry = computed(path, [task], store, Computing(workers=1))[task.name]
    tell_kept(put_files(out, {file: (entry.path / _SERIES).read_bytes()}, "roll"))
    found = read_result(entry.path)
    _print(study.title, asked, found)
    warn(path, _doubts(asked, found))
    console.print(f"series: {out / file}", soft_wrap=True)
    complain_of_early_ends(path, early_ends({task.name: entry.path}))
    return 0


def _print(title: str, asked: MotionCase, found: Mapping[str, Any]) -> None:
    table = empty_table(f"{title}: {asked.words}", ("quantity", "value"), texts=["quantity"])
    rows = {
        "weight on the ground": f"{asked.load:.1f} N",
        "simulated": f"{found['end_s']:.3g} s in {found['steps']} steps, {found['dofs']} unknowns",
        "largest load": f"{found['largest_load_N']:.1f} N",
        "load at the end": f"{found['last_load_N']:.1f} N",
        "account of energy is open by": _open(found),
    }
    if found[FAILURE] is None:
        rows["processor time over simulated time"] = f"{found['cpu_s'] / found['end_s']:.3g}"
    for row in rows.items():
        table.add_row(*row)
    console.print(table)


def _open(found: Mapping[str, Any]) -> str:
    return f"{100.0 * found['account']:.2g} % of its largest part, {found['account_J']:.2g} J"


def _doubts(asked: MotionCase, found: Mapping[str, Any]) -> list[str]:
    """What a reader of the table would take for more than it is."""
    doubts = []
    if not found["reached"]:
        what = "the half-round" if asked.case == "half_round" else "the ground"
        doubts.append(f"the wheel did not come to {what} in {found['end_s']:.3g} s: give more --seconds")
    elif asked.case == "drop" and found["last_load_N"] >= found["largest_load_N"]:
        doubts.append("the load still rises at the end: its largest lies later, give more --seconds")
    if found["account"] > _OPEN:
        doubts.append(
            f"the account of energy is open by {_open(found)}: the loads are not to be trusted to more than that"
        )
    return doubts
