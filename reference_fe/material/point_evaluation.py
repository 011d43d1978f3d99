"""Values of a UFL expression at fixed points of chosen cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.dolfinx_api import Expr, Mesh, compile_expression


class PointEvaluation:
    """Compiled UFL expression at fixed reference points, evaluated for chosen cells.

    Parameters
    ----------
    expression : UFL expression
    points : (n_points, dim) reference points
    """

    def __init__(self, expression: Expr, points: NDArray[np.float64]) -> None:
        self._compiled = compile_expression(expression, points)
        self._shape = (len(points), *expression.ufl_shape)

    def __call__(self, mesh: Mesh, cells: NDArray[np.int32]) -> NDArray[np.float64]:
        """Values, (n_cells, n_points, *shape)."""
        values = np.asarray(self._compiled.eval(mesh, cells))  # 0.9 gives them flat, (n_cells, n_points * size)
        return values.reshape(len(cells), *self._shape)
