"""``workbench modes``: natural frequencies and modes of the study's wheel, free, held at its hub, or standing.

Verified by tests/end_to_end/test_modes.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from contracts.modes import DIRECTIONS
from workbench.commands.computing import computed, console, naming, read_and_warn, tell_kept, warn
from workbench.commands.stiffness import check_orientation
from workbench.execution.result_files import read_result
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.modes.graph import COMPARED, LOAD, MODELS, AskedModes, modes_name, modes_tasks
from workbench.questions.modes.kinds import ModeKind, mode_kinds
from workbench.questions.modes.mode_file import FIELDS, MODES, KeptModes, read_modes
from workbench.questions.modes.picture import PICTURE
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import publish
from workbench.study.model import Study
from workbench.study.orientation import degrees
from workbench.study.reading import built_in_study

__all__ = ["ModeChoices", "doubts_of", "run_modes"]

_BOTH = "both"
_IN_TABLE = (1.0, 1.0, 1.0, 1e3, 1e3, 1e3)
"""From kg and kg m^2 to the table's kg and g m^2."""
_ALIKE = 0.5
"""Criterion below which a pair is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeChoices:
    """What a user may choose; None for what is usual.

    Attributes
    ----------
    model : fe, ancf_wheel or both
    state : free, held or standing
    load : on a wheel that stands [N]
    orientation : what of it faces the ground [deg]
    count : of modes
    grip : whether points that touch the ground stick to it
    """

    model: str = "fe"
    state: str = "held"
    load: float | None = None
    orientation: float | None = None
    count: int = 10
    grip: bool = False

    @property
    def models(self) -> tuple[str, ...]:
        """Names of models."""
        return MODELS if self.model == _BOTH else (self.model,)

    def asked(self, study: Study) -> AskedModes:
        """With what is usual where nothing is given."""
        for name, value in (("load", self.load), ("orientation", self.orientation)):
            if value is not None and self.state in ("free", "held"):
                raise InputError(name, f"{value:g}", f"is of no use to --state {self.state}", "leave it out")
        if self.orientation is not None:
            check_orientation(self.orientation)
        if self.load is not None and self.load > study.fe.max_load:
            rule = f"must be at most fe.max_load, {study.fe.max_load:g} N, at which the study's curves end"
            raise InputError("load", f"{self.load:g} N", rule, "raise fe.max_load")
        stands = self.state == "standing"
        faces = degrees(study.fe.orientations[0]) if self.orientation is None else self.orientation
        return AskedModes(
            state=self.state,
            load=(LOAD if self.load is None else self.load) if stands else 0.0,
            orientation_deg=faces if stands else 0.0,
            count=self.count,
            grip=self.grip,
        )


def run_modes(study_path: Path | None, choices: ModeChoices, out: Path, store: Path, computing: Computing) -> int:
    """Find the modes; print them, write ``modes/modes_{model}_{name}.csv``, ``.vtu`` and ``.png``; by both, pair them.

    The name is that of the state, see `AskedModes`.

    Raises
    ------
    InputError
        For choices and studies that cannot be used.
    RunError
        If the wheel does not come to stand, or modes are not found.
    """
    path = study_path or built_in_study()
    study = read_and_warn(path)
    with naming(path):
        asked = choices.asked(study)
        tasks = modes_tasks(study, choices.models, asked)
    check_folder(out)
    check_targets(out, ("modes/any",))
    folders = {name: entry.path for name, entry in computed(path, tasks, store, computing).items()}
    texts, copies, doubts = dict[str, str](), dict[str, Path](), list[str]()
    if asked.state == "standing" and study.fe.friction:
        doubts.append("[fe] friction is left out while the wheel is loaded; --grip lets touching points stick in modes")
    for model in choices.models:
        folder = folders[modes_name(model, asked)]
        kept = read_modes(folder / MODES)
        kinds = mode_kinds(kept)
        name = f"modes/modes_{model}_{asked.name}"
        texts[f"{name}.csv"] = _csv(kept, kinds)
        copies |= {f"{name}.vtu": folder / FIELDS, f"{name}.png": folder / PICTURE}
        _print(f"{study.title} by {model}: {asked.words}", kept, kinds)
        if (count := int((~kept.modes.rigid).sum())) > asked.count:
            console.print(f"mode {len(kinds)} is more than the {count - 1} asked for: it is a pair with the one before")
        doubts += doubts_of(model, kept)
    if len(choices.models) > 1:
        rows = read_result(folders[COMPARED])["rows"]
        texts[f"modes/modes_compared_{asked.name}.csv"] = _compared_csv(rows)
        _print_compared(rows)
    tell_kept(publish(out, f"modes {choices.model} {asked.name}", texts, copies=copies))
    warn(path, doubts)
    console.print(f"tables, fields, pictures: {out / 'modes'}", soft_wrap=True)
    return 0


def _csv(kept: KeptModes, kinds: Sequence[ModeKind]) -> str:
    modes = kept.modes
    lines = [
        "mode,frequency_Hz,growth_1_s,kind,waves,part,part_share,parity,"
        + ",".join(f"participation_{d}" for d in DIRECTIONS)
        + ","
        + ",".join(f"effective_mass_{d}" for d in DIRECTIONS)
    ]
    for i, kind in enumerate(kinds):
        numbers = [*modes.participation[i], *modes.effective_mass[i]]
        name = kind.name if not kind.direction else f"rigid_{kind.direction}"
        lines.append(
            f"{i + 1},{modes.frequency[i]:.12g},{modes.growth[i]:.12g},{name},{kind.waves},{kind.part},"
            f"{kind.share:.6g},{int(modes.parity[i])}," + ",".join(f"{value:.12g}" for value in numbers)
        )
    return "\n".join(lines) + "\n"


def _compared_csv(rows: Sequence[Mapping[str, Any]]) -> str:
    lines = ["fe_mode,ancf_wheel_mode,fe_frequency_Hz,ancf_wheel_frequency_Hz,difference,mac"]
    for row in rows:
        numbers = ",".join(f"{row[name]:.12g}" for name in ("fe_Hz", "ancf_wheel_Hz"))
        lines.append(f"{row['fe'] + 1},{row['ancf_wheel'] + 1},{numbers},{_difference(row):.12g},{row['mac']:.12g}")
    return "\n".join(lines) + "\n"


def _difference(row: Mapping[str, Any]) -> float:
    """Of frequencies, over that of finite elements; 0 where that is none."""
    return float(row["ancf_wheel_Hz"] / row["fe_Hz"] - 1.0) if row["fe_Hz"] else 0.0


def _print(title: str, kept: KeptModes, kinds: Sequence[ModeKind]) -> None:
    """A row a mode, its effective masses in per cent of what moves, and their sums."""
    modes = kept.modes
    table = empty_table(title, ("mode", "frequency", "kind", *DIRECTIONS), texts=["kind"])
    share = 100.0 * modes.effective_mass / modes.moving
    for i, kind in enumerate(kinds):
        value = f"{modes.frequency[i]:.2f} Hz" if modes.growth[i] == 0.0 else f"+{modes.growth[i]:.3g}/s"
        table.add_row(f"{i + 1}", value, kind.words, *(_per_cent(one) for one in share[i]))
    table.add_row("", "", "sum, %", *(_per_cent(one) for one in share.sum(axis=0)))
    table.add_row("", "", "kg; g m^2", *(f"{m:.3g}" for m in modes.moving * _IN_TABLE))
    console.print(table)
    console.print("x to rz: effective mass and inertia, % of what moves (last row), along and about the axes")


def _per_cent(value: float) -> str:
    return "." if value < 0.05 else f"{value:.1f}" if value < 99.95 else f"{value:.0f}"


def _print_compared(rows: Sequence[Mapping[str, Any]]) -> None:
    columns = ("fe", "ancf_wheel", "fe frequency", "ancf_wheel frequency", "difference", "MAC")
    table = empty_table("the same modes by both models", columns, texts=[])
    for row in rows:
        alike = row["mac"] >= _ALIKE
        table.add_row(
            f"{row['fe'] + 1}",
            f"{row['ancf_wheel'] + 1}",
            f"{row['fe_Hz']:.2f} Hz",
            f"{row['ancf_wheel_Hz']:.2f} Hz",
            f"{100.0 * _difference(row):+.2f} %" if alike else "no pair",
            f"{row['mac']:.4f}",
        )
    console.print(table)


def doubts_of(model: str, kept: KeptModes) -> list[str]:
    """What is wrong with the state."""
    count = kept.modes.unstable
    if not count:
        return []
    fastest = kept.modes.growth.max()
    modes = "one mode grows" if count == 1 else f"{count} modes grow"
    return [
        f"{model}: the wheel does not stand here, it has buckled or snapped: {modes}, the fastest by a factor e in "
        f"{1e3 / fastest:.3g} ms; its tangent has as many negative eigenvalues"
    ]
