"""Task that measures the distances between the models' curves, so that a second report need not.

Verified by tests/unit/test_workbench_tasks.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.curves import Around, StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.execution.result_files import write_result
from workbench.questions.model_curves import CURVE, ModelCurves, model_curves
from workbench.questions.models.metrics import compare_curves

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["measure"]

_SAME = 1e-6
"""Orientations that are one [deg]."""


def measure(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Compare ANCF, brush and the user's curves with the continuum's: ``result.json``, ``user_{i}.csv``.

    A study may have none of these. Pairs with a continuum curve of which no point converged are left out.
    """
    fe, pairs = model_curves("fe", needs, Around(**inputs["around"])), {}
    ancf = model_curves("ancf", needs) if any(name.startswith("ancf_phi") for name in needs) else None
    if ancf is not None:
        pairs["ancf_average"] = (ancf.average, fe.average)
    if "brush" in needs:
        pairs["brush"] = (read_curve(needs["brush"] / CURVE, model="brush"), fe.average)
    for orientation, curve in ancf.by_orientation.items() if ancf is not None else ():
        if orientation in fe.by_orientation:
            pairs[f"ancf_phi{orientation:g}"] = (curve, fe.by_orientation[orientation])
    for i, user in enumerate(inputs["user_curves"]):
        path = out / f"user_{i}.csv"
        path.write_text(user["text"], encoding="utf-8")
        curve = read_curve(path, orientation_deg=user["orientation"])
        pairs[f"user_{i}"] = _counterpart(fe, user["orientation"]), curve
    known = {name: pair for name, pair in pairs.items() if not any(curve.unloaded for curve in pair)}
    write_result(out, {name: _distance(pair, inputs["max_load"]) for name, pair in known.items()})
    progress(1.0)
    return 0


def _counterpart(fe: ModelCurves, orientation_deg: float | None) -> StiffnessCurve:
    """Our curve that a user's curve is held against."""
    if orientation_deg is None:
        return fe.average
    nearest = min(fe.by_orientation, key=lambda o: abs(o - orientation_deg))
    if abs(nearest - orientation_deg) > _SAME:
        known = ", ".join(f"{o:g}" for o in fe.by_orientation)
        rule = f"is not among the orientations of the study ({known} deg)"
        raise InputError("user curve's orientation", f"{orientation_deg:g} deg", rule, "add it to fe.orientations")
    return fe.by_orientation[nearest]


def _distance(pair: tuple[StiffnessCurve, StiffnessCurve], max_load: float) -> dict[str, float]:
    return compare_curves(*pair, max_load=max_load).as_dict()
