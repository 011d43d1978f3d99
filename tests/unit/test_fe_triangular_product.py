"""Our dgemmt gives the triangle of the product it should, touches nothing else, and is the one that MUMPS calls.

Without it, on another build of PETSc or a machine without a compiler, the same system is solved as well.
"""

from __future__ import annotations

import ctypes
import itertools
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from reference_fe.dolfinx_api import COMM, PETSc
from reference_fe.solver.direct import direct_solver
from reference_fe.solver.triangular_product import provide

ROOT = Path(__file__).parents[2]
LIBRARY = provide()
replaced = pytest.mark.skipif(LIBRARY is None, reason="this build of PETSc keeps its own dgemmt")


def pointer(value: float | np.ndarray) -> object:
    if isinstance(value, np.ndarray):
        return value.ctypes.data_as(ctypes.c_void_p)
    return ctypes.byref(ctypes.c_double(value) if isinstance(value, float) else ctypes.c_int(value))


@replaced
@pytest.mark.parametrize(("uplo", "ta", "tb"), list(itertools.product("UL", "NT", "NT")))
@pytest.mark.parametrize("n", [1, 47, 48, 131])
def test_one_triangle_is_updated(uplo: str, ta: str, tb: str, n: int) -> None:
    rng, k = np.random.default_rng(n), 5
    A, B, C = rng.standard_normal((n, k)), rng.standard_normal((k, n)), rng.standard_normal((n + 3, n))
    a, b = np.asfortranarray(A if ta == "N" else A.T), np.asfortranarray(B if tb == "N" else B.T)
    triangle = np.triu(np.ones((n, n), bool)) if uplo == "U" else np.tril(np.ones((n, n), bool))
    for beta in (0.0, 1.0, 0.5):
        c = C.copy(order="F")
        letters = [letter.encode() for letter in (uplo, ta, tb)]
        sizes = [pointer(x) for x in (n, k, -2.0, a, a.shape[0], b, b.shape[0], beta, c, c.shape[0])]
        LIBRARY.dgemmt_(*letters, *sizes)
        assert np.allclose(c[:n][triangle], (-2.0 * A @ B + beta * C[:n])[triangle], atol=1e-12)
        assert np.array_equal(c[:n][~triangle], C[:n][~triangle])
        assert np.array_equal(c[n:], C[n:])


@replaced
def test_mumps_calls_it() -> None:
    calls = ctypes.c_long.in_dll(LIBRARY, "dgemmt_calls")
    before, n = calls.value, 300
    dense = np.random.default_rng(0).standard_normal((n, n))
    dense += dense.T
    matrix = PETSc.Mat().createDense((n, n), array=np.asfortranarray(dense), comm=COMM).convert("aij")
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    x, b = matrix.createVecs()
    b.array[:] = 1.0
    direct_solver(matrix, symmetric=True).solve(b, x)
    assert np.allclose(dense @ x.array, 1.0, atol=1e-9)
    assert calls.value > before


ABSENT = {
    "another build of PETSc": "triangular_product._openblas = lambda: None",
    "no compiler": "import os; os.environ['CC'] = os.devnull",
}
SOLVED_WITHOUT = """
from reference_fe.solver import triangular_product
{}
from reference_fe.dolfinx_api import COMM, PETSc
from reference_fe.solver.direct import direct_solver
import numpy as np
assert triangular_product.provide() is None
dense = np.random.default_rng(0).standard_normal((300, 300))
dense += dense.T
matrix = PETSc.Mat().createDense((300, 300), array=np.asfortranarray(dense), comm=COMM).convert("aij")
matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
x, b = matrix.createVecs()
b.array[:] = 1.0
direct_solver(matrix, symmetric=True).solve(b, x)
assert np.allclose(dense @ x.array, 1.0, atol=1e-9)
print("solved")
"""


@pytest.mark.parametrize("absent", ABSENT)
def test_a_machine_without_it_solves_as_well(absent: str, tmp_path: Path) -> None:
    """In a fresh process, as what is loaded stays; nothing is compiled or left behind."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache"), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", SOLVED_WITHOUT.format(ABSENT[absent])]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert run.stdout == "solved\n", run.stderr
    assert not list(tmp_path.rglob("*.so"))
