"""The mesh study's results: grid convergence at a few deflections, and the uncertainty of a curve between them.

Verified by tests/unit/test_workbench_mesh_study.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.questions.mesh_study.grid_convergence import GridConvergence, grid_convergence
from workbench.questions.model_curves import CURVE, RunNumbers, read_run
from workbench.questions.strength.yielding import utilisation
from workbench.study.orientation import orientation_name

__all__ = ["CREDIBLE_ORDERS", "MeshFamily", "MeshRow", "MeshRun", "MeshStudy", "sorted_runs"]

CREDIBLE_ORDERS = (1.0, 4.0)
"""Orders of the load with quadratic elements that are believed, of similar meshes. 4 where the solution is smooth: the
load is a derivative of the energy, whose error is the square of the strain's (order 2). Contact edges and the corners
at the welds lower it, to 1 at a crack's tip."""
_NONE = (math.inf, math.inf)
_SMALLEST_RATIO = 1.3
"""Of two factors, for an order to be believed (Celik et al. 2008)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshRun:
    """One mesh of the study.

    Attributes
    ----------
    factor : refinement factor of the mesh [-]
    curve : its curve, solved at the study's deflections
    numbers : how it was computed
    refined_axes : axes of a cell along which meshes differ: two of our strips, three of a mesh from another program
    """

    factor: float
    curve: StiffnessCurve
    numbers: RunNumbers
    refined_axes: int = 2

    @property
    def size(self) -> float:
        """Representative element size, up to a constant [-]: cells^(-1/2) in the surface of strips, else cells^(-1/3).

        Strips have the same number of elements through their thickness on every mesh.
        """
        cells = float(self.numbers.cells)
        return 1.0 / math.sqrt(cells) if self.refined_axes == 2 else cells ** (-1.0 / self.refined_axes)


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshRow:
    """A deflection [m] and what the three meshes say there; None if a curve ends before it."""

    deflection: float
    found: GridConvergence | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshFamily:
    """Three similar meshes at one orientation.

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
    def similar(self) -> bool:
        """Whether the meshes are similar, no count rounded, and far enough apart for an order to be believed."""
        factors = sorted(run.factor for run in self.runs)
        return all(f == round(f) for f in factors) and all(b >= _SMALLEST_RATIO * a for a, b in pairwise(factors))

    @property
    def rows(self) -> tuple[MeshRow, ...]:
        """What the meshes say at each deflection."""
        return tuple(
            MeshRow(deflection=d, found=self.convergence(d) if self.reached(d) else None) for d in self.deflections
        )

    def convergence(self, deflection: float) -> GridConvergence:
        """Grid convergence of the load at one of ``deflections`` [m]; InputError if a curve ends before it."""
        return self._converged([run.curve.load[_solved(run.curve, deflection)] for run in self.runs])

    def index(self, deflection: float) -> float:
        """Grid convergence index [-] of the mesh of the curves at one of ``deflections`` [m]."""
        return self._own(self.convergence(deflection))

    def stress_convergence(self, yield_strength: Mapping[str, float]) -> GridConvergence:
        """Grid convergence of the largest stress over yield strength, at the last deflection reached on every mesh."""
        last = max((d for d in self.deflections if self.reached(d)), default=None)
        if last is None:
            raise InputError("mesh study", "no deflection", "was reached on all three meshes", "choose smaller ones")
        used = [utilisation(run.curve, yield_strength).values() for run in self.runs]
        places = [_solved(run.curve, last) for run in self.runs]
        if not all(used):
            raise InputError("curve", "fe", "has no stress of any part", "compute it with stresses")
        return self._converged([max(u[i] for u in parts) for parts, i in zip(used, places, strict=True)])

    def stress_index(self, yield_strength: Mapping[str, float]) -> float:
        """Grid convergence index [-] of that stress on the mesh of the curves."""
        return self._own(self.stress_convergence(yield_strength))

    def reached(self, deflection: float) -> bool:
        """Whether every mesh's curve comes to a deflection [m]."""
        return all(run.curve.deflection[-1] >= deflection - 1e-12 for run in self.runs)

    def _converged(self, values: Sequence[float]) -> GridConvergence:
        credible = CREDIBLE_ORDERS if self.similar else _NONE
        return grid_convergence([float(v) for v in values], [run.size for run in self.runs], credible)

    def _own(self, found: GridConvergence) -> float:
        place = [run.factor for run in self.runs].index(self.curves_factor)
        return (found.index_fine, found.index_medium, found.index_coarse)[place]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshStudy:
    """Families of meshes at some orientations; the least certain of them speaks for all curves."""

    families: tuple[MeshFamily, ...]

    @property
    def credible_orders(self) -> tuple[float, float]:
        """An apparent order outside of these is not believed [-]."""
        return CREDIBLE_ORDERS

    @property
    def deflections(self) -> tuple[float, ...]:
        """Where loads are compared [m], increasing."""
        return self.families[0].deflections

    @property
    def runs(self) -> tuple[MeshRun, ...]:
        """Those of every family."""
        return tuple(run for family in self.families for run in family.runs)

    def index(self, deflection: float) -> float:
        """Largest grid convergence index [-] of the curves' mesh at one of ``deflections`` [m]."""
        return max(family.index(deflection) for family in self.families)

    def stress_index(self, yield_strength: Mapping[str, float]) -> float:
        """Largest grid convergence index [-] of the largest stress over yield strength on the curves' mesh."""
        return max(family.stress_index(yield_strength) for family in self.families)

    def relative_uncertainty(self, deflection: NDArray[np.float64]) -> NDArray[np.float64]:
        """Numerical uncertainty of a load over the load [-]: the largest index of any orientation, linear between
        ``deflections``, constant beyond them.

        Deflections that a curve of the study does not reach are left out; InputError if none is reached.
        """
        known = [
            (d, max(found)) for d in self.deflections if (found := [f.index(d) for f in self.families if f.reached(d)])
        ]
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


