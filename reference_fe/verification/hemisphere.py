"""A thin hemisphere with an 18 degree hole, pulled and pushed at its equator: a doubly curved shell that locks easily.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, section 3.4, in contracts/published. R = 10,
h = 0.04, E = 6.825e7, nu = 0.3; two pairs of radial forces of 400, of which a quarter model carries 200 each on its
symmetry planes, spread over the thickness here. Verified by tests/verification/test_fe_shell_hemisphere.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contracts.materials import Material
from contracts.published import published_table
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, ElementFamily, StaticProblem
from reference_fe.problem.supports import EdgeLoad, Support
from reference_fe.verification.load_path import LoadPath, load_path
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["QUARTERS", "TWENTY_NODES", "hemisphere_path", "hemisphere_table"]

SHELL = Material(
    name="shell", young_modulus=6.825e7, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="Sze et al. (2004)"
)
RADIUS, THICKNESS, FORCE = 10.0, 0.04, 200.0
QUARTERS = (0.25, 0.5, 0.75, 1.0)
TWENTY_NODES = Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 3))
_WATCHED = [((RADIUS, 0.0, 0.0), (1.0, 0.0, 0.0)), ((0.0, RADIUS, 0.0), (0.0, -1.0, 0.0))]


def hemisphere_path(
    cells: tuple[int, int] = (16, 16),
    discretisation: Discretisation = TWENTY_NODES,
    targets: Sequence[float] = QUARTERS,
    *,
    thickness: float = THICKNESS,
) -> LoadPath:
    """Outward and inward displacement of the loaded points; ``cells`` of a quarter around and along the meridian.

    ``targets`` are load factors [-]; ``thickness`` and displacements are in the benchmark's unit.
    """
    return load_path(_hemisphere(cells, discretisation, thickness), targets, _WATCHED)


def hemisphere_table() -> NDArray[np.float64]:
    """(20, 3) float: load factor [-], outward displacement of A and inward of B."""
    table = published_table("sze34_hemisphere_18deg_hole")
    return np.column_stack([table[name] for name in ("P_over_Pmax", "V_A", "minus_U_B")])


def _hemisphere(cells: tuple[int, int], discretisation: Discretisation, thickness: float) -> StaticProblem:
    """Quarter of the hemisphere; face x0 in the plane y = 0, x1 in x = 0, y0 the equator."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        around, up, r = 0.5 * np.pi * X[:, 0], np.deg2rad(72.0) * X[:, 1], RADIUS + thickness * (X[:, 2] - 0.5)
        return np.column_stack([r * np.cos(up) * np.cos(around), r * np.cos(up) * np.sin(around), r * np.sin(up)])

    line_load = FORCE / thickness
    return StaticProblem(
        Domain.from_tagged(block_mesh((*cells, 1), mapping)),
        {"body": SHELL},
        [
            Support(faces=("x0",), components=(1,)),
            Support(faces=("x1",), components=(0,)),
            Support(meetings=(("x0", "y0", "z0"),), components=(2,)),  # one node, against the rise as a whole
        ],
        loads=[
            EdgeLoad(meeting=("x0", "y0"), vector=(line_load, 0.0, 0.0)),
            EdgeLoad(meeting=("x1", "y0"), vector=(0.0, -line_load, 0.0)),
        ],
        discretisation=discretisation,
    )
