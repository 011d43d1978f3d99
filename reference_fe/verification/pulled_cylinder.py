"""An open cylinder pulled apart at two opposite points of its middle: it flattens, then snaps to another form.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section 3.5, in contracts/published: R = 4.953,
L = 10.35, h = 0.094, E = 10.5e6, nu = 0.3125, two forces of 40 000, both ends free. An eighth is solved; a quarter of
the force acts on it, spread over the thickness. Verified by tests/verification/test_fe_arc_length.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.materials import Material
from contracts.published import published_table
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import EdgeLoad, Support
from reference_fe.solver.arc_length import ArcLength
from reference_fe.verification.load_path import LoadPath, followed_path
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["THICKNESS", "cylinder_path", "cylinder_table"]

SHELL = Material(
    name="shell",
    young_modulus=10.5e6,
    poisson_ratio=0.3125,
    density=1.0,
    yield_strength=1e9,
    source="Sze et al. (2004)",
)
RADIUS, HALF_LENGTH, THICKNESS, FORCE = 4.953, 5.175, 0.094, 40e3
ARC = ArcLength(first=0.002, longest=2.0, widest=0.05)
_WATCHED = [
    ((0.0, 0.0, RADIUS), (0.0, 0.0, 1.0)),
    ((RADIUS, 0.0, 0.0), (-1.0, 0.0, 0.0)),
    ((RADIUS, HALF_LENGTH, 0.0), (-1.0, 0.0, 0.0)),
]


def cylinder_path(cells: tuple[int, int] = (12, 12), arc: ArcLength = ARC, *, thickness: float = THICKNESS) -> LoadPath:
    """Outward displacement of the loaded point A, inward ones of B and C, a quarter turn from A in the middle and at
    the end; ``cells`` of the eighth around and along, lengths in the benchmark's unit."""
    return followed_path(_cylinder(cells, thickness), arc, _WATCHED)


def cylinder_table() -> NDArray[np.float64]:
    """(24, 4) float: load factor [-], displacement of A outwards, of B and C inwards."""
    table = published_table("sze35_pullout_open_cylinder")
    return np.column_stack([table[name] for name in ("P_over_Pmax", "W_A", "minus_U_B", "minus_U_C")])


def _cylinder(cells: tuple[int, int], thickness: float) -> StaticProblem:
    """Eighth of the cylinder; face x0 is the plane through A, x1 that through B and C, y0 the middle."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, r = 0.5 * np.pi * X[:, 0], RADIUS + thickness * (X[:, 2] - 0.5)
        return np.column_stack([r * np.sin(angle), HALF_LENGTH * X[:, 1], r * np.cos(angle)])

    return StaticProblem(
        Domain.from_tagged(block_mesh((*cells, 1), mapping)),
        {"body": SHELL},
        [
            Support(faces=("x0",), components=(0,)),
            Support(faces=("x1",), components=(2,)),
            Support(faces=("y0",), components=(1,)),
        ],
        loads=[EdgeLoad(meeting=("x0", "y0"), vector=(0.0, 0.0, 0.25 * FORCE / thickness))],
    )
