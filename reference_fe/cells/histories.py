"""What material points remember between increments: committed together, restored together.

Verified by tests/verification/test_fe_laws_plastic.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe.cells.general_cells import GeneralCells, PointSet

__all__ = ["Histories"]

Array = NDArray[np.float64]


class Histories:
    """History of the Gauss points and of every other set of points that follows the same deformation.

    Parameters
    ----------
    cells : whose Gauss points they are and whose pressure counts, or None: then nothing is remembered
    """

    def __init__(self, cells: GeneralCells | None) -> None:
        self._cells = cells if cells is not None and cells.points.yields else None
        self._sets = [] if self._cells is None else [self._cells.points]
        self._first: Array | None = None
        self._steps = 0

    @property
    def remembered(self) -> bool:
        """Whether any part has a history."""
        return self._cells is not None

    def follow(self, points: PointSet) -> None:
        """Commit a further set of points with the others from now on; the first step is made up for.

        Raises
        ------
        InputError
            After the second committed step: its points would have missed what came before.
        """
        if self._cells is None:
            return
        if self._steps > 1:
            rule = "must be asked for before the first increment: its points have a history of their own"
            raise InputError("stress of a body that yields", "asked for too late", rule, "make it with the problem")
        if self._first is not None:
            points.advance(self._first, self._cells.pressure(self._first)[0])
        self._sets.append(points)

    def accept(self, u: Array) -> None:
        """Commit the step to u (n_dofs,) [m]."""
        if self._cells is None:
            return
        if self._steps == 0:
            self._first = u.copy()
        self._steps += 1
        pressure = self._cells.pressure(u)[0]
        for points in self._sets:
            points.advance(u, pressure)

    def state(self) -> tuple[Array, ...]:
        """Copies of all histories, to come back to."""
        return tuple(points.past.copy() for points in self._sets)

    def restore(self, state: Sequence[Array]) -> None:
        """Go back to a state."""
        for points, past in zip(self._sets, state, strict=True):
            points.past[:] = past
