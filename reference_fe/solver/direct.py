"""The sparse direct solver of the Newton iteration: MUMPS, how its memory is kept, and what came of a factorisation.

Verified by tests/unit/test_fe_direct_solver.py.
"""

from __future__ import annotations

import ctypes
import functools
from dataclasses import replace
from typing import Any

import numpy as np

from contracts.errors import MemoryLimitError, WorkbenchError
from contracts.memory import MemoryBound, free_memory, shown_size
from reference_fe import dolfinx_api as api

__all__ = ["DirectSolver", "SingularMatrixError", "direct_solver"]

ORDERING, PORD = 7, 4
SCALING, NO_SCALING = 8, 0
ROOM = 14
"""Entries of MUMPS' control array ICNTL, and what they are set to; ROOM is that beyond its estimate [%]."""
MORE_ROOM = (60, 200, 600)
"""Room [%] of the next attempts where pivoting needs more than the estimate and the usual 20 %."""

STATE, DETAIL, NEGATIVE, LARGEST = 1, 2, 12, 16
"""Entries of MUMPS' INFOG: outcome (0 or an error), its detail, negative pivots, estimated memory of the largest
process [MB]."""
SINGULAR, NO_ROOM, NO_MEMORY = (-6, -10), (-8, -9, -14, -15, -17, -20), (-7, -13, -19)
"""Outcomes: matrix singular by structure or number; workspace as estimated too small; memory not to be had."""

TRIM_THRESHOLD, MMAP_MAX = -1, -4
"""Parameters of glibc's mallopt(3)."""
PETSC_OUT_OF_MEMORY = 55


class SingularMatrixError(WorkbenchError):
    """The matrix has no inverse: the body can move without a force, or its stiffness is no number."""


class DirectSolver:
    """Factors of a matrix, and solutions with them; the analysis of its pattern serves every later factorisation.

    PETSc's functions are called one by one, as its preconditioner would, so that the memory which the analysis asks for
    is judged before the numbers are computed, and no outcome goes unnoticed.
    """

    def __init__(self, matrix: api.PETSc.Mat, *, symmetric: bool) -> None:
        self._matrix, self._kind = matrix, "Cholesky" if symmetric else "LU"
        self._rooms = iter(MORE_ROOM)
        self._pc: api.PETSc.PC | None = None
        self._ready = False
        self._analysed = 0

    @property
    def factors(self) -> api.PETSc.Mat:
        """The matrix of factors, from which MUMPS' numbers are read."""
        assert self._pc is not None
        return self._pc.getFactorMatrix()

    @property
    def negative_pivots(self) -> int | None:
        """Negative eigenvalues of the matrix last factorised (Sylvester's law of inertia); None if unsymmetric."""
        return int(self.factors.getMumpsInfog(NEGATIVE)) if self._kind == "Cholesky" else None

    def factorise(self) -> None:
        """Factorise the matrix as it is now.

        Raises
        ------
        MemoryLimitError
            If the factors do not fit: with the memory needed and that to be had.
        SingularMatrixError
            If there are none.
        """
        self._ready = False
        if self._pc is None or self._pattern() != self._analysed:
            self._analyse()
        while (state := self._numeric()) in NO_ROOM and (room := self._more_room()):
            self._analyse(room)
        if state != 0 and not self._finite():
            self.release()
            raise SingularMatrixError("the stiffness matrix holds a number that is not finite")
        if state != 0:
            detail = f"MUMPS INFOG(1:2) = {state}, {self.factors.getMumpsInfog(DETAIL)}"
            error = self._too_large(detail)
            self.release()  # after some failures PETSc never factorises with them again
            if state in (*NO_ROOM, *NO_MEMORY):
                raise error
            if state in SINGULAR:
                raise SingularMatrixError(f"the stiffness matrix is singular ({detail})")
            raise WorkbenchError(f"the factorisation failed: {detail}; report this with the study")
        self._ready = True

    def solve(self, b: api.PETSc.Vec, x: api.PETSc.Vec) -> None:
        """Put the inverse times ``b`` into ``x``, by the last factors or, if there are none, new ones."""
        if not self._ready:
            self.factorise()
        self.factors.solve(b, x)

    def release(self) -> None:
        """Free the factors and the analysis."""
        self._ready = False
        if self._pc is not None:
            self._pc.destroy()
            self._pc = None

    def _analyse(self, room: int | None = None) -> None:
        """New factors, analysed but not computed; refused where they cannot fit."""
        self.release()
        pc = self._pc = api.PETSc.PC().create(self._matrix.comm)
        pc.setOperators(self._matrix)
        pc.setType(self._kind.lower())
        pc.setFactorSolverType("mumps")
        pc.setFactorSetUpSolverType()
        if self._kind == "Cholesky":
            if not _is_full(self._matrix):
                self.factors.setMumpsIcntl(ORDERING, PORD)
            self.factors.setMumpsIcntl(SCALING, NO_SCALING)
        if room is not None:
            self.factors.setMumpsIcntl(ROOM, room)
        self._analysed = self._pattern()
        permutations = (None,) if self._kind == "Cholesky" else (None, None)
        self._call(f"Mat{self._kind}FactorSymbolic", *permutations, None)
        if (state := self.factors.getMumpsInfog(STATE)) in NO_MEMORY:
            raise self._too_large(f"MUMPS INFOG(1) = {state} in the analysis")
        if 1e6 * self.factors.getMumpsInfog(LARGEST) > self._memory().bytes:
            raise self._too_large("found by the analysis, before anything was factorised")
        _give_back_freed_memory()

    def _numeric(self) -> int:
        """Compute the factors; MUMPS' outcome, 0 if all went well."""
        self._call(f"Mat{self._kind}FactorNumeric", None)
        return int(self.factors.getMumpsInfog(STATE))

    def _call(self, name: str, *more: None) -> None:
        """One of PETSc's C functions on factors and matrix."""
        handles = (ctypes.c_void_p(one.handle) for one in (self.factors, self._matrix))
        outcome = getattr(api.petsc_library(), name)(*handles, *more)
        if outcome == PETSC_OUT_OF_MEMORY:
            raise self._too_large(f"{name} got no more", alone=True)
        if outcome:
            raise WorkbenchError(f"the factorisation failed: {name} returned PETSc's error {outcome}; report this")

    def _pattern(self) -> int:
        """A number that changes whenever entries come to the matrix or go."""
        state = ctypes.c_int64()
        api.petsc_library().MatGetNonzeroState(ctypes.c_void_p(self._matrix.handle), ctypes.byref(state))
        return state.value

    def _more_room(self) -> int:
        """Room [%] of the next attempt; 0 if there is none, or numbers that are none would only waste it."""
        return next(self._rooms, 0) if self._finite() else 0

    def _finite(self) -> bool:
        """Whether every entry of the matrix is a finite number."""
        return bool(np.isfinite(self._matrix.norm()))

    def _memory(self, *, alone: bool = False) -> MemoryBound:
        """What each process, or this one ``alone``, may still take, that kept from earlier factorisations included."""
        comm = self._matrix.comm.tompi4py()
        free = free_memory(processes=comm.size)
        own = replace(free, bytes=free.bytes + _kept_memory())
        if alone:
            return own
        all_of_them: list[MemoryBound] = comm.allgather(own)
        return min(all_of_them, key=lambda bound: bound.bytes)

    def _too_large(self, found: str, *, alone: bool = False) -> MemoryLimitError:
        unknowns, needed = self._matrix.getSize()[0], 1e6 * self.factors.getMumpsInfog(LARGEST)
        amount = f"need about {shown_size(needed)}" if needed else "need more"
        each = "" if self._matrix.comm.size == 1 else " in one of the processes"
        return MemoryLimitError(
            f"the factors of {unknowns} unknowns {amount}{each}, and {self._memory(alone=alone)} ({found})",
            "choose a larger element_size or axial_size, run fewer tasks at once (--workers 1), or take a machine "
            "with more memory",
        )


