"""What the shell benchmarks share: the published table, the path of chosen nodes, and the error along it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import IncrementRecord
from reference_fe.increments import solve_increments
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.static_problem import StaticProblem

DATA = Path(__file__).parent / "data"
SETTINGS = NewtonSettings(relative_tolerance=1e-8, maximum_iterations=30)


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadPath:
    """Converged points on the way to the full load.

    Attributes
    ----------
    load : (n,) load factor [-]
    deflection : (n, m) watched displacements, in the benchmark's unit
    increments, iterations : attempted increments and linear solves of the whole run
    """

    load: NDArray[np.float64]
    deflection: NDArray[np.float64]
    increments: int
    iterations: int


def published(name: str) -> NDArray[np.float64]:
    """Rows of a table of Sze, Liu & Lo (2004)."""
    return np.loadtxt(DATA / "sze2004" / f"{name}.csv", delimiter=",", skiprows=3, comments="#")


def load_path(
    problem: StaticProblem, targets: Sequence[float], watched: Sequence[tuple[Sequence[float], Sequence[float]]]
) -> LoadPath:
    """Solve through the targets; ``watched`` are pairs of a point (nearest node) and the direction counted positive."""
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

    ``reference`` has the load factor in its first column; the load factors of the path must be among them.
    """
    rows = [int(np.argmin(np.abs(reference[:, 0] - load))) for load in path.load]
    np.testing.assert_allclose(reference[rows, 0], path.load, atol=1e-12)
    expected = reference[rows, 1:]
    floor = 0.05 * np.abs(reference[:, 1:]).max(axis=0)
    return np.asarray((path.deflection - expected) / np.maximum(np.abs(expected), floor))