def _solved(curve: StiffnessCurve, deflection: float) -> int:
    """Place on a curve of a deflection [m] that was solved; an interpolated value would add its own error."""
    found = np.flatnonzero(np.abs(curve.deflection - deflection) < 1e-9)
    if not len(found):
        reach = f"{curve.deflection[-1] * 1e3:.4g} mm"
        rule = f"was not solved on every mesh (a curve ends at {reach})"
        raise InputError("mesh study's deflection", f"{deflection * 1e3:g} mm", rule, "raise fe.max_load or lower it")
    return int(found[0])


def sorted_runs(runs: Sequence[MeshRun]) -> tuple[MeshRun, MeshRun, MeshRun]:
    """Fine to coarse."""
    fine, medium, coarse = sorted(runs, key=lambda run: -run.factor)
    return fine, medium, coarse


def read_mesh_study(
    *,
    orientations_deg: Sequence[float],
    deflections: Sequence[float],
    factors: Sequence[float],
    curves_factor: float,
    folders: Mapping[str, Path],
    refined_axes: int = 2,
) -> MeshStudy:
    """The mesh study from the result folders of its runs."""
    families = []
    for orientation in orientations_deg:
        runs = []
        for factor in factors:
            folder = folders[mesh_run_name(factor, curves_factor, orientation)]
            curve = read_curve(folder / CURVE, model="fe", orientation_deg=orientation)
            runs.append(MeshRun(factor=factor, curve=curve, numbers=read_run(folder), refined_axes=refined_axes))
        families.append(
            MeshFamily(
                orientation_deg=orientation,
                deflections=tuple(deflections),
                runs=sorted_runs(runs),
                curves_factor=curves_factor,
            )
        )
    return MeshStudy(families=tuple(families))


def mesh_run_name(factor: float, curves_factor: float, orientation_deg: float) -> str:
    return orientation_name("fe" if factor == curves_factor else f"fe_x{factor:g}", orientation_deg)
