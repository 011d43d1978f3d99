"""Curves of a model from the folders of its tasks: by orientation, and their mean.

Verified by tests/unit/test_workbench_missing.py and tests/unit/test_workbench_checks.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import Around, StiffnessCurve, average_curve, read_curve
from contracts.errors import IncrementRecord
from workbench.execution.result_files import FAILURE, UNSTABLE, increments_of, read_result

__all__ = [
    "CURVE",
    "ModelCurves",
    "RunNumbers",
    "UserCurve",
    "distances_from",
    "mean_curve",
    "model_curves",
    "read_run",
]

CURVE = "curve.csv"


@dataclass(frozen=True, slots=True, kw_only=True)
class RunNumbers:
    """How one curve was computed; what a model does not have keeps its default.

    Attributes
    ----------
    dofs, cells : unknowns and cells of the mesh
    solve_s : wall time [s]
    increments : every attempt, converged or not
    failure : why the run ended before its target; None if it did not
    unstable : where and how an ANCF wheel does not stand; None if it does
    flexible_mass : of an ANCF tire's plates [kg]
    """

    dofs: int = 0
    cells: int = 0
    solve_s: float = 0.0
    increments: tuple[IncrementRecord, ...] = ()
    failure: str | None = None
    unstable: str | None = None
    flexible_mass: float = math.nan

    @property
    def converged(self) -> tuple[IncrementRecord, ...]:
        """Attempts that met their tolerance."""
        return tuple(one for one in self.increments if one.converged)

    @property
    def iterations(self) -> int:
        """Of all attempts."""
        return sum(len(one.residuals) - 1 for one in self.increments)


def read_run(folder: Path) -> RunNumbers:
    """Numbers of the run whose task filled a folder."""
    found = read_result(folder)
    return RunNumbers(
        dofs=found.get("dofs", 0),
        cells=found.get("cells", 0),
        solve_s=found.get("solve_s", 0.0),
        increments=increments_of(found),
        failure=found.get(FAILURE),
        unstable=found.get(UNSTABLE),
        flexible_mass=found.get("flexible_mass_kg", math.nan),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelCurves:
    """Curves of one model by orientation [deg], the average of those that carry load, and how each was computed."""

    model: str
    by_orientation: Mapping[float, StiffnessCurve]
    average: StiffnessCurve
    runs: Mapping[float, RunNumbers]

    @property
    def loaded(self) -> dict[float, StiffnessCurve]:
        """Curves with a point behind first contact, by orientation [deg]."""
        return {o: curve for o, curve in self.by_orientation.items() if not curve.unloaded}

    @property
    def missing(self) -> dict[float, str]:
        """Orientation [deg] -> why no point of its curve converged."""
        return {o: str(self.runs[o].failure) for o, curve in self.by_orientation.items() if curve.unloaded}


@dataclass(frozen=True, slots=True, kw_only=True)
class UserCurve:
    """A curve of the study's reference.

    Attributes
    ----------
    label, kind : what the report calls it; measured, published or inferred
    curve : the curve
    orientation_deg : the orientation it belongs to [deg]; None for the average
    uncertainty : (n,) float [N], half width of the interval in which each of its loads lies
    """

    label: str
    kind: str
    curve: StiffnessCurve
    orientation_deg: float | None
    uncertainty: NDArray[np.float64]


def model_curves(model: str, folders: Mapping[str, Path], around: Around | None = None) -> ModelCurves:
    """Curves of ``fe`` or ``ancf`` from the tasks ``{model}_phi...`` among ``folders``, in order of orientation.

    Their average weighs each by the arc it stands for ``around`` the wheel, all alike if left out.
    """
    found = {}
    for name, folder in folders.items():
        if name.startswith(f"{model}_phi"):
            orientation = float(name.removeprefix(f"{model}_phi"))
            curve = read_curve(folder / CURVE, model=model, orientation_deg=orientation)
            found[orientation] = (curve, read_run(folder))
    ordered = dict(sorted(found.items()))
    return ModelCurves(
        model=model,
        by_orientation={o: curve for o, (curve, _) in ordered.items()},
        average=mean_curve([curve for curve, _ in ordered.values()], around),
        runs={o: run for o, (_, run) in ordered.items()},
    )


def distances_from(
    curves: Sequence[StiffnessCurve], reference: StiffnessCurve, loads: tuple[float, float]
) -> list[float | None]:
    """Largest |F/F_ref - 1| of each curve at the points of a reference whose loads lie within ``loads`` [N] [-].

    None for a curve that ends before, and where the reference has no such point.
    """
    wanted = (reference.load >= loads[0]) & (reference.load <= loads[1])
    at, target = reference.deflection[wanted], reference.load[wanted]
    return [
        float(abs(curve.load_at(at) / target - 1.0).max()) if len(at) and curve.deflection[-1] >= at[-1] else None
        for curve in curves
    ]


def mean_curve(curves: Sequence[StiffnessCurve], around: Around | None = None) -> StiffnessCurve:
    """Average over the orientations, weighted by the arcs they stand for ``around`` the wheel, alike if left out.

    On a finer grid where a partial curve leaves less than two steps in common.
    Orientations of which no point converged are left out and named in the source, and the average is partial; without
    any other it is one of them.
    """
    loaded = [c for c in curves if not c.unloaded]
    if not loaded:
        return replace(curves[0], orientation_deg=None, source="no point converged at any orientation")
    common = min(c.deflection[-1] for c in loaded) - max(c.deflection[0] for c in loaded)
    angles = [c.orientation_deg for c in loaded if c.orientation_deg is not None]
    weights = None if around is None else around.weights(angles)
    average = average_curve(loaded, min(0.5e-3, 0.5 * common), weights)
    if len(loaded) == len(curves):
        return average
    missing = ", ".join(f"{c.orientation_deg} deg" for c in curves if c.unloaded)
    return replace(average, source=f"{average.source}; without {missing}, where no point converged", partial=True)
