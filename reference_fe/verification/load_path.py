"""Load paths of shell benchmarks: watched displacements on the way to the full load, and their error against a table.

Verified by tests/verification/test_fe_shell_cantilever.py, tests/verification/test_fe_shell_hemisphere.py and
tests/verification/test_fe_arc_length.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from contracts.errors import IncrementRecord, InputError
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.solver.arc_length import ArcLength, follow_path
from reference_fe.solver.converged_state import ConvergedState
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver

__all__ = ["LoadPath", "distance_to_path", "followed_path", "limit_loads", "load_path", "relative_error"]

SETTINGS = NewtonSettings(relative_tolerance=1e-8, maximum_iterations=30)

type Watched = tuple[Sequence[float], Sequence[float]]
"""A point, of which the nearest node is watched, and the direction counted positive."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadPath:
    """Converged points on the way to the full load.

    Attributes
    ----------
    load : (n,) float, load factor [-]
    deflection : (n, m) float, watched displacements, in the benchmark's unit
    negative : (n,) int, negative eigenvalues of the tangent
    increments, iterations : attempted increments and linear solves of the whole run
    """

    load: NDArray[np.float64]
    deflection: NDArray[np.float64]
    negative: NDArray[np.int64]
    increments: int
    iterations: int


def load_path(problem: StaticProblem, targets: Sequence[float], watched: Sequence[Watched]) -> LoadPath:
    """Solve through the load factors ``targets`` [-] and watch some points, all lengths in the benchmark's unit."""
    history = list[IncrementRecord]()
    states = solve_increments(NewtonSolver(problem, SETTINGS), targets, history)
    return _watched_path(problem, (state for state in states if state.wanted), history, watched)


def followed_path(problem: StaticProblem, arc: ArcLength, watched: Sequence[Watched]) -> LoadPath:
    """Follow the path to the full load by arc length and watch some points, as `load_path` does."""
    history = list[IncrementRecord]()
    states = follow_path(NewtonSolver(problem, SETTINGS), arc, history, target=1.0)
    return _watched_path(problem, states, history, watched)


def _watched_path(
    problem: StaticProblem, states: Iterable[ConvergedState], history: list[IncrementRecord], watched: Sequence[Watched]
) -> LoadPath:
    points = problem.domain.tagged.points
    nodes = [int(np.argmin(np.linalg.norm(points - np.asarray(point), axis=1))) for point, _ in watched]
    load, rows, negative = [], [], []
    for state in states:
        u = problem.nodal_displacement()
        load.append(state.control)
        rows.append([u[node] @ np.asarray(way) for node, (_, way) in zip(nodes, watched, strict=True)])
        negative.append(state.outcome.negative_pivots or 0)
    return LoadPath(
        load=np.array(load),
        deflection=np.array(rows),
        negative=np.array(negative),
        increments=len(history),
        iterations=sum(len(record.residuals) - 1 for record in history),
    )


def relative_error(path: LoadPath, reference: NDArray[np.float64]) -> NDArray[np.float64]:
    """Error of each deflection, (n, m); below a twentieth of the column's largest value, relative to that twentieth.

    Parameters
    ----------
    path : its load factors must be among the reference's
    reference : (k, 1 + m) float: load factor, then the watched displacements

    Raises
    ------
    InputError
        If a load factor of the path is not in the reference.
    """
    rows = [int(np.argmin(np.abs(reference[:, 0] - load))) for load in path.load]
    if not np.allclose(reference[rows, 0], path.load, rtol=0.0, atol=1e-12):
        known = ", ".join(f"{load:g}" for load in reference[:, 0])
        raise InputError("load factors", path.load, "must be those of the published table", f"choose from {known}")
    expected = reference[rows, 1:]
    floor = 0.05 * np.abs(reference[:, 1:]).max(axis=0)
    return np.asarray((path.deflection - expected) / np.maximum(np.abs(expected), floor))


def distance_to_path(path: LoadPath, reference: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of each published point from our curve in the plane of load and one displacement, (k, m) [-].

    Both axes are scaled by the range of the published values, so that the published path is 1 wide and 1 high. Our
    curve is a cubic spline through the unloaded state and the points found, by their chord.

    Parameters
    ----------
    path : from the unloaded state on
    reference : (., 1 + m) float: load factor, then the watched displacements; k of them up to the path's largest load
    """
    reference, found = reference[reference[:, 0] <= path.load.max()], []
    for column in range(path.deflection.shape[1]):
        published = reference[:, [0, 1 + column]]
        size = np.ptp(published, axis=0)
        curve = _dense(np.column_stack([path.load, path.deflection[:, column]]) / size)
        found.append(cKDTree(curve).query(published / size)[0])
    return np.column_stack(found)


def limit_loads(path: LoadPath) -> NDArray[np.float64]:
    """Load factors at which the load along the path turns, in the order of the path, (n,) [-], by the same spline."""
    curve = _dense(np.column_stack([path.load, path.deflection / np.abs(path.deflection).max(axis=0)]))
    turns = np.flatnonzero(np.diff(np.sign(np.diff(curve[:, 0])))) + 1
    return np.asarray(curve[turns, 0])


def _dense(points: NDArray[np.float64], steps: int = 200) -> NDArray[np.float64]:
    """A cubic spline through the origin and points (n, d), ``steps`` points for each of them."""
    points = np.vstack([np.zeros(points.shape[1]), points])
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return np.asarray(CubicSpline(way, points)(np.linspace(0.0, way[-1], steps * len(way))))
