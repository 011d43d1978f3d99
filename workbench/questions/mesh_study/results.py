"""The mesh study's results: grid convergence at a few deflections, and the uncertainty of a curve between them.

Verified by tests/unit/test_workbench_mesh_study.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.questions.mesh_study.grid_convergence import GridConvergence, grid_convergence
from workbench.questions.model_curves import CURVE, RunNumbers, read_run
from workbench.study.orientation import orientation_name

__all__ = ["METHOD_ORDER", "MeshRow", "MeshRun", "MeshStudy", "sorted_runs"]

METHOD_ORDER = 4.0
"""Order of the load with quadratic elements where the solution is smooth: the load is a derivative of the energy, whose
error is the square of the strain's (order 2). Contact edges and the corners at the welds lower it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshRun:
    """One mesh of the study.

    Attributes
    ----------
    factor : refinement factor of the mesh [-]
    curve : its curve, solved at the study's deflections
    numbers : how it was computed
    """

    factor: float
    curve: StiffnessCurve
    numbers: RunNumbers

    @property
    def size(self) -> float:
        """Representative element size in the surface of the strips, up to a constant [-]: cells^(-1/2).

        Strips have the same number of elements through their thickness on every mesh.
        """
        return 1.0 / math.sqrt(float(self.numbers.cells))


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshRow:
    """A deflection [m] and what the three meshes say there; None if a curve ends before it."""

    deflection: float
    found: GridConvergence | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshStudy:
    """Three meshes of one family at one orientation.

    Attributes
    ----------
    orientation_deg : where [deg]
    deflections : where loads are compared [m], increasing
    runs : three meshes, fine to coarse; each was solved at these deflections
    curves_factor : refinement factor of the mesh of all other curves, one of the three
    """

    orientation_deg: float
    deflections: tuple[float, ...]
    runs: tuple[MeshRun, MeshRun, MeshRun]
    curves_factor: float

    @property
    def method_order(self) -> float:
        """An apparent order above this one is not believed [-]."""
        return METHOD_ORDER

    @property
    def rows(self) -> tuple[MeshRow, ...]:
        """What the meshes say at each deflection."""
        return tuple(
            MeshRow(deflection=d, found=self.convergence(d) if self._reached(d) else None) for d in self.deflections
        )

    def convergence(self, deflection: float) -> GridConvergence:
        """Grid convergence of the load at one of ``deflections`` [m]; InputError if a curve ends before it."""
        loads = [_solved_load(run.curve, deflection) for run in self.runs]
        return grid_convergence(loads, [run.size for run in self.runs], METHOD_ORDER)

    def index(self, deflection: float) -> float:
        """Grid convergence index [-] of the mesh of the curves at one of ``deflections`` [m]."""
        found = self.convergence(deflection)
        place = [run.factor for run in self.runs].index(self.curves_factor)
        return (found.index_fine, found.index_medium, found.index_coarse)[place]

    def relative_uncertainty(self, deflection: NDArray[np.float64]) -> NDArray[np.float64]:
        """Numerical uncertainty of a load over the load [-]: the index, linear between ``deflections``, constant
        beyond them.

        Deflections that a curve of the study does not reach are left out; InputError if none is reached.
        """
        known = [(d, self.index(d)) for d in self.deflections if self._reached(d)]
        if not known:
            raise InputError("mesh study", "no deflection", "was reached on all three meshes", "choose smaller ones")
        places, indices = zip(*known, strict=True)
        return np.asarray(np.interp(deflection, places, indices))

    def band(self, curve: StiffnessCurve) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper load [N] of a curve at its own points."""
        width = self.relative_uncertainty(curve.deflection) * curve.load
        return curve.load - width, curve.load + width

    def stated(self, curve: StiffnessCurve) -> StiffnessCurve:
        """The curve with the column ``load_uncertainty_N``, which `workbench compare` reads; as it is if not known."""
        try:
            low, high = self.band(curve)
        except InputError:
            return curve
        return replace(curve, columns={**curve.columns, "load_uncertainty_N": 0.5 * np.abs(high - low)})

    def l2_uncertainty(self, reference: StiffnessCurve, start: float, end: float) -> float:
        """Uncertainty [-] of a relative L2 difference from ``reference`` over start..end [m].

        A reference that moves by U(d) F_ref moves the norm of the difference by at most norm(U F_ref).
        """
        d = np.linspace(start, end, 401)
        load = reference.load_at(d)
        return float(np.linalg.norm(self.relative_uncertainty(d) * load) / np.linalg.norm(load))

    def _reached(self, deflection: float) -> bool:
        return all(run.curve.deflection[-1] >= deflection - 1e-12 for run in self.runs)


def _solved_load(curve: StiffnessCurve, deflection: float) -> float:
    """Load [N] at a deflection [m] that was solved; an interpolated one would add its own error."""
    found = np.flatnonzero(np.abs(curve.deflection - deflection) < 1e-9)
    if not len(found):
        reach = f"{curve.deflection[-1] * 1e3:.4g} mm"
        rule = f"was not solved on every mesh (a curve ends at {reach})"
        raise InputError("mesh study's deflection", f"{deflection * 1e3:g} mm", rule, "raise fe.max_load or lower it")
    return float(curve.load[found[0]])


def sorted_runs(runs: Sequence[MeshRun]) -> tuple[MeshRun, MeshRun, MeshRun]:
    """Fine to coarse."""
    fine, medium, coarse = sorted(runs, key=lambda run: -run.factor)
    return fine, medium, coarse


def read_mesh_study(
    *,
    orientation_deg: float,
    deflections: Sequence[float],
    factors: Sequence[float],
    curves_factor: float,
    folders: Mapping[str, Path],
) -> MeshStudy:
    """The mesh study from the result folders of its runs."""
    runs = []
    for factor in factors:
        folder = folders[mesh_run_name(factor, curves_factor, orientation_deg)]
        curve = read_curve(folder / CURVE, model="fe", orientation_deg=orientation_deg)
        runs.append(MeshRun(factor=factor, curve=curve, numbers=read_run(folder)))
    return MeshStudy(
        orientation_deg=orientation_deg,
        deflections=tuple(deflections),
        runs=sorted_runs(runs),
        curves_factor=curves_factor,
    )


def mesh_run_name(factor: float, curves_factor: float, orientation_deg: float) -> str:
    return orientation_name("fe", orientation_deg) if factor == curves_factor else f"fe_x{factor:g}"
