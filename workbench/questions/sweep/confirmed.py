"""What a search found and ran again, to be read by programs: values, misses, numbers and curves of each such point.

Verified by tests/end_to_end/test_search.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from workbench.questions.fe.graph import curve_deflections
from workbench.questions.sweep.results import measured, own_curves
from workbench.questions.sweep.search import Judged
from workbench.study.model import Study

__all__ = ["confirmed_record"]


def confirmed_record(
    base: Mapping[str, Any], study: Study, judged: Mapping[int, Judged], confirms: Mapping[int, int]
) -> dict[str, Any]:
    """Everything about the confirmed points of a search, for JSON.

    Parameters
    ----------
    base : content of the study file without [sweep]
    study : it, read
    judged, confirms : of every point, and which point of the search one is that ran again

    Returns
    -------
    record : ``study`` (base), ``aims``, ``searched`` and ``refused`` (counts), ``wheels``: for each confirmed point
        ``point``, ``confirms``, ``values``, ``misses`` [-], ``chosen``
        alternatives, ``numbers`` (columns of the table, SI), ``deflection_m``
        (n,), ``orientation_deg`` (m,), ``load_N`` (m, n) and ``average_N`` (n,), null beyond a curve's end
    """
    section = study.sweep
    assert section is not None
    at, followed, wheels = np.array(curve_deflections(study)), own_curves(study), []
    for number, found in confirms.items():
        one = judged[number]
        outcome, curves = one.outcome, one.outcome.by_orientation
        numbers = measured(outcome, section, study.tangent_up_to, None, followed)
        wheels.append(
            {
                "point": number,
                "confirms": found,
                "values": dict(outcome.run.point.values),
                "misses": dict(one.misses),
                "chosen": dict(one.chosen),
                "numbers": {name: value for name, value in numbers.items() if isinstance(value, float)},
                "deflection_m": at.tolist(),
                "orientation_deg": [curve.orientation_deg for curve in curves],
                "load_N": [_loads(curve, at) for curve in curves],
                "average_N": [] if outcome.curve is None else _loads(outcome.curve, at),
            }
        )
    first = [one for number, one in judged.items() if number not in confirms]
    return {
        "study": dict(base),
        "aims": section.model_dump(include={"aims", "one_of"}, exclude_none=True),
        "searched": len(first),
        "refused": sum(one.outcome.curve is None for one in first),
        "wheels": wheels,
    }


def _loads(curve: StiffnessCurve, at: NDArray[np.float64]) -> list[float | None]:
    """Loads [N] at deflections [m], None beyond the curve's end."""
    return [float(curve.load_at(d)) if d <= curve.deflection[-1] + 1e-12 else None for d in at]
