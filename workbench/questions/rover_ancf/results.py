"""Results of the rover on six ANCF tires, and what is read from them.

Verified by tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.preset import TirePreset
from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.rover.drive import Drive
from workbench.questions.rover.oscillation import period, ripple, spectrum
from workbench.questions.rover_mission.requirements import MissionRow, mission_rows
from workbench.questions.speed.damping import DampingRow, damping_rows

__all__ = ["OBSERVED", "AncfRover"]

FloatArray = NDArray[np.float64]
OBSERVED = "front_right"
ROLLING = (5.0, 35.0)
"""Time at the speed of the straight path [s]."""
DRIVEN = 1.5
"""From here to its end at 2 s the run of traction says where the power goes [s]."""
SHORTEST = 16.0
"""Period of the deflection that is looked for at least, times the spokes: of four, a third of a quarter turn [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfRover:
    """All runs on a study's tires.

    Attributes
    ----------
    runs : by name
    brush : those on brush tires, by scenario
    fe : the FE average
    preset : of the ANCF tires
    friction : of the study's ground, or None
    of_thesis : whether the tires are stated to be the thesis'
    """

    runs: Mapping[str, Drive]
    brush: Mapping[str, Drive]
    fe: StiffnessCurve
    preset: TirePreset
    friction: float | None
    of_thesis: bool

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
        return period(*self.window("straight", f"{OBSERVED}_deflection_m", ROLLING), SHORTEST / self.preset.spokes)

    @property
    def spoke_turn(self) -> float:
        """Time in which a spoke follows on the next one at the measured spin [s]."""
        spins = self["straight"].spins
        if not spins:
            raise InputError("spin", "none", "was not measured", self["straight"].stopped or "look at the run")
        return float(2.0 * np.pi / self.preset.spokes / np.mean(spins))

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
            "spoke_turn": lambda: self.spoke_turn,
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
    def dampings(self) -> list[DampingRow]:
        """What other damping of the contact points makes of the rover on the thesis' tires, from a kept benchmark."""
        return damping_rows() if self.of_thesis else []

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
        """The mission's, as far as driven."""
        return mission_rows(self.runs, self.brush)
