"""Task: one run of the rover on six ANCF tires of the study.

Verified by tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ancf_reduced.motion.vector_coordinates import with_reference_node
from ancf_reduced.tire.mesh import Tire
from contracts.csv_table import CsvTable, table_text
from contracts.errors import ConvergenceError, InputError
from contracts.series import TimeSeries, write_series
from rover_dynamics.flexible.account import COLUMNS, FlexibleAccount
from rover_dynamics.flexible.flexible_system import FlexibleSystem
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.scenario_series import scenario_series
from workbench.execution.result_files import write_result
from workbench.questions.rover.close_look import write_close_look
from workbench.questions.rover.motion_file import MOTION, write_motion
from workbench.questions.rover.tire_shapes import Watch
from workbench.questions.rover.tires import resuming, watching
from workbench.questions.rover_ancf.runs import ancf_run
from workbench.study.ancf_tire import tire_from, tire_values

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["ACCOUNT", "SERIES", "drive_on_ancf_tires"]

SERIES, ACCOUNT = "series.csv", "account.csv"
_ROWS = 400
"""Of the account's file, about."""
_EACH = 5
"""Sample of a closely sampled motion that its series keeps: a tenth of a second apart."""


def drive_on_ancf_tires(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """``result.json`` with outcomes, mean spins of the wheels and why it stopped, ``series.csv`` and ``motion.npz``.

    The inputs hold the tire, see `workbench.study.ancf_tire`, and the ground's ``friction`` or None. A motion that
    stops early keeps its series and has no outcomes; one that stops before time zero, or cannot begin on these tires,
    has neither.
    Goes on from the motion in ``checkpoint``, if there is one. With ``account`` in the inputs also ``account.csv`` and
    in the result how far energy and momentum close, from time zero or where the motion went on from; with
    ``pressed_at``, times [s], what `write_close_look` keeps, and the series has every fifth sample only.
    """
    design, tire = read_rover(), tire_from(inputs)
    closely = "pressed_at" in inputs
    run = _drive(
        ancf_run(inputs["run"], design, tire, inputs["friction"]),
        design,
        out,
        checkpoint,
        accounted=bool(inputs.get("account")),
        every=_EACH if closely else 1,
    )
    if run is not None:
        write_motion(run, out / MOTION, tire_values(tire.preset, tire.mesh))
        if closely:
            write_close_look(run, inputs["run"], tire, inputs["pressed_at"], out)
    return _unknowns(tire)


def _unknowns(tire: Tire) -> int:
    """Of all six tires."""
    return 6 * 3 * with_reference_node(tire.tie).n_vectors


def _drive(
    scenario: Scenario,
    design: RoverDesign,
    out: Path,
    checkpoint: Path | None,
    *,
    accounted: bool = False,
    every: int = 1,
) -> ScenarioRun | None:
    """The run, its files written, the series with one of so many samples; None if it ended before time zero."""
    accounts: list[FlexibleAccount] = []

    def account(system: FlexibleSystem) -> Watch:
        accounts.append(FlexibleAccount(system))
        return accounts[-1].watch

    scenario = resuming(watching(scenario, account) if accounted else scenario, checkpoint)
    try:
        run = run_scenario(scenario, design)
    except (ConvergenceError, InputError) as error:  # a tire that folds at once, or weighs more than its wheel
        write_result(out, {"outcomes": [], "spins": [], "stopped": str(error), "steps": 0})
        return None
    write_series(_thinned(scenario_series(run), every), out / SERIES)
    outcomes = () if run.stopped else scenario.judge(run)
    numbers = {"outcomes": [asdict(outcome) for outcome in outcomes], "spins": _spins(run), "stopped": run.stopped}
    numbers |= {"steps": run.motion.steps, "closures": [_write_account(one, out / ACCOUNT) for one in accounts]}
    write_result(out, numbers)
    return run


def _thinned(series: TimeSeries, every: int) -> TimeSeries:
    """One of so many samples, from the first on, and the last."""
    kept = np.unique(np.append(np.arange(0, len(series.time), every), len(series.time) - 1))
    columns = {name: values[kept] for name, values in series.columns.items()}
    return replace(series, time=series.time[kept], columns=columns)


def _write_account(account: FlexibleAccount, path: Path) -> dict[str, float]:
    """Energies [J] over time, thinned; closures of energy and momentum over all steps [-]."""
    every = max(1, len(account.times) // _ROWS)
    rows = np.column_stack([account.times, account.table()])
    kept = np.unique(np.append(np.arange(0, len(rows), every), len(rows) - 1))
    source = "rover on ANCF tires: stored energies and, from damping on, sums since the start"
    names = ("time_s", *(f"{name}_J" for name in COLUMNS))
    table = CsvTable(names=names, values=rows[kept], source=source, partial=False)
    path.write_text(table_text(table), encoding="utf-8", newline="")
    return {"energy": account.energy_closure(), "momentum": account.momentum_closure()}


def _spins(run: ScenarioRun) -> list[float]:
    """Mean spin of each wheel while the straight path is driven at its speed, 5 to 35 s [rad/s]."""
    times = run.motion.times
    window = (times >= 5.0) & (times <= 35.0)
    return [float(spin) for spin in np.mean(run.spins[window], axis=0)] if window.any() else []
