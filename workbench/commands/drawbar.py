"""``workbench drawbar``: the study's wheel on a single-wheel bench with soil: pull, torque and sinkage over slip.

Verified by tests/end_to_end/test_drawbar.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from contracts.errors import InputError
from rover_dynamics.rover.planets import gravity_named
from workbench.commands.computing import console, naming, read_and_warn, tell_kept, warn
from workbench.commands.soil_rim import check_soil_tire, rim_of
from workbench.commands.steps import steps_of
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.soil.bench import Bench, bench_csv, run_bench, wheel_on_soil
from workbench.questions.soil.picture import bench_png
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import put_files
from workbench.study.reading import built_in_study
from workbench.study.soil_file import soil_of
from workbench.study.wheel_design import wheel_design

__all__ = ["DrawbarChoices", "run_drawbar", "slips_of"]

_SLIPS = "0:0.6:0.1"
_MOST = 1000
_FILES = ("drawbar.csv", "drawbar.png")


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawbarChoices:
    """What a user may choose.

    Attributes
    ----------
    soil : name, or a soil's file
    load : on the wheel [N]
    slip : ``A:B:STEP`` or a number; None for 0 to 0.6 by 0.1, or for none where the wheel is towed
    tire : rigid, brush, fe or ancf_wheel
    towed : whether the wheel is towed too
    gravity : mars or earth
    """

    soil: str
    load: float
    slip: str | None = None
    tire: str = "fe"
    towed: bool = False
    gravity: str = "mars"


def run_drawbar(study_path: Path | None, choices: DrawbarChoices, out: Path, store: Path, computing: Computing) -> int:
    """Drive, print, write CSV and picture; 0."""
    check_soil_tire(choices.tire)
    soil, gravity = soil_of(choices.soil), gravity_named(choices.gravity)
    load = choices.load
    slips = slips_of(choices.slip if choices.slip is not None or choices.towed is False else "")
    path = study_path or built_in_study()
    study = read_and_warn(path)
    check_folder(out)
    check_targets(out, _FILES)
    with naming(path):
        design = wheel_design(study)
    bench = run_bench(wheel_on_soil(design), soil, load, slips, gravity, towed=choices.towed)
    if choices.tire != "rigid":  # what a rigid wheel cannot do on this soil is said before minutes of computing
        with naming(path):
            carcass = rim_of(study, choices.tire, study_path, (store, computing))
        if carcass.curve and load > carcass.curve[-1][0]:
            told = f"{load:g} N lies beyond the wheel's curves, which end at {carcass.curve[-1][0]:.3g} N"
            warn(path, [f"{told}: the rim is taken as stiff as there; raise fe.max_load or fe.max_deflection"])
        bench = run_bench(wheel_on_soil(design, carcass), soil, load, slips, gravity, towed=choices.towed)
    _print(bench, choices.tire)
    title = f"{study.name} on {soil.name} under {load:g} N, g = {gravity:g} m/s²"
    files = {_FILES[0]: bench_csv(bench).encode(), _FILES[1]: bench_png(bench, title)}
    tell_kept(put_files(out, files, "drawbar"))
    console.print(f"soil: {soil.source}", soft_wrap=True)
    console.print(f"bench: {out / _FILES[0]}, {out / _FILES[1]}", soft_wrap=True)
    return 0


def slips_of(text: str | None) -> tuple[float, ...]:
    """Slips of ``A:B:STEP``, ends included where the step meets them; of one number; none of an empty text.

    Raises
    ------
    InputError
        For another form, and slips out of [-1, 1).
    """
    if text == "":
        return ()
    given = _SLIPS if text is None else text
    found = steps_of(given, "slip", _SLIPS, _MOST)
    if found[0] < -1.0 or found[-1] >= 1.0:
        raise InputError("slip", repr(given), "must lie in [-1, 1)", "0 rolls, 1 spins on the spot")
    return tuple(found)


def _print(bench: Bench, tire: str) -> None:
    console.print(
        f"{'rigid wheel' if tire == 'rigid' else bench.carcass}; on {bench.soil}, {bench.load:g} N", soft_wrap=True
    )
    columns = ("slip", "pull N", "torque Nm", "sunk mm", "effic.", "hub mm", "rigid N", "sunk mm ")
    shown = columns if bench.carcass != "rigid" else columns[:5]
    table = empty_table("", shown, texts=[])
    for row in bench.rows:
        a, b = row.wheel, row.rigid
        cells = (
            f"{a.slip:.3g}",
            f"{a.drawbar_pull:.1f}",
            f"{round(a.torque, 2) + 0.0:.2f}",  # no minus before nothing
            f"{1e3 * a.sinkage:.1f}",
            f"{a.efficiency:.2f}",
            f"{1e3 * a.deflection:.1f}",
            f"{b.drawbar_pull:.1f}",
            f"{1e3 * b.sinkage:.1f}",
        )
        table.add_row(*cells[: len(shown)])
    console.print(table)
    if any(row.high > row.low for row in bench.rows):
        widest = max(bench.rows, key=lambda row: row.high - row.low)
        told = f"{widest.low:.1f} to {widest.high:.1f} N at slip {widest.wheel.slip:.2g}"
        console.print(f"what the soil's ranges leave open of the pull: up to {told}")
    if bench.carcass != "rigid":
        console.print(f"largest pull of the flexible wheel less that of the rigid one: {bench.gain:+.1f} N")
