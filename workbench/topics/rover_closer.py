"""Topic: the rover's ANCF tires looked at closely: pressure, strain, vibration beside the brush tire, animation.

Verified by tests/unit/test_workbench_rover_closer.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.preset import thesis_preset
from contracts.csv_table import TableRule, read_table
from contracts.records import Check
from contracts.series import TimeSeries, read_series
from rover_dynamics.rover.scenarios.level_ground import SPEED
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.graph.fe import FILES
from workbench.study.model import Study
from workbench.topics.rover_crosscheck import ROVER_CROSSCHECK
from workbench.topics.topic import Topic

if TYPE_CHECKING:
    from workbench.comparison.comparison import Comparison

__all__ = ["GROUNDS", "ROVER_CLOSER", "CloserLook", "Spectrum", "spectrum"]

FloatArray = NDArray[np.float64]
TASK = "rover_closer"
GROUNDS = {"straight": "straight path on level ground", "rocks": "the same over random rocks"}
_INPUTS = {"lasts": 20.0, "every": 0.05, "rocks": 3, "pressure_at": [0.0, 15.0], "frames": 60}
_RULE = TableRule(what="pressure file", first=("time_s",), units="give SI units")
STEADY = 6.0
"""From here on the speed is constant [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spectrum:
    """Amplitudes of a signal: frequency (n,) [Hz], amplitude (n,), and the signal's root mean square."""

    frequency: FloatArray
    amplitude: FloatArray
    rms: float

    @property
    def strongest(self) -> float:
        """Frequency of the largest amplitude [Hz]."""
        return float(self.frequency[1 + int(self.amplitude[1:].argmax())])


def spectrum(time: FloatArray, signal: FloatArray) -> Spectrum:
    """One-sided amplitudes under a Hann window, of even samples without their mean; a sine has its own amplitude."""
    varying = signal - signal.mean()
    window = np.hanning(len(varying))
    amplitude = 2.0 * np.abs(np.fft.rfft(window * varying)) / window.sum()
    frequency = np.fft.rfftfreq(len(varying), float(time[1] - time[0]))
    return Spectrum(frequency=frequency, amplitude=amplitude, rms=float(np.sqrt(np.mean(varying**2))))


@dataclass(frozen=True, slots=True, kw_only=True)
class CloserLook:
    """What was found.

    Attributes
    ----------
    series : by ground and tire, as far as there are
    pressure : (n, 5) float, contact points of one wheel, columns of `workbench.tasks.rover_closer.PRESSURE`
    stopped : ground -> why the drive on ANCF tires ended early
    animation : HTML page, or None
    """

    series: Mapping[tuple[str, str], TimeSeries]
    pressure: FloatArray
    stopped: Mapping[str, str]
    animation: str | None

    def vibration(self, ground: str, tire: str) -> Spectrum:
        """Of the first body's vertical acceleration [m/s^2] at constant speed."""
        found = self.series[ground, tire]
        steady = found.time >= STEADY
        return spectrum(found.time[steady], found["body_az_m_s2"][steady])

    @property
    def row_frequency(self) -> float:
        """At which rows of contact points come to the ground [Hz]."""
        tire = thesis_preset()
        row = 2.0 * np.pi * tire.outer_radius / (tire.circumferential_plates * (tire.contact_points[0] - 1))
        return float(SPEED / row)

    @property
    def vibrations(self) -> list[tuple[str, str, Spectrum]]:
        """Ground in words, tire, spectrum; of drives long enough."""
        return [
            (GROUNDS[ground], tire, self.vibration(ground, tire))
            for (ground, tire), one in self.series.items()
            if one.time[-1] > STEADY + 2.0
        ]

    @property
    def strains(self) -> dict[str, FloatArray]:
        """Largest strain of each tire over time on level ground, by wheel."""
        found = self.series.get(("straight", "ancf"))
        return {} if found is None else {k[:-9]: v for k, v in found.columns.items() if k.endswith("_strain_1")}

    @property
    def strain_range(self) -> tuple[float, float]:
        """Smallest and largest over all tires at constant speed [-]."""
        steady = self.series["straight", "ancf"].time >= STEADY
        values = np.array([strain[steady] for strain in self.strains.values()])
        return float(values.min()), float(values.max())

    @property
    def footprints(self) -> list[dict[str, float]]:
        """Of each moment: time [s], load [N], largest pressure [Pa], length of the patch [m], points."""
        found = []
        for time in np.unique(self.pressure[:, 0]):
            points = self.pressure[self.pressure[:, 0] == time]
            found.append(
                {
                    "time": float(time),
                    "load": float(points[:, 4].sum()),
                    "pressure": float(points[:, 3].max()),
                    "length": float(np.ptp(points[:, 1])),
                    "points": float(len(points)),
                }
            )
        return found


def _tasks(study: Study) -> Sequence[Task]:
    return [
        Task(
            name=TASK,
            function="workbench.tasks.rover_closer:drive_closely",
            inputs=_INPUTS,
            sources=(*FILES, "ancf_reduced", "rover_dynamics", *(f"workbench.{name}" for name in _DRAWN)),
            libraries=("numpy", "numba", "scipy", "pyvista", "pillow"),
            cost=60.0,
        )
    ]


_FIGURES = ("rover_animation", "tire_animation", "rover_solids", "solids", "stills", "palette")
_DRAWN = ("tasks.rover_tires", *(f"figures.{name}" for name in _FIGURES))


def _read(study: Study, folders: Mapping[str, Path]) -> CloserLook:
    folder = folders[TASK]
    files = {(g, t): folder / f"{g}_{t}.csv" for g in GROUNDS for t in ("brush", "ancf")}
    page, pressure = folder / "animation.html", folder / "pressure.csv"
    return CloserLook(
        series={
            (ground, tire): read_series(path, f"{ground}_closely", tire)
            for (ground, tire), path in files.items()
            if path.exists()
        },
        pressure=read_table(pressure, _RULE).values if pressure.exists() else np.zeros((0, 5)),
        stopped=read_result(folder)["stopped"],
        animation=page.read_text(encoding="utf-8") if page.exists() else None,
    )


def _checks(study: Study, found: Comparison, results: CloserLook) -> Sequence[Check]:
    return ()


def _figures(study: Study, results: CloserLook) -> Mapping[str, str]:
    from workbench.figures.rover_closer import closer_figures

    return closer_figures(results)


def _series(study: Study, results: CloserLook) -> Sequence[TimeSeries]:
    return list(results.series.values())


ROVER_CLOSER = Topic(
    name="rover_closer",
    title="ANCF tires, closely",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=_figures,
    series=_series,
    applies=ROVER_CROSSCHECK.applies,
)
