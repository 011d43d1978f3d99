"""Fit of the ANCF tire to the FE curves: which loads count, how far a tire lies from the average.

Verified by tests/unit/test_workbench_ancf_fit.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contracts.curves import Around, StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.execution.result_files import FAILURE, read_record, read_result
from workbench.questions.model_curves import CURVE, mean_curve
from workbench.study.orientation import orientation_name

if TYPE_CHECKING:
    from workbench.questions.ancf_fit.records import AverageError, Held

__all__ = [
    "FittedTire",
    "average_error",
    "compared_deflections",
    "fe_curves",
    "fitted_deflections",
    "read_fit",
]

FloatArray = NDArray[np.float64]
_SAMPLES = 401


@dataclass(frozen=True, slots=True, kw_only=True)
class FittedTire[Numbers: Held]:
    """A tire fitted to the FE curves, or one held against them as it is.

    Attributes
    ----------
    name : of the tire in the study, ``thesis`` for the study's own
    curves : by orientation [deg], hub drop from the nominal radius
    average : their mean
    numbers : what was found
    """

    name: str
    curves: Mapping[float, StiffnessCurve]
    average: StiffnessCurve
    numbers: Numbers


def fe_curves(folders: Mapping[str, Path], orientations_deg: Sequence[float]) -> list[StiffnessCurve]:
    """The FE curves at some orientations from their result folders by task name, without those that carry no load.

    Raises
    ------
    InputError
        If none carries load.
    """
    names = [(orientation_name("fe", o), o) for o in orientations_deg]
    curves = [read_curve(folders[name] / CURVE, model="fe", orientation_deg=o) for name, o in names]
    loaded = [curve for curve in curves if not curve.unloaded]
    if not loaded:
        raise InputError("FE curves", "none", "carries load", "see why the runs ended early")
    return loaded


def read_fit[Numbers: Held](
    name: str, folder: Path, kind: type[Numbers], around: Around | None = None
) -> FittedTire[Numbers]:
    """One tire from its result folder; InputError with the reason if it could not be fitted.

    Its average has the weights of the FE curves', ``around`` their wheel.
    """
    failure = read_result(folder).get(FAILURE)
    if failure is not None:
        raise InputError("ANCF tire", name, f"could not be held against the FE curves: {failure}", "mend that")
    numbers = read_record(folder, kind)
    curves = {
        o: read_curve(folder / f"{orientation_name('ancf', o)}.csv", model=f"ancf_{name}", orientation_deg=o)
        for o in numbers.orientations_deg
    }
    return FittedTire(name=name, curves=curves, average=mean_curve(list(curves.values()), around), numbers=numbers)


def fitted_deflections(average: StiffnessCurve, load_range: Sequence[float], points: int) -> FloatArray:
    """Deflections [m] at which the FE average has ``points`` loads, in equal ratios from end to end of the range.

    A range beyond the end of the curve ends there; InputError if nothing of it is left.
    """
    low, high = load_range[0], min(load_range[1], float(average.load[-1]))
    if not low < high:
        rule = f"begins beyond the end of the FE average, {average.load[-1]:.4g} N"
        raise InputError("ancf_fit.load_range", f"{low:g} N", rule, "raise fe.max_deflection or lower the range")
    return np.array([average.deflection_at(load) for load in np.geomspace(low, high, points).clip(low, high)])


def compared_deflections(average: StiffnessCurve, load_range: Sequence[float]) -> FloatArray:
    """Deflections [m] at equal steps over the range of loads of the FE average, where curves are compared."""
    first, last = fitted_deflections(average, load_range, 2)
    return np.linspace(first, last, _SAMPLES)


def average_error(curves: Sequence[StiffnessCurve], fe: StiffnessCurve, load_range: Sequence[float]) -> AverageError:
    """How far the mean of curves lies from the FE average, relative to its load at equal deflection, within a range."""
    from workbench.questions.ancf_fit.records import AverageError

    d = compared_deflections(fe, load_range)
    loads = fe.load_at(d)
    error = np.mean([curve.load_at(d) for curve in curves], axis=0) / loads - 1.0
    worst = int(np.abs(error).argmax())
    return AverageError(largest=float(error[worst]), at_load=float(loads[worst]))
