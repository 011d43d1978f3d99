"""Files of ``[reference]``: the band, and the uncertainty of a curve.

Verified by tests/unit/test_workbench_reference.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.study.curve_file import MeasuredCurve, load_uncertainty, read_measured_curve, require_distinct
from workbench.study.reference import CurveReference

__all__ = ["LoadBand", "load_band", "read_band", "stated_uncertainty"]

Array = NDArray[np.float64]
_ENDS = ("load_low_N", "load_high_N")


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadBand:
    """Interval of the load at deflections: ``deflection`` (n,) float [m], ``low`` and ``high`` (n,) float [N]."""

    deflection: Array
    low: Array
    high: Array


def load_band(curve: StiffnessCurve) -> LoadBand:
    """The band in a curve's columns ``load_low_N`` and ``load_high_N``; InputError where it has no such."""
    for name in _ENDS:
        if name not in curve.columns:
            hint = "its columns are deflection_m, load_N, load_low_N, load_high_N"
            raise InputError("band file", curve.model, f"has no column {name}", hint)
    low, high = (curve.columns[name] for name in _ENDS)
    if not np.all((low >= 0.0) & (low <= high) & ((high > 0.0) | (curve.deflection <= 0.0))):
        rule = "needs 0 <= load_low_N <= load_high_N, and load_high_N > 0 in every row behind first contact"
        raise InputError("band file", curve.model, rule, "mend the rows that have not")
    return LoadBand(deflection=curve.deflection, low=low, high=high)


def read_band(path: Path) -> LoadBand:
    """The band of a file in the project's own format, such as a report's ``curves/words_band_average.csv``.

    Raises
    ------
    InputError
        As `read_curve`, as `load_band`, and for numbers that no wheel has: infinite ones, or those of another unit.
    """
    require_distinct(path)
    band = load_band(read_curve(path))
    for numbers, name, most in (
        (band.deflection, "deflection_m", 1.0),
        (band.low, _ENDS[0], 1e7),
        (band.high, _ENDS[1], 1e7),
    ):
        if not np.abs(numbers).max() <= most:
            rule = f"{name} holds {numbers[np.abs(numbers).argmax()]:g}, beyond any wheel's {most:g}"
            raise InputError("band file", path, rule, "give deflections in metres and loads in newtons, all finite")
    return band


def stated_uncertainty(section: CurveReference, found: MeasuredCurve | None = None) -> Array:
    """Half width (n,) [N] of the load's interval of a reference's curve: what the study says, else what its file does.

    Raises
    ------
    InputError
        If neither says so, or as `workbench.study.curve_file.load_uncertainty`.
    """
    found = read_measured_curve(Path(section.file)) if found is None else found
    if section.uncertainty is not None:
        return load_uncertainty(section.uncertainty, found.curve.load)
    if found.uncertainty is None:
        rule = "is missing: neither the study nor the file says how well the load is known"
        raise InputError("uncertainty", "", rule, "write uncertainty = '3 %', or '5 N'")
    return found.uncertainty
