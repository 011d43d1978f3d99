"""What a close look at the rover's ANCF tires finds: vibration, strain, pressure, and the tires at rest.

Verified by tests/unit/test_workbench_rover_closer.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.preset import TirePreset
from contracts.errors import InputError
from contracts.series import TimeSeries
from workbench.questions.rover.drive import Drive
from workbench.questions.rover.oscillation import spectrum

__all__ = ["GROUNDS", "CloserLook", "Resting", "Spectrum"]

FloatArray = NDArray[np.float64]
GROUNDS = {"straight": "straight path on level ground", "rocks": "the same over random rocks"}
STEADY = (6.0, 35.0)
"""Time at constant speed [s]."""


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


@dataclass(frozen=True, slots=True, kw_only=True)
class Resting:
    """The rover at rest on the same tires, solved apart from the drive.

    Attributes
    ----------
    strain : (n,) float [-], largest of a tire, by orientation from spoke to spoke
    stiffness : (n,) float [N/m], of a wheel about its load, by orientation
    strain_alike : [-], of a rover whose wheels all stand alike, as it sets out
    mass : of the rover [kg]
    """

    strain: FloatArray
    stiffness: FloatArray
    strain_alike: float
    mass: float

    @property
    def bounce(self) -> float:
        """sqrt(6 k / m) / (2 pi) of the rover on six tires of the mean stiffness [Hz]."""
        return float(np.sqrt(6.0 * self.stiffness.mean() / self.mass) / (2.0 * np.pi))


@dataclass(frozen=True, slots=True, kw_only=True)
class CloserLook:
    """What was found.

    Attributes
    ----------
    series : by ground and tire, as far as there are
    pressure : (n, 5) float, contact points of one wheel, columns of `workbench.questions.rover.close_look.PRESSURE`
    straight : the straight path on ANCF tires as its own section has it
    load : the rover's weight over the number of wheels [N]
    resting : the same tires at rest; None if the rover does not stand on them
    preset : of the tires
    of_thesis : whether they are stated to be the thesis'
    stopped : ground -> why the drive on ANCF tires ended early
    animation : HTML page, or None
    """

    series: Mapping[tuple[str, str], TimeSeries]
    pressure: FloatArray
    straight: Drive
    load: float
    resting: Resting | None
    preset: TirePreset
    of_thesis: bool
    stopped: Mapping[str, str]
    animation: str | None

    def vibration(self, ground: str, tire: str) -> Spectrum:
        """Of the first body's vertical acceleration [m/s^2] at constant speed; InputError if it never got there."""
        found = self.series.get((ground, tire))
        if found is None or found.time[-1] <= STEADY[0] + 2.0:
            raise InputError("vibration", f"{ground}, {tire}", "was not recorded", self.stopped.get(ground, "drive on"))
        steady = (found.time >= STEADY[0]) & (found.time <= STEADY[1])
        signal = found["body_az_m_s2"][steady]
        frequency, amplitude = spectrum(found.time[steady], signal)
        return Spectrum(frequency=frequency, amplitude=amplitude, rms=float(signal.std()))

    @property
    def row_frequency(self) -> float:
        """At which rows of contact points come to the ground [Hz]."""
        from rover_dynamics.rover.scenarios.level_ground import SPEED

        tire = self.preset
        row = 2.0 * np.pi * tire.outer_radius / (tire.circumferential_plates * (tire.contact_points[0] - 1))
        return float(SPEED / row)

    @property
    def vibrations(self) -> list[tuple[str, str, Spectrum]]:
        """Ground in words, tire, spectrum; of drives long enough."""
        found = []
        for ground, tire in self.series:
            try:
                found.append((GROUNDS[ground], tire, self.vibration(ground, tire)))
            except InputError:
                continue
        return found

    @property
    def strains(self) -> dict[str, FloatArray]:
        """Largest strain of each tire over time on level ground, by wheel."""
        found = self.series.get(("straight", "ancf"))
        return {} if found is None else {k[:-9]: v for k, v in found.columns.items() if k.endswith("_strain_1")}

    @property
    def rolled(self) -> bool:
        """Whether the drive on level ground came to constant speed."""
        found = self.series.get(("straight", "ancf"))
        return found is not None and bool(found.time[-1] > STEADY[0])

    @property
    def strain_range(self) -> tuple[float, float]:
        """Smallest and largest over all tires at constant speed [-]; InputError if the drive never got there."""
        if not self.rolled:
            raise InputError("strain", "none", "was recorded at constant speed", self.straight.stopped or "drive on")
        time = self.series["straight", "ancf"].time
        steady = (time >= STEADY[0]) & (time <= STEADY[1])
        values = np.array([strain[steady] for strain in self.strains.values()])
        return float(values.min()), float(values.max())

    @property
    def strain_at_start(self) -> float:
        """Largest of all tires at time zero, at rest [-]; InputError if there is none."""
        if not self.strains:
            raise InputError("strain", "none", "was recorded at rest", self.straight.stopped or "drive on")
        return max(float(strain[0]) for strain in self.strains.values())

    @property
    def footprints(self) -> list[dict[str, float]]:
        """Of each moment: time [s], load [N], largest pressure [Pa], length of the patch [m], points."""
        found = []
        for time in np.unique(self.pressure[:, 0]):
            points = self.pressure[self.pressure[:, 0] == time]
            found.append(
                {
                    "time": float(time),
                    "load": float(points[:, 3] @ points[:, 4]),
                    "pressure": float(points[:, 3].max()),
                    "length": float(np.ptp(points[:, 1])),
                    "points": float(len(points)),
                }
            )
        return found
