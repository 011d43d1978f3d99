"""A shallow cylindrical roof on hinges under a force at its centre: it snaps through, and its deflection snaps back.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section 3.8, h = 6.35 mm, in contracts/published:
R = 2540 mm, half length 254 mm, half angle 0.1 rad, E = 3102.75 N/mm2, nu = 0.3, force 3000 N. The straight edges are
hinged along the line of their mid-surface, the curved ones free. A quarter is solved, its quarter of the force spread
over the thickness. Verified by tests/verification/test_fe_arc_length.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.materials import Material
from contracts.published import published_table
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import EdgeLoad, Middle, Support
from reference_fe.solver.arc_length import ArcLength
from reference_fe.verification.load_path import LoadPath, followed_path
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["CENTRE", "THICKNESS", "hinged_roof", "roof_path", "roof_table"]

SHELL = Material(
    name="shell", young_modulus=3102.75, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="Sze et al. (2004)"
)
RADIUS, HALF_ANGLE, HALF_LENGTH, THICKNESS, FORCE = 2540.0, 0.1, 254.0, 6.35, 3000.0
CENTRE = (0.0, 0.0, RADIUS)
ARC = ArcLength(first=0.05, longest=2.0)


def roof_path(cells: tuple[int, int] = (8, 8), arc: ArcLength = ARC, *, thickness: float = THICKNESS) -> LoadPath:
    """Downward displacement of the centre [mm] up to the full load; parameters as in `hinged_roof`."""
    return followed_path(hinged_roof(cells, thickness=thickness), arc, [(CENTRE, (0.0, 0.0, -1.0))])


def roof_table() -> NDArray[np.float64]:
    """(37, 2) float: load factor [-], downward displacement of the centre [mm]."""
    table = published_table("sze38d_hinged_roof_h6.35_isotropic")
    return np.column_stack([table["P_over_Pmax"], table["minus_W_C"]])


def hinged_roof(
    cells: tuple[int, int], *, thickness: float = THICKNESS, clamped: bool = False, drop: float | None = None
) -> StaticProblem:
    """Quarter of the roof, in N and mm; face x0 is the plane through the crown, y0 that halfway along it.

    Parameters
    ----------
    cells : around and along
    thickness : of the shell [mm]
    clamped : whether the straight edge is held over its whole thickness, not along its mid-surface alone
    drop : displacement of the centre at load factor 1 [mm], in place of the force
    """

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, r = HALF_ANGLE * X[:, 0], RADIUS + thickness * (X[:, 2] - 0.5)
        return np.column_stack([r * np.sin(angle), HALF_LENGTH * X[:, 1], r * np.cos(angle)])

    edge = Middle(between=("z0", "z1"), within=("x1",))
    supports = [
        Support(faces=("x0",), components=(0,)),
        Support(faces=("y0",), components=(1,)),
        Support(faces=("x1",), name="edge") if clamped else Support(middles=(edge,), name="edge"),
    ]
    if drop is not None:
        centre = Middle(between=("z0", "z1"), within=("x0", "y0"))
        supports.append(Support(middles=(centre,), components=(2,), value=(-drop,), name="centre"))
    line_load = -0.25 * FORCE / thickness
    return StaticProblem(
        Domain.from_tagged(block_mesh((*cells, 1), mapping)),
        {"body": SHELL},
        supports,
        loads=[] if drop is not None else [EdgeLoad(meeting=("x0", "y0"), vector=(0.0, 0.0, line_load))],
    )
