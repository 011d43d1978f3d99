"""A slender cantilever under an end shear force, and under an end moment that rolls it into a full circle.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, sections 3.1 and 3.2, in contracts/published
(for the moment, the exact columns: U/L = sin(a)/a - 1, W/L = (1 - cos a)/a, a = 2 pi M/M_max). Units are the paper's.
Verified by tests/verification/test_fe_shell_cantilever.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from contracts.materials import Material
from contracts.published import published_table
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import EndMoment, Load, Support, Traction
from reference_fe.verification.load_path import LoadPath, load_path
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["LENGTH", "THICKNESS", "EndLoad", "cantilever_path", "cantilever_table"]

STRIP = Material(
    name="strip", young_modulus=1.2e6, poisson_ratio=0.0, density=1.0, yield_strength=1e9, source="Sze et al. (2004)"
)
type EndLoad = Literal["shear", "moment"]
WIDTH, THICKNESS = 1.0, 0.1
AREA = WIDTH * THICKNESS
LENGTH: dict[EndLoad, float] = {"shear": 10.0, "moment": 12.0}
"""Load -> length of the strip."""
_LOADS: dict[EndLoad, Load] = {
    "shear": Traction(faces=("x1",), vector=(0.0, 0.0, 4.0 / AREA)),
    "moment": EndMoment(
        faces=("x1",), magnitude=50.0 * np.pi / 3.0 / AREA, axis=(0.0, -1.0, 0.0), director=(0.0, 0.0, 1.0)
    ),
}


def cantilever_path(
    load: EndLoad,
    cells: int = 16,
    targets: Sequence[float] | None = None,
    *,
    discretisation: Discretisation | None = None,
    thickness: float = THICKNESS,
) -> LoadPath:
    """Shortening and deflection of the free end's middle under ``"shear"`` or ``"moment"``.

    Parameters
    ----------
    cells : along the strip
    targets : load factors [-]; those of the table if left out
    thickness : of the strip, in the benchmark's unit; the load per area of its end stays
    """
    targets = cantilever_table(load)[1:, 0].tolist() if targets is None else targets
    end = [LENGTH[load], 0.5 * WIDTH, 0.0]
    problem = _cantilever(load, cells, discretisation, thickness)
    return load_path(problem, targets, [(end, [-1.0, 0.0, 0.0]), (end, [0.0, 0.0, 1.0])])


def cantilever_table(load: EndLoad) -> NDArray[np.float64]:
    """(21, 3) float: load factor [-], shortening and deflection of the end, from rest."""
    if load == "shear":
        table, names = published_table("sze31_cantilever_end_shear"), ("P_over_Pmax", "minus_U_tip", "W_tip")
    else:
        table = published_table("sze32_cantilever_end_moment")
        names = ("M_over_Mmax", "minus_U_tip_exact", "W_tip_exact")
    return np.column_stack([table[name] for name in names])


def _cantilever(load: EndLoad, cells: int, discretisation: Discretisation | None, thickness: float) -> StaticProblem:
    """Strip along x, clamped at x = 0, one cell wide and thick."""
    applied, length = _LOADS[load], LENGTH[load]

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.column_stack([length * X[:, 0], WIDTH * X[:, 1], thickness * (X[:, 2] - 0.5)])

    return StaticProblem(
        Domain.from_tagged(block_mesh((cells, 1, 1), mapping)),
        {"body": STRIP},
        [Support(faces=("x0",))],
        loads=[applied],
        discretisation=discretisation,
    )
