"""Friction of rigid ground on a wheel at rest: Coulomb's law with elastic stick, as the solid model has it.

From one equilibrium to the next a point under pressure that moves by s over the ground is pulled back by

    t = t_0 - k s, shortened to mu N where it is longer,

t_0 its pull at the equilibrium before and k the stiffness of its penalty (backward Euler, the return mapping of Simo &
Laursen, Comput. Struct. 42, 1992, from memory; docs/theory/contact.md). Whether a point slides, and which way, is of
the Newton step before; N is that of the step itself: the ground's force leans by mu. Verified by
tests/unit/test_ancf_wheel_rubbing.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

from ancf_reduced.wheel.contacts import Near
from ancf_reduced.wheel.ground import GroundContact, Pose

__all__ = ["Rubbed", "Since", "congruent", "rubbed"]

Array = NDArray[np.float64]
_STUCK = 1.0 - 1e-6
"""Pull over mu N below which a point stuck [-]."""
_SAME_WAY = 0.9
"""Least cosine between the pulls of two steps at a point that slides steadily [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Since:
    """What friction starts from.

    Attributes
    ----------
    q, pose : nodes and the ground's pose at the equilibrium before
    pull : of the ground at each contact there (n_ground, 3) [N]
    coefficient : mu [-]
    slides : unit vectors of the pull in the Newton step before (n_ground, 3), zero where a contact did not slide
    turned : (n_ground,) whether it slid the other way in a step before that one
    first : whether no Newton step has been made: what stuck there then sticks, however far the ground has moved on
    """

    q: Array
    pose: Pose
    pull: Array
    coefficient: float
    slides: Array
    turned: NDArray[np.bool_]
    first: bool = True

    @classmethod
    def equilibrium(cls, q: Array, pose: Pose, pull: Array, coefficient: float) -> Since:
        """Before the first Newton step."""
        nothing = np.zeros_like(pull)
        return cls(q=q, pose=pose, pull=pull, coefficient=coefficient, slides=nothing, turned=nothing[:, 0] > 0.0)

    def after(self, found: Rubbed) -> Since:
        """The same in the next Newton step."""
        slides, turned = np.zeros_like(self.slides), self.turned.copy()
        slides[found.numbers] = found.slides
        turned[found.numbers] |= (found.slides * self.slides[found.numbers]).sum(axis=1) < 0.0
        return replace(self, slides=slides, turned=turned, first=False)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rubbed:
    """Contacts under pressure, n of them.

    Attributes
    ----------
    numbers : of the contacts
    rows : where they are among the contacts that are near (n,)
    stuck : pull on the wheel of those that stick (n, 3) [N], zero of those that slide
    slides : unit vectors of the pull of those that slide (n, 3), zero of those that stick
    lean : mu times these: pull over N
    stiffness : minus the pull's derivative by the points' way at constant N (n, 3, 3) [N/m], or more
    slopes : derivatives (3 n, size) of the points' places by all coordinates
    """

    numbers: NDArray[np.int64]
    rows: NDArray[np.int64]
    stuck: Array
    slides: Array
    lean: Array
    stiffness: Array
    slopes: csr_array

    def pull(self, held: Array) -> Array:
        """On the wheel (n, 3) [N], for forces along the normal of the contacts that are near."""
        return np.asarray(self.stuck + held[self.rows, None] * self.lean)

    def leaning(self, count: int) -> csr_array:
        """What a unit of N does by friction at each of ``count`` contacts that are near (count, size)."""
        n = len(self.rows)
        starts = np.zeros(count + 1, dtype=np.int64)
        starts[self.rows + 1] = 3
        rows = csr_array((self.lean.ravel(), np.arange(3 * n), np.cumsum(starts)), shape=(count, 3 * n))
        return csr_array(rows @ self.slopes)


def rubbed(ground: GroundContact, q: Array, pose: Pose, near: Near, pressed: Array, since: Since) -> Rubbed:
    """What friction does at nodes q; ``pressed`` (n_ground,) is N, the force along the normal of every contact [N].

    A point that slides has no stiffness along its way, and may turn back within a step: until it slides the same way in
    two steps, and where it has turned before, its pull over its way stands for that, with which no step overshoots.
    """
    assert near.surface is not None
    under = np.flatnonzero(pressed[near.points] > 0.0)
    numbers, normals = near.points[under], near.surface.normals[under]
    (R, origin), (R_then, then) = pose, since.pose
    way = near.surface.places[under] - (ground.places(since.q, numbers) @ R_then.T + (origin - then)) @ R
    across = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    stick = near.stiffness[under]
    elastic = since.pull[numbers] @ (R_then.T @ R) - stick[:, None] * way
    trial = np.einsum("pij,pj->pi", across, elastic)
    size, limit = np.linalg.norm(trial, axis=1), since.coefficient * pressed[numbers]
    if since.first:
        stuck = np.linalg.norm(since.pull[numbers], axis=1) < _STUCK * limit
        limit = np.where(stuck, np.maximum(size, limit), limit)
    slides = np.where(size > limit, 1.0 / np.maximum(size, limit), 0.0)[:, None] * trial
    share = limit / np.maximum(size, limit)
    steady = ((slides * since.slides[numbers]).sum(axis=1) > _SAME_WAY) & ~since.turned[numbers]
    along = slides[:, :, None] * slides[:, None, :] * steady[:, None, None]
    bends = near.surface.bends[under]  # the ground's normal turns as a point moves on
    rate = stick[:, None, None] * across + (elastic * normals).sum(axis=1)[:, None, None] * bends
    rate += normals[:, :, None] * np.einsum("pij,pj->pi", bends, elastic)[:, None, :]
    return Rubbed(
        numbers=numbers,
        rows=under,
        stuck=np.where(size > limit, 0.0, 1.0)[:, None] * trial,
        slides=slides,
        lean=since.coefficient * slides,
        stiffness=share[:, None, None] * ((np.eye(3) - along) @ rate),
        slopes=ground.slopes(q, numbers),
    )


def congruent(slopes: csr_array, blocks: Array) -> csc_array:
    """S^T B S of slopes S (3 n, size) and blocks (n, 3, 3) on B's diagonal."""
    count = 3 * len(blocks)
    columns = 3 * np.arange(len(blocks))[:, None] + np.tile([0, 1, 2], 3)
    B = csr_array((blocks.ravel(), columns.ravel(), 3 * np.arange(count + 1)), shape=(count, count))
    return csc_array(slopes.T @ B @ slopes)
