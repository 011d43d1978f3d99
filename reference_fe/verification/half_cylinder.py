"""A clamped half cylinder whose outer crown line is pressed down by 20 mm: two other codes give the digits.

Source: contracts/published/halfcyl_crown_reaction.csv, measured with CalculiX 2.20 (C3D20R) and FElupe 11.3, which
agree to 5e-6: 20-node hexahedra, 2 x 2 x 2 points, St. Venant-Kirchhoff, three meshes; R 140 mm, t 2 mm, W 100 mm. A
quarter is solved: the forces are four times those of its share of the crown line.
Verified by tests/verification/test_fe_half_cylinder.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import IncrementRecord
from contracts.materials import Material
from contracts.published import published_table
from reference_fe.problem.balance import support_forces
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, ElementFamily, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = [
    "FELUPE",
    "FELUPE_S8",
    "LOADS",
    "MESHES",
    "THICKNESS",
    "TWENTY_NODES",
    "CrownForce",
    "calculix",
    "crown_force",
    "half_cylinder",
]

STEEL = Material(
    name="steel", young_modulus=2.1e11, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="benchmark"
)
RADIUS, THICKNESS, WIDTH, DEPTH = 0.140, 0.002, 0.100, 0.020
MESHES = {"s8": (20, 4), "s60": (60, 12), "s200": (110, 22)}
"""Cells of a quarter around and across; the whole has 40 x 8, 120 x 24, 220 x 44."""
LOADS = (0.25, 0.5, 0.875, 1.0)
"""Fractions of the depth in CalculiX' table."""
FELUPE = {"s8": -5412.4747, "s60": -5388.8414, "s200": -5383.9406}
"""Force at the full depth [N], from the table's header."""
FELUPE_S8 = {0.25: -2003.1418, 0.5: -3458.4908}
"""Force on mesh s8 at these fractions of the depth [N], from the table's header."""
TWENTY_NODES = Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class CrownForce:
    """What the run measured.

    Attributes
    ----------
    load : (n,) float, fraction of the depth [-]
    force : (n,) float, of the crown line on the whole body, upwards [N]
    imbalance : largest |sum of the reactions| over the force [-]
    iterations, increments : linear solves and attempted increments in all
    """

    load: NDArray[np.float64]
    force: NDArray[np.float64]
    imbalance: float
    iterations: int
    increments: int


def crown_force(
    cells: tuple[int, int],
    discretisation: Discretisation = TWENTY_NODES,
    loads: Sequence[float] = LOADS,
    *,
    graded: bool = False,
    thickness: float = THICKNESS,
) -> CrownForce:
    """Press the crown down through fractions ``loads`` of the depth [-]; see `half_cylinder` for the mesh."""
    problem = half_cylinder(cells, discretisation, graded=graded, thickness=thickness)
    solver = NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-10))
    attempts = list[IncrementRecord]()
    states = [state for state in solve_increments(solver, loads, attempts) if state.wanted]
    force = np.array([float(support_forces(problem, state.outcome.residual)["crown"][1]) for state in states])
    return CrownForce(
        load=np.array([state.control for state in states]),
        force=4.0 * force,
        imbalance=float(np.max(np.abs([state.reaction[1] for state in states] / force))),
        iterations=sum(len(attempt.residuals) - 1 for attempt in attempts),
        increments=len(attempts),
    )


def half_cylinder(
    cells: tuple[int, int], discretisation: Discretisation, *, graded: bool = False, thickness: float = THICKNESS
) -> StaticProblem:
    """Quarter model: x0 the clamp, x1 the crown plane, y0 the middle of the width, y1 the free edge, z1 outside.

    ``cells`` are around and across, ``thickness`` is the shell's [m].

    ``graded`` makes the cells at the clamp 0.15 times their mean length, and those at the free edge small as well.
    """

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        s, z = X[:, 0], X[:, 1]
        if graded:
            s, z = s * (0.15 + 0.85 * s), 1.0 - (1.0 - z) ** 2
        angle, r = 0.5 * np.pi * s, RADIUS + thickness * (X[:, 2] - 0.5)
        return np.column_stack([r * np.cos(angle), r * np.sin(angle), 0.5 * WIDTH * z])

    return StaticProblem(
        Domain.from_tagged(block_mesh((*cells, 1), mapping)),
        {"body": STEEL},
        [
            Support(faces=("x0",)),
            Support(faces=("x1",), components=(0,)),
            Support(faces=("y0",), components=(2,)),
            Support(meetings=(("x1", "z1"),), components=(1,), value=(-DEPTH,), name="crown"),
        ],
        discretisation=discretisation,
    )


def calculix(mesh: str) -> NDArray[np.float64]:
    """(4,) float: force of CalculiX at `LOADS` on one of `MESHES` [N]."""
    table = published_table("halfcyl_crown_reaction")
    return np.asarray(table["crown_Fy_N"][np.array(table.text("mesh")) == mesh])
