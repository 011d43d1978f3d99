"""What repeats in a time series: its period, and the spectrum of what is left of a smooth course.

Verified by tests/unit/test_workbench_oscillation.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["period", "ripple", "spectrum"]

FloatArray = NDArray[np.float64]


def period(time: FloatArray, values: FloatArray, shortest: float) -> float:
    """Lag [s] from ``shortest`` on at which the series repeats itself best: least mean square of v(t + T) - v(t).

    Half a period or more must be left behind the longest lag tried, two thirds of the time. Times are evenly spaced.

    Raises
    ------
    InputError
        If the best lag is the first or the last one tried: then nothing repeats within the time.
    """
    step = (time[-1] - time[0]) / (len(time) - 1)
    lags = np.arange(max(1, round(shortest / step)), 2 * len(time) // 3)
    misses = np.array([np.mean((values[k:] - values[:-k]) ** 2) for k in lags])
    best = int(np.argmin(misses))
    if best in (0, len(lags) - 1):
        value = f"{lags[best] * step:g} s"
        raise InputError("period of the series", value, "is the end of what was tried", "give a longer series")
    left, middle, right = misses[best - 1 : best + 2]
    return float(step * (lags[best] + 0.5 * (left - right) / (left - 2.0 * middle + right)))


def ripple(time: FloatArray, values: FloatArray, degree: int = 3) -> FloatArray:
    """The series (n,) less the polynomial that fits it best."""
    x = (time - time[0]) / (time[-1] - time[0])
    return np.asarray(values - np.polyval(np.polyfit(x, values, degree), x))


def spectrum(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and amplitudes of the ripple of an evenly spaced series, Hann window.

    A sine at the middle of a bin has its own amplitude there.
    """
    window = np.hanning(len(time))
    step = (time[-1] - time[0]) / (len(time) - 1)
    amplitude = 2.0 * np.abs(np.fft.rfft(window * ripple(time, values))) / window.sum()
    return np.fft.rfftfreq(len(time), step), amplitude
