"""A slender strip of plates under an end shear force, and under an end moment that rolls it into a full circle.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, sections 3.1 and 3.2: the table for the shear, in
contracts/published, and the exact circle for the moment. Units are the paper's. The moment is a couple on the end's
directors d that turns with them: F = M e x d / |d|^2 with the axis e = -y.
Verified by tests/verification/test_ancf_sze.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from ancf_reduced.motion.equilibrium import NewtonControls
from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import PlateModel, build_plate_model
from ancf_reduced.verification.plate_strips import Load, strip, strip_path
from contracts.errors import InputError
from contracts.published import published_table

__all__ = ["LENGTH", "THICKNESS", "CantileverPath", "EndLoad", "cantilever_path", "cantilever_table", "end_load"]

FloatArray = NDArray[np.float64]
type EndLoad = Literal["shear", "moment"]
YOUNG, WIDTH, THICKNESS = 1.2e6, 1.0, 0.1
LENGTH: dict[EndLoad, float] = {"shear": 10.0, "moment": 12.0}
"""Load -> length of the strip."""
SHEAR, MOMENT = 4.0, 50.0 * np.pi / 3.0
QUADRATURE = (4, 3, 2)
CONTROLS = NewtonControls(tolerance=1e-7, max_iterations=60, smallest_step=1e-4)
X, Y, Z = np.eye(3)
_TURN = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
"""v -> e x v."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CantileverPath:
    """What the run measured.

    Attributes
    ----------
    load : (n,) float, load factor [-]
    deflection, expected : (n, 2) float, shortening and deflection of the free end's middle, in the paper's unit
    length : of the strip, in the same unit
    iterations : linear solves of the whole run
    """

    load: FloatArray
    deflection: FloatArray
    expected: FloatArray
    length: float
    iterations: int

    @property
    def error(self) -> float:
        """Largest difference from what is expected, over the length [-]."""
        return float(np.abs(self.deflection - self.expected).max() / self.length)


def cantilever_path(
    load: EndLoad,
    plates: int,
    targets: Sequence[float] | None = None,
    *,
    thickness: float = THICKNESS,
    follows: bool = True,
) -> CantileverPath:
    """Bend a strip of ``plates`` plates.

    Parameters
    ----------
    targets : load factors [-], of those in the table; all of them but zero if left out
    thickness : of the strip, in the paper's unit of length; the load stays
    follows : whether the moment turns with the strip's end
    """
    length, table = LENGTH[load], cantilever_table(load)
    targets = table[1:, 0].tolist() if targets is None else targets
    rows = [int(np.argmin(np.abs(table[:, 0] - target))) for target in targets]
    if not np.allclose(table[rows, 0], targets, rtol=0.0, atol=1e-9):
        raise InputError("load factors", targets, "must be those of the table", "choose from 0.05, 0.1, ... 1")
    patches = strip(0.0 * X, length * X, WIDTH * Y, thickness, plates)
    model = build_plate_model(
        build_plate_mesh(patches), young_modulus=YOUNG, poisson_ratio=0.0, density=1.0, quadrature=QUADRATURE
    )
    path = strip_path(model, end_load(model, load, follows), targets, SHEAR, CONTROLS)
    return CantileverPath(
        load=path.load,
        deflection=path.displacement[:, [0, 2]] * [-1.0, 1.0],
        expected=table[rows, 1:],
        length=length,
        iterations=path.iterations,
    )


def cantilever_table(load: EndLoad) -> FloatArray:
    """(21, 3) float: load factor [-], shortening and deflection of the end, from rest."""
    if load == "shear":
        table = published_table("sze31_cantilever_end_shear")
        return np.column_stack([table[name] for name in ("P_over_Pmax", "minus_U_tip", "W_tip")])
    factor = np.linspace(0.0, 1.0, 21)
    a = 2.0 * np.pi * factor[1:]
    circle = np.column_stack([1.0 - np.sin(a) / a, (1.0 - np.cos(a)) / a])
    return np.column_stack([factor, LENGTH[load] * np.vstack([np.zeros(2), circle])])


def end_load(model: PlateModel, load: EndLoad, follows: bool) -> Load:
    """Half of the load on each end node; for ``cantilever_path``.

    Verified by tests/unit/test_ancf_end_load.py (finite differences).
    """
    points = model.mesh.points
    end, size = np.flatnonzero(points[:, 0] > points[:, 0].max() - 1e-9), 12 * len(points)

    def shear(p: FloatArray, factor: float) -> tuple[FloatArray, csc_array]:
        force = np.zeros(p.shape)
        force[end, 0, 2] = 0.5 * factor * SHEAR
        return force, csc_array((size, size))

    def moment(p: FloatArray, factor: float) -> tuple[FloatArray, csc_array]:
        d = p[end, 3] if follows else np.tile(Z, (len(end), 1))
        turned, square = d @ _TURN.T, np.sum(d * d, axis=1)[:, None]
        force, half = np.zeros(p.shape), 0.5 * factor * MOMENT
        force[end, 3] = half * turned / square
        slope = half * (_TURN / square[..., None] - 2.0 * turned[:, :, None] * d[:, None] / square[..., None] ** 2)
        rows = 12 * end[:, None] + np.arange(9, 12)
        i, j = np.repeat(rows, 3, axis=1).ravel(), np.tile(rows, 3).ravel()
        return force, coo_array((slope.ravel() if follows else 0.0 * slope.ravel(), (i, j)), (size, size)).tocsc()

    return shear if load == "shear" else moment
