"""The direct solver: right answers for indefinite matrices, no page asked for twice, no failure unnoticed."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from contracts.errors import MemoryLimitError
from contracts.memory import MemoryBound
from reference_fe.dolfinx_api import COMM, PETSc
from reference_fe.solver.direct import MORE_ROOM, ROOM, DirectSolver, SingularMatrixError, direct_solver

SECOND_USE = """
import resource
import numpy as np
if {keep}:
    from reference_fe.solver.direct import keep_freed_memory
    assert keep_freed_memory()
def faults():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    np.full(8_000_000, 1.0)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before
print(faults(), faults())
"""


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("full", [True, False])
def test_an_indefinite_matrix_is_solved(symmetric: bool, full: bool) -> None:
    """Full ones too: PORD would end the process."""
    rng = np.random.default_rng(1)
    dense = rng.standard_normal((40, 40))
    dense = dense + dense.T if symmetric else dense
    if not full:
        dense[:4, 30:], dense[30:, :4] = 0.0, 0.0
    pattern = csr_array(dense)
    matrix = PETSc.Mat().createAIJ((40, 40), csr=(pattern.indptr, pattern.indices, pattern.data), comm=COMM)
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, symmetric)
    x, b = matrix.createVecs()
    b.array[:] = 1.0
    solver = direct_solver(matrix, symmetric=symmetric)
    solver.solve(b, x)
    assert np.linalg.eigvals(dense).real.min() < 0.0
    assert solver.negative_pivots == ((np.linalg.eigvalsh(dense) < 0.0).sum() if symmetric else None)
    assert np.allclose(dense @ x.array, 1.0, atol=1e-10)


@pytest.mark.parametrize("keep", [True, False])
def test_freed_memory_is_used_again(keep: bool) -> None:
    """64 MB, twice: the second time without page faults; with as many as the first time where nothing is kept.

    In small pages: whether the system has a large one at hand differs from run to run.
    """
    command, environment = (
        [sys.executable, "-c", SECOND_USE.format(keep=keep)],
        os.environ | {"NUMPY_MADVISE_HUGEPAGE": "0"},
    )
    run = subprocess.run(command, check=True, capture_output=True, text=True, env=environment)
    first, second = (int(word) for word in run.stdout.split())
    assert first > 100
    assert (second < 0.01 * first) == keep


def _tridiagonal(diagonal: float, n: int = 200) -> tuple[Any, Any, Any]:
    """A symmetric matrix with its vectors x and b = 1; singular where the diagonal is zero and n odd."""
    ones = np.ones(n)
    rows = csr_array(diags_array([ones[1:], diagonal * ones, ones[1:]], offsets=[-1, 0, 1]))
    matrix = PETSc.Mat().createAIJ((n, n), csr=(rows.indptr, rows.indices, rows.data), comm=COMM)
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    x, b = matrix.createVecs()
    b.array[:] = 1.0
    return matrix, x, b


def test_a_singular_matrix_is_told_and_the_next_one_solved() -> None:
    """PETSc alone gives infinities without a word."""
    matrix, x, b = _tridiagonal(0.0, 201)
    solver = direct_solver(matrix, symmetric=True)
    with pytest.raises(SingularMatrixError, match="singular"):
        solver.solve(b, x)
    matrix.shift(4.0)
    solver.factorise()
    solver.solve(b, x)
    assert np.isfinite(x.array).all()
    assert x.array[100] == pytest.approx(1.0 / 6.0, rel=1e-9)


@pytest.mark.parametrize("number", [np.nan, np.inf])
@pytest.mark.parametrize("symmetric", [True, False])
def test_a_matrix_of_numbers_that_are_none_is_singular_not_too_large(number: float, symmetric: bool) -> None:
    """MUMPS finds no pivots and asks for room without end."""
    matrix, x, b = _tridiagonal(4.0, 3000)
    matrix.scale(number)
    with pytest.raises(SingularMatrixError, match="not finite"):
        direct_solver(matrix, symmetric=symmetric).solve(b, x)


def test_entries_that_come_to_the_matrix_are_seen() -> None:
    matrix, x, b = _tridiagonal(4.0)
    solver = direct_solver(matrix, symmetric=True)
    solver.solve(b, x)
    matrix.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    for row, column in ((0, 199), (199, 0)):
        matrix.setValue(row, column, 1.0)
    matrix.assemble()
    solver.factorise()
    solver.solve(b, x)
    residual = b.duplicate()
    matrix.mult(x, residual)
    assert np.allclose(residual.array, 1.0, atol=1e-12)


def test_factors_that_do_not_fit_are_refused_before_they_are_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    matrix, x, b = _tridiagonal(4.0, 20000)
    bound = MemoryBound(bytes=-1e12, source="on this machine now")
    monkeypatch.setattr("reference_fe.solver.direct.free_memory", lambda processes: bound)
    numeric: list[int] = []
    monkeypatch.setattr(DirectSolver, "_numeric", lambda self: numeric.append(1))
    with pytest.raises(MemoryLimitError, match=r"factors of 20000 unknowns need about \d+ MB, and .* available"):
        direct_solver(matrix, symmetric=True).solve(b, x)
    assert not numeric


@pytest.mark.parametrize(("failures", "solved"), [(2, True), (9, False)])
def test_a_workspace_that_is_too_small_is_enlarged(
    failures: int, solved: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """MUMPS' outcome -9: three times with more room, then it is a lack of memory."""
    matrix, x, b = _tridiagonal(4.0)
    numeric, rooms = DirectSolver._numeric, list[int]()

    def failing(self: DirectSolver) -> int:
        rooms.append(self.factors.getMumpsIcntl(ROOM))
        return numeric(self) if len(rooms) > failures else -9

    monkeypatch.setattr(DirectSolver, "_numeric", failing)
    solver = direct_solver(matrix, symmetric=True)
    if solved:
        solver.solve(b, x)
        assert x.array[100] == pytest.approx(1.0 / 6.0, rel=1e-9)
    else:
        with pytest.raises(MemoryLimitError, match=r"INFOG\(1:2\) = -9"):
            solver.solve(b, x)
    assert rooms[1:] == list(MORE_ROOM)[: failures if solved else 3]


def test_the_analysis_serves_every_later_factorisation(monkeypatch: pytest.MonkeyPatch) -> None:
    matrix, x, b = _tridiagonal(4.0)
    analyse, count = DirectSolver._analyse, list[int]()
    monkeypatch.setattr(DirectSolver, "_analyse", lambda self: (count.append(1), analyse(self)))
    solver = direct_solver(matrix, symmetric=True)
    for shift in (0.0, 1.0, 1.0):
        matrix.shift(shift)
        solver.factorise()
    solver.solve(b, x)
    assert x.array[100] == pytest.approx(1.0 / 8.0, rel=1e-9)
    assert len(count) == 1