def direct_solver(matrix: api.PETSc.Mat, *, symmetric: bool) -> DirectSolver:
    """Direct solver: MUMPS, on a symmetric matrix (indefinite allowed) with half the work.

    For symmetric matrices the order of elimination is PORD's, which suits thin strips and plates best of those MUMPS
    has, and the matrix is not scaled: its unknowns are all displacements. benchmarks/README.md has what both spare.
    PORD ends the process on a full matrix, such as that of a single cell; any order is as good there.
    """
    keep_freed_memory()
    return DirectSolver(matrix, symmetric=symmetric)


class _HeapUse(ctypes.Structure):
    """glibc's struct mallinfo2; ``fordblks`` is what is free within the heap [byte]."""

    _fields_ = (("others", 8 * ctypes.c_size_t), ("fordblks", ctypes.c_size_t), ("keepcost", ctypes.c_size_t))


def _kept_memory() -> float:
    """What this process keeps of freed memory for its next allocations [byte], see `keep_freed_memory`."""
    library = ctypes.CDLL(None)
    if not hasattr(library, "mallinfo2"):
        return 0.0
    library.mallinfo2.restype = _HeapUse
    return float(library.mallinfo2().fordblks)


def _give_back_freed_memory() -> None:
    """Give the system what was freed so far: gaps that the factors do not fit into."""
    library = ctypes.CDLL(None)
    if hasattr(library, "malloc_trim"):
        library.malloc_trim(0)


def _is_full(matrix: api.PETSc.Mat) -> bool:
    """Whether every unknown is coupled with every other."""
    everywhere: Any = api.PETSc.Mat.InfoType.GLOBAL_SUM  # the stubs give it the wrong type
    entries = matrix.getInfo(everywhere)["nz_used"]
    size = matrix.getSize()[0]
    return bool(entries >= (size * (size + 1) // 2 if matrix.type.endswith("sbaij") else size**2))


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
