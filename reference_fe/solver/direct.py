"""The sparse direct solver of the Newton iteration: MUMPS, and how its memory is kept between factorisations.

Verified by tests/unit/test_fe_direct_solver.py.
"""

from __future__ import annotations

import ctypes
import functools
from typing import Any

from reference_fe import dolfinx_api as api

__all__ = ["direct_solver"]

ORDERING, PORD = 7, 4
SCALING, NO_SCALING = 8, 0
"""Entries of MUMPS' control array ICNTL, and what they are set to."""

TRIM_THRESHOLD, MMAP_MAX = -1, -4
"""Parameters of glibc's mallopt(3)."""


def direct_solver(matrix: api.PETSc.Mat, *, symmetric: bool) -> api.PETSc.KSP:
    """Direct solver: MUMPS, on a symmetric matrix (indefinite allowed) with half the work.

    For symmetric matrices the order of elimination is PORD's, which suits thin strips and plates best of those MUMPS
    has, and the matrix is not scaled: its unknowns are all displacements. benchmarks/README.md has what both spare.
    PORD ends the process on a full matrix, such as that of a single cell; any order is as good there.
    """
    keep_freed_memory()
    ksp = api.PETSc.KSP().create(matrix.comm)
    ksp.setType("preonly")
    ksp.setOperators(matrix)
    pc = ksp.getPC()
    pc.setType("cholesky" if symmetric else "lu")
    pc.setFactorSolverType("mumps")
    if symmetric:
        pc.setFactorSetUpSolverType()
        factors = pc.getFactorMatrix()
        if not _is_full(matrix):
            factors.setMumpsIcntl(ORDERING, PORD)
        factors.setMumpsIcntl(SCALING, NO_SCALING)
    return ksp


def _is_full(matrix: api.PETSc.Mat) -> bool:
    """Whether every unknown is coupled with every other."""
    everywhere: Any = api.PETSc.Mat.InfoType.GLOBAL_SUM  # the stubs give it the wrong type
    entries = matrix.getInfo(everywhere)["nz_used"]
    return bool(entries >= matrix.getSize()[0] ** 2)


@functools.cache
def keep_freed_memory() -> bool:
    """Let this process keep memory that is freed, for the next allocation; False where the C library cannot.

    MUMPS frees its workspace after each factorisation and asks for it again at the next. glibc returns blocks of that
    size to the system at once, and the system then clears each page anew: up to a quarter of a factorisation's time.
    """
    library = ctypes.CDLL(None)
    if not hasattr(library, "mallopt"):
        return False
    return bool(library.mallopt(MMAP_MAX, 0)) and bool(library.mallopt(TRIM_THRESHOLD, 2**31 - 1))
