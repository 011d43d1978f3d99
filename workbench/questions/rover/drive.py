"""One run of the rover on ANCF or brush tires, as its task left it.

Verified by tests/unit/test_workbench_rover_ancf.py and tests/unit/test_workbench_rover.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import TableRule, read_table
from contracts.errors import InputError
from contracts.series import TimeSeries, read_series
from rover_dynamics.rover.scenarios.outcome import Outcome
from workbench.execution.result_files import read_result
from workbench.execution.store import MANIFEST

__all__ = ["Drive", "read_drive"]

FloatArray = NDArray[np.float64]
_ACCOUNT = TableRule(what="energy account", first=("time_s",), units="give SI units")


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
        from rover_dynamics.flexible.account import COLUMNS

        if self.account is None:
            raise InputError("energy account", "none", "was not kept", self.stopped or "look at the run")
        first = min(int(np.searchsorted(self.account[:, 0], since)), len(self.account) - 2)
        changes = self.account[-1] - self.account[first]
        return dict(zip(COLUMNS, (changes[1:] / changes[0]).tolist(), strict=True))

    def value(self, quantity: str) -> float:
        """Of the first outcome that begins so; raises InputError if there is none, as in a run that stopped."""
        return self.outcome(quantity).value

    def reference(self, quantity: str) -> float:
        """Of the first outcome that begins so; 0 if there is none, whose value then raises."""
        return next((o.reference or 0.0 for o in self.outcomes if o.quantity.startswith(quantity)), 0.0)

    def outcome(self, quantity: str) -> Outcome:
        """The first outcome that begins so; raises InputError if there is none."""
        for outcome in self.outcomes:
            if outcome.quantity.startswith(quantity):
                return outcome
        raise InputError("outcome", quantity, "was not computed", self.stopped or "look at the run")

    def column(self, name: str) -> FloatArray:
        """Column of the series; raises InputError if the motion never began."""
        if self.series is None:
            raise InputError("series", name, "was not computed", self.stopped or "look at the run")
        return self.series[name]


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
