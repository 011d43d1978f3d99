"""Equilibria of thin ANCF plates under loads or told displacements, for tests; steps that fail are halved."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from ancf_reduced.thin_plates.plates import ThinPlates
from contracts.materials import TI_6AL_4V, Material

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Load = Callable[[Array, float], tuple[Array, csc_array | float]]
"""Forces at nodes q and a share of the load, and their derivatives."""
_TOLERANCE = 1e-10
"""Work of the residual over that of the load, or the strain energy [-]."""


def metal(young_modulus: float, poisson_ratio: float, density: float = 1.0) -> Material:
    """A material of the numbers given."""
    return replace(TI_6AL_4V, young_modulus=young_modulus, poisson_ratio=poisson_ratio, density=density)


def dead(force: Array) -> Load:
    """A load that keeps its direction."""
    return lambda q, share: (share * force, 0.0)


def grid(along: int, across: int) -> tuple[Index, Index]:
    """Of every node its place (i, j) in a grid of plates."""
    i, j = np.meshgrid(np.arange(along + 1), np.arange(across + 1), indexing="ij")
    return i.ravel(), j.ravel()


def mirror(kept: NDArray[np.bool_], at: NDArray[np.bool_], normal: int, crossing: int) -> None:
    """Hold nodes ``at`` in a plane of symmetry of a normal; the parameter axis ``crossing`` (1, 2) goes through it."""
    along = [axis for axis in range(3) if axis != normal]
    for vector in (0, 3 - crossing):
        kept[at, vector, normal] = False
    for vector in (crossing, 3):
        for axis in along:
            kept[at, vector, axis] = False


def load_path(
    body: ThinPlates, kept: NDArray[np.bool_], load: Load, shares: Iterable[float], limit: int = 25
) -> tuple[list[Array], int]:
    """Nodes (n_nodes, 4, 3) at each share of a load, and linear solves; ``kept`` marks coordinates that are free."""
    q, at, states, solves = body.reference.copy(), 0.0, list[Array](), 0
    for share in shares:
        step = share - at
        while at < share:
            goal = share if share - at < 1.5 * step else at + step
            new, count = _loaded(body, kept.ravel(), q, load, goal, limit)
            solves += count
            if new is not None:
                q, at = new, goal
            elif step < 1e-5:
                raise AssertionError(f"no equilibrium at {goal} of the load")
            else:
                step *= 0.5
        states.append(q)
    return states, solves


def _loaded(
    body: ThinPlates, free: NDArray[np.bool_], q: Array, load: Load, share: float, limit: int
) -> tuple[Array | None, int]:
    stresses = body.stresses(q, np.zeros_like(q))
    for count in range(1, limit + 1):
        _, local, blocks = body.terms(q, stresses)
        force, slope = load(q, share)
        tangent = csc_array(body.assembled(blocks) - slope) if not isinstance(slope, float) else body.assembled(blocks)
        residual = (body.gathered(local) - force).ravel()[free]
        step = np.zeros(q.size)
        step[free] = splu(csc_array(tangent[free][:, free])).solve(-residual)
        stresses = body.stresses(q, step.reshape(q.shape))
        q = q + step.reshape(q.shape)
        work, scale = abs(residual @ step[free]), abs((force * (q - body.reference)).sum())
        if work < _TOLERANCE * scale:
            return q, count
        if not work < 1e4 * scale:
            break
    return None, count


def moved_path(
    body: ThinPlates, kept: NDArray[np.bool_], moved: Array, ways: Iterable[float]
) -> tuple[list[Array], int]:
    """Nodes with the held coordinates ``moved`` (1, else 0, or a direction) displaced by each way, and solves."""
    free, q, at, states, solves = kept.ravel(), body.reference.copy(), 0.0, list[Array](), 0
    for way in ways:
        stresses, told = body.stresses(q, np.zeros_like(q)), (way - at) * moved.ravel()
        for _ in range(40):
            energy, local, blocks = body.terms(q, stresses)
            tangent = body.assembled(blocks)
            residual = (body.gathered(local).ravel() + tangent @ told)[free]
            step = told.copy()
            step[free] = splu(csc_array(tangent[free][:, free])).solve(-residual)
            stresses, q, solves = body.stresses(q, step.reshape(q.shape)), q + step.reshape(q.shape), solves + 1
            if not told.any() and abs(residual @ step[free]) < _TOLERANCE * energy:
                break
            told = np.zeros(q.size)
        else:
            raise AssertionError(f"no equilibrium at {way}")
        at = way
        states.append(q)
    return states, solves
