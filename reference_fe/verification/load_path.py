"""Load paths of shell benchmarks: watched displacements at wanted load factors, and their error against a table.

Verified by tests/verification/test_fe_shell_cantilever.py and tests/verification/test_fe_shell_hemisphere.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import IncrementRecord, InputError
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver

__all__ = ["LoadPath", "load_path", "relative_error"]

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
    increments, iterations : attempted increments and linear solves of the whole run
    """

    load: NDArray[np.float64]
    deflection: NDArray[np.float64]
    increments: int
    iterations: int


def load_path(problem: StaticProblem, targets: Sequence[float], watched: Sequence[Watched]) -> LoadPath:
    """Solve through the load factors ``targets`` [-] and watch some points, all lengths in the benchmark's unit."""
    points, history = problem.domain.tagged.points, list[IncrementRecord]()
    nodes = [int(np.argmin(np.linalg.norm(points - np.asarray(point), axis=1))) for point, _ in watched]
    load, rows = [], []
    for state in solve_increments(NewtonSolver(problem, SETTINGS), targets, history):
        if state.wanted:
            u = problem.nodal_displacement()
            load.append(state.control)
            rows.append([u[node] @ np.asarray(way) for node, (_, way) in zip(nodes, watched, strict=True)])
    return LoadPath(
        load=np.array(load),
        deflection=np.array(rows),
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
