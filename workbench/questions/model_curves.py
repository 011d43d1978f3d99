"""Curves of a model from the folders of its tasks: by orientation, and their mean.

Verified by tests/unit/test_workbench_missing.py and tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve, average_curve, read_curve
from workbench.execution.result_files import FAILURE, read_result

__all__ = ["CURVE", "ModelCurves", "UserCurve", "mean_curve", "model_curves"]

CURVE = "curve.csv"


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelCurves:
    """Curves of one model: one per orientation, by orientation [deg], and the average of those that carry load."""

    model: str
    by_orientation: Mapping[float, StiffnessCurve]
    average: StiffnessCurve
    numbers: Mapping[float, Mapping[str, Any]]

    @property
    def loaded(self) -> dict[float, StiffnessCurve]:
        """Curves with a point behind first contact, by orientation [deg]."""
        return {o: curve for o, curve in self.by_orientation.items() if not curve.unloaded}

    @property
    def missing(self) -> dict[float, str]:
        """Orientation [deg] -> why no point of its curve converged."""
        return {o: str(self.numbers[o].get(FAILURE)) for o, curve in self.by_orientation.items() if curve.unloaded}


@dataclass(frozen=True, slots=True, kw_only=True)
class UserCurve:
    """A curve the user dropped in, and what it is held against."""

    label: str
    curve: StiffnessCurve
    orientation_deg: float | None


def model_curves(model: str, folders: Mapping[str, Path]) -> ModelCurves:
    """Curves of ``fe`` or ``ancf`` from the tasks ``{model}_phi...`` among ``folders``, in order of orientation."""
    found = {}
    for name, folder in folders.items():
        if name.startswith(f"{model}_phi"):
            orientation = float(name.removeprefix(f"{model}_phi"))
            curve = read_curve(folder / CURVE, model=model, orientation_deg=orientation)
            found[orientation] = (curve, read_result(folder))
    ordered = dict(sorted(found.items()))
    return ModelCurves(
        model=model,
        by_orientation={o: curve for o, (curve, _) in ordered.items()},
        average=mean_curve([curve for curve, _ in ordered.values()]),
        numbers={o: numbers for o, (_, numbers) in ordered.items()},
    )


def mean_curve(curves: Sequence[StiffnessCurve]) -> StiffnessCurve:
    """Average over the orientations; on a finer grid where a partial curve leaves less than two steps in common.

    Orientations of which no point converged are left out and named in the source, and the average is partial; without
    any other it is one of them.
    """
    loaded = [c for c in curves if not c.unloaded]
    if not loaded:
        return replace(curves[0], orientation_deg=None, source="no point converged at any orientation")
    common = min(c.deflection[-1] for c in loaded) - max(c.deflection[0] for c in loaded)
    average = average_curve(loaded, step=min(0.5e-3, 0.5 * common))
    if len(loaded) == len(curves):
        return average
    missing = ", ".join(f"{c.orientation_deg} deg" for c in curves if c.unloaded)
    return replace(average, source=f"{average.source}; without {missing}, where no point converged", partial=True)
