"""Sums and largest values over the processes of a parallel run; with one process nothing is sent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.dolfinx_api import COMM, MPI, Function, dolfinx


def sum_shared(function: Function) -> NDArray[np.float64]:
    """Own values (n_own,) of a function after the other processes' contributions have been added."""
    function.x.scatter_reverse(dolfinx.la.InsertMode.add)
    own = function.function_space.dofmap.index_map.size_local * function.function_space.dofmap.index_map_bs
    return np.array(function.x.array[:own])


def global_norm(own: NDArray[np.float64]) -> float:
    """Euclidean norm of a vector of which each process holds its own entries (n_own,); infinite if a square is."""
    with np.errstate(over="ignore", invalid="ignore"):
        local = float(np.linalg.norm(own))
    return local if COMM.size == 1 else float(np.sqrt(COMM.allreduce(local * local)))


def global_dot(own: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Scalar product of two vectors of which each process holds its own entries (n_own,)."""
    local = float(own @ other)
    return local if COMM.size == 1 else float(COMM.allreduce(local))


def largest_of_all[Number: (np.float64, np.int64)](local: NDArray[Number]) -> NDArray[Number]:
    """Largest value over the processes, entry by entry; shape and unit of ``local``."""
    if COMM.size == 1:
        return local
    largest = np.empty_like(local)
    COMM.Allreduce(np.ascontiguousarray(local), largest, op=MPI.MAX)
    return largest
