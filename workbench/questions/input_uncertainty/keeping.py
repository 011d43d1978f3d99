"""The record of what `workbench sample` ran: from the outcomes of its points to JSON.

Verified by tests/unit/test_workbench_input_uncertainty.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.fe.graph import curve_deflections
from workbench.questions.strength.yielding import largest_utilisation, peak_stresses
from workbench.questions.sweep.results import Outcome
from workbench.study.input_points import as_sampled
from workbench.study.input_uncertainty import InputUncertaintySection
from workbench.study.key_units import unit_of
from workbench.study.model import Study
from workbench.study.quantities import number_and_unit
from workbench.study.strengths import yield_strengths
from workbench.study.sweep import tied_keys

__all__ = ["found_of"]

_DIGITS = 6
_LONGEST_NOTE = 200
_NOTES = 10

Array = NDArray[np.float64]


def found_of(study: Study, section: InputUncertaintySection, found: Sequence[Outcome]) -> dict[str, Any]:
    """The record of the outcomes of every point, the study as it is first; numbers to six digits, None for none.

    Raises
    ------
    InputError
        If the study as it is has no curve: nothing can be held against it.
    """
    nominal, *sampled = found
    if nominal.curve is None or nominal.curve.unloaded:
        raise InputError(
            "the study as it is", "no curve", nominal.note or "converged nowhere", "see workbench stiffness"
        )
    at = np.array(curve_deflections(as_sampled(study, section)))
    at = at if at[0] == 0.0 else np.append(0.0, at)
    load = study.judged_load
    return {
        "inputs": {key: [_number(one.run.point.values[key]) for one in sampled] for key in section.inputs},
        "units": [_unit(key, sampled[0].run.point.values[key]) for key in section.inputs],
        "deflection_m": [float(d) for d in at],
        "nominal": _numbers(nominal, at, load),
        "samples": [_numbers(one, at, load) for one in sampled],
        "early": sum(one.state == "partial" for one in sampled),
        "notes": _notes(sampled),
    }


def _notes(sampled: Sequence[Outcome]) -> dict[str, str]:
    bad = [one for one in sampled if one.state != "whole"][:_NOTES]
    return {str(one.run.point.number): one.note[:_LONGEST_NOTE] for one in bad}


def _number(value: object) -> float:
    found = number_and_unit(value)
    assert found is not None  # drawn by ourselves
    return found[0]


def _unit(key: str, value: object) -> str:
    found = number_and_unit(value)
    return (found[1] if found else "") or unit_of(tied_keys(key)[0][1]) or ""


def _numbers(outcome: Outcome, at: Array, load: float) -> dict[str, Any]:
    curves, strengths = outcome.by_orientation, yield_strengths(outcome.run.point.study)
    try:
        stress: float | None = max(max(p.stress for p in peak_stresses(c, strengths, load)) for c in curves)
        used: float | None = max(largest_utilisation(c, strengths, load) for c in curves)
    except (InputError, ValueError):  # a curve ends below the load, or there is none
        stress = used = None
    return {"load_N": _loads(outcome.curve, at), "stress_Pa": _rounded(stress), "used": _rounded(used)}


def _loads(curve: StiffnessCurve | None, at: Array) -> list[float | None]:
    """Loads at deflections, None beyond the curve's end."""
    if curve is None or curve.unloaded:
        return [None] * len(at)
    end = curve.deflection[-1] + 1e-9
    return [_rounded(float(curve.load_at(min(d, curve.deflection[-1])))) if d <= end else None for d in at]


def _rounded(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.{_DIGITS}g}")
