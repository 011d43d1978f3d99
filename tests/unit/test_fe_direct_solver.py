"""The direct solver: right answers for indefinite matrices, and no page asked for twice between factorisations."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.sparse import csr_array

from reference_fe.dolfinx_api import COMM, PETSc
from reference_fe.solver.direct import direct_solver

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
    direct_solver(matrix, symmetric=symmetric).solve(b, x)
    assert np.linalg.eigvals(dense).real.min() < 0.0
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
    run = subprocess.run(command, check=True, capture_output=True, text=True, timeout=120, env=environment)
    first, second = (int(word) for word in run.stdout.split())
    assert first > 100
    assert (second < 0.01 * first) == keep
