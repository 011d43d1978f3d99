"""Strips of plates: straight rows, their linear response to a force, and their path under a growing load.

Verified by tests/verification/test_ancf_frames.py and tests/verification/test_ancf_cantilever.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from ancf_reduced.motion.equilibrium import NewtonControls, NewtonResult, follow_path, newton_solve
from ancf_reduced.plates.assembly import sparse_matrix
from ancf_reduced.plates.mesh import PlatePatch, flat_patch
from ancf_reduced.plates.model import PlateModel
from contracts.errors import IncrementRecord

__all__ = ["Load", "StripPath", "compliance", "strip", "strip_path"]

FloatArray = NDArray[np.float64]
type Load = Callable[[FloatArray, float], tuple[FloatArray, csc_array]]
"""Coordinates p (n_nodes, 4, 3) and load factor -> generalised force of p's shape, and its derivative by p."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StripPath:
    """Equilibria of a clamped strip on the way to its full load.

    Attributes
    ----------
    load : (n,) float, load factor [-]
    displacement : (n, 3) float [m], of the free end
    iterations : linear solves of the whole run
    """

    load: FloatArray
    displacement: FloatArray
    iterations: int


def strip(
    start: FloatArray, way: FloatArray, width: FloatArray, thickness: float, plates: int, part: str = "strip"
) -> list[PlatePatch]:
    """Equal flat plates in a row, one across the width.

    Parameters
    ----------
    start : (3,) float [m], corner of the first plate
    way, width : (3,) float [m], edges of the whole strip, at right angles
    thickness : [m]
    """
    step = way / plates
    return [flat_patch(start + i * step, step, width, thickness, part) for i in range(plates)]


def compliance(model: PlateModel, free: NDArray[np.bool_], force: FloatArray) -> float:
    """F . K^-1 F, twice the energy that a force stores in small deformation [J]; over |F|^2 the displacement per force.

    Parameters
    ----------
    free : (n_nodes, 4, 3) bool, components that are not held
    force : (n_nodes, 4, 3) float [N, N m]
    """
    rows, mesh = np.flatnonzero(free.ravel()), model.mesh
    K = sparse_matrix(mesh, model.elastic_tangents(mesh.reference_coordinates()))
    F = force.ravel()[rows]
    return float(F @ spsolve(K[rows][:, rows], F))


def strip_path(
    model: PlateModel, load: Load, factors: Sequence[float], scale: float, controls: NewtonControls
) -> StripPath:
    """Equilibria under growing load of plates clamped at x = 0; the displacement of the node of largest x is kept.

    ``scale`` is the force [N] that residuals are held against. Raises ConvergenceError where the path ends.
    """
    mesh, start = model.mesh, model.mesh.reference_coordinates()
    free, tip = np.flatnonzero(np.repeat(mesh.points[:, 0] > 1e-9, 12)), int(np.argmax(mesh.points[:, 0]))

    def full(x: FloatArray) -> FloatArray:
        p = start.copy()
        p.reshape(-1)[free] = x
        return p

    def solve_at(factor: float, x: FloatArray) -> NewtonResult:
        def residual(y: FloatArray) -> tuple[FloatArray, float]:
            p = full(y)
            return (model.elastic_force(p) - load(p, factor)[0]).ravel()[free], scale

        def tangent(y: FloatArray) -> csc_array:
            p = full(y)
            return (sparse_matrix(mesh, model.elastic_tangents(p)) - load(p, factor)[1])[free][:, free]

        return newton_solve(residual, tangent, x, controls, solve=spsolve)

    history = list[IncrementRecord]()
    points = list(follow_path(solve_at, (0.0, start.ravel()[free]), factors, controls, history))
    return StripPath(
        load=np.array(factors),
        displacement=np.array([full(point.x)[tip, 0] - mesh.points[tip] for point in points]),
        iterations=sum(point.iterations for point in points),
    )
