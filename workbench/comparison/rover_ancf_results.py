"""Results of the rover on six ANCF tires, and what is read from them.

Verified by tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import TableRule, read_table
from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.series import TimeSeries, read_series
from rover_dynamics.flexible.account import COLUMNS
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.comparison.mission_row import MissionRow
from workbench.comparison.oscillation import period, ripple, spectrum
from workbench.execution.result_files import read_result
from workbench.execution.store import MANIFEST

__all__ = ["OBSERVED", "AncfRover", "Drive", "read_drive"]

FloatArray = NDArray[np.float64]
TITLES = {
    "slope_up": "slope of 25 degrees, upwards",
    "slope_down": "slope of 25 degrees, downwards",
    "slope_across": "slope of 25 degrees, across",
    "step": "step of 0.25 m",
    "crevasse": "crevasse of 0.15 m",
    "point_turn": "quarter turn on the spot",
    "rocks": "straight path over random rocks",
}
OBSERVED = "front_right"
ROLLING = (5.0, 35.0)
"""Time at the speed of the straight path [s]."""
_ACCOUNT = TableRule(what="energy account", first=("time_s",), units="give SI units")
DRIVEN = 1.5
"""From here to its end at 2 s the run of traction says where the power goes [s]."""
QUARTER = 0.5 * np.pi
"""A spoke follows on the next one after this angle [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """One run: outcomes, series or None, why it stopped or None, mean spins [rad/s], wall time [s] or None.

    ``account`` are time and energies, columns of `rover_dynamics.flexible.account.COLUMNS` behind the time, or None;
    ``closures`` how far energy and momentum are not accounted for [-].
    """

    outcomes: tuple[Outcome, ...]
    series: TimeSeries | None
    stopped: str | None
    spins: tuple[float, ...]
    wall_s: float | None
    account: FloatArray | None = None
    closures: Mapping[str, float] = field(default_factory=dict)

    def closure(self, what: str) -> float:
        """Of energy or momentum [-]; raises InputError if it was not accounted for."""
        if what not in self.closures:
            raise InputError(f"account of {what}", "none", "was not kept", self.stopped or "look at the run")
        return self.closures[what]

    def spent(self, since: float) -> dict[str, float]:
        """Mean power of each column of the account from a time on to the end [W], stored energies as they grow."""
        if self.account is None:
            raise InputError("energy account", "none", "was not kept", self.stopped or "look at the run")
        first = min(int(np.searchsorted(self.account[:, 0], since)), len(self.account) - 2)
        changes = self.account[-1] - self.account[first]
        return dict(zip(COLUMNS, (changes[1:] / changes[0]).tolist(), strict=True))

    def value(self, quantity: str) -> float:
        """Of the first outcome that begins so; raises InputError if there is none."""
        for outcome in self.outcomes:
            if outcome.quantity.startswith(quantity):
                return outcome.value
        raise InputError("outcome", quantity, "was not computed", self.stopped or "look at the run")

    def column(self, name: str) -> FloatArray:
        """Column of the series; raises InputError if the motion never began."""
        if self.series is None:
            raise InputError("series", name, "was not computed", self.stopped or "look at the run")
        return self.series[name]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfRover:
    """All runs by name, those on brush tires by scenario, the FE average."""

    runs: Mapping[str, Drive]
    brush: Mapping[str, Drive]
    fe: StiffnessCurve

    def __getitem__(self, name: str) -> Drive:
        return self.runs[name]

    def window(self, name: str, column: str, between: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
        """Times and values of a run between two times."""
        values = self[name].column(column)
        series = self[name].series
        assert series is not None
        inside = (series.time >= between[0] - 1e-9) & (series.time <= between[1] + 1e-9)
        return series.time[inside], values[inside]

    @property
    def deflection_period(self) -> float:
        """With which the observed wheel's deflection repeats itself on the straight path [s]."""
        return period(*self.window("straight", f"{OBSERVED}_deflection_m", ROLLING), 4.0)

    @property
    def quarter_turn(self) -> float:
        """Time of a quarter turn at the measured spin [s]."""
        spins = self["straight"].spins
        if not spins:
            raise InputError("spin", "none", "was not measured", self["straight"].stopped or "look at the run")
        return float(QUARTER / np.mean(spins))

    def force_ripple(self, name: str) -> float:
        """Root mean square of the tractive force about its smooth course in a run of traction [N]."""
        return float(np.std(ripple(*self.window(name, f"{OBSERVED}_tractive_N", (0.2, 2.0)))))

    @property
    def strongest_line(self) -> tuple[float | None, float | None]:
        """Frequency [Hz] and amplitude [N] of the strongest line of the tractive force; None without a series."""
        try:
            frequency, amplitude = spectrum(*self.window("traction", f"{OBSERVED}_tractive_N", (0.2, 2.0)))
        except InputError:
            return None, None
        k = int(amplitude.argmax())
        return float(frequency[k]), float(amplitude[k])

    def number(self, name: str) -> float | None:
        """A number of the page, or None where its run stopped; runs of traction stand for the ripple of their force."""
        numbers: dict[str, Callable[[], float]] = {
            "deflection_period": lambda: self.deflection_period,
            "quarter_turn": lambda: self.quarter_turn,
            "speed": lambda: self["straight"].value("mean speed between 15 and 35 s"),
        }
        try:
            return numbers[name]() if name in numbers else self.force_ripple(name)
        except InputError:
            return None

    @property
    def power(self) -> dict[str, float] | None:
        """Where the power of the drives goes under 3.5 N m in the last half second [W], and the mean speed [m/s]."""
        try:
            _, speed = self.window("traction", "body_vx_m_s", (DRIVEN, np.inf))
            return self["traction"].spent(DRIVEN) | {"speed": float(speed.mean())}
        except InputError:
            return None

    @property
    def sweep(self) -> list[tuple[str, float, float, float]]:
        """Run, wheel load [N], deflection on ANCF tires and of the FE average [m]; NaN beyond its end."""
        rows = []
        for name in ("load_sweep", "load_sweep_between"):
            if self[name].series is None:
                continue
            load = self[name].column(f"{OBSERVED}_load_N")
            for N, d in zip(load, self[name].column(f"{OBSERVED}_deflection_m"), strict=True):
                fe = float(np.interp(N, self.fe.load, self.fe.deflection, right=np.nan))
                rows.append((name, float(N), float(d), fe))
        return rows

    @property
    def requirements(self) -> list[MissionRow]:
        """The mission's, those of a run that stopped behind one that says why."""
        rows: list[MissionRow] = []
        for name, title in TITLES.items():
            if name not in self.runs:
                continue
            ours = [one for one in self[name].outcomes if one.limit is not None]
            theirs = {one.quantity: one for one in self.brush[name].outcomes} if name in self.brush else {}
            if self[name].stopped or not ours:
                stopped = self[name].stopped
                rows.append(MissionRow(name=name, title=title, quantity="the run reaches its end", stopped=stopped))
            rows += [
                MissionRow(name=name, title=title, quantity=one.quantity, ours=one, theirs=theirs.get(one.quantity))
                for one in ours
            ]
        return rows


def read_drive(folder: Path, name: str, tire: str) -> Drive:
    """A run from its task's folder."""
    result, series, manifest = read_result(folder), folder / "series.csv", folder / MANIFEST
    account, closures = folder / "account.csv", result.get("closures") or [{}]
    return Drive(
        outcomes=tuple(Outcome(**row) for row in result["outcomes"]),
        series=read_series(series, name, tire) if series.exists() else None,
        stopped=result.get("stopped") or result.get("failure"),
        spins=tuple(result.get("spins", ())),
        wall_s=float(json.loads(manifest.read_text(encoding="utf-8"))["wall_s"]) if manifest.exists() else None,
        account=read_table(account, _ACCOUNT).values if account.exists() else None,
        closures=closures[0],
    )
