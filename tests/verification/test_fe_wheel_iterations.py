"""Claim: from first touch to 30 mm the wheel takes at most 80 Newton iterations for 20 points, one increment for one.

Source: the project's own aim (docs/theory.md, increments). Tolerance: the load at 30 mm of both ways agrees to 1e-6,
as the Newton tolerance is 1e-8 and both find the same equilibrium. Orientation 0, a coarse mesh, no inner contact;
benchmarks/README.md has the counts of the study's mesh, where 15 degrees needs more. Negative control: plain Newton,
without the stress kept at the points, fails in one increment.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from contracts.materials import TI_6AL_4V
from geometry import WheelDesign, build_mesh
from reference_fe import wheel, wheel_problem
from reference_fe.increments import ConvergedState
from reference_fe.newton import NewtonSolver
from reference_fe.static_problem import Discretisation
from reference_fe.wheel import WheelLoadCase, WheelResult, solve_wheel

END = 0.030


def to_30_mm(points: int, orientation_deg: float = 0.0) -> WheelResult:
    mesh = build_mesh(WheelDesign(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    deflections = tuple(np.linspace(0.0, END, points + 1)[1:].tolist())
    case = WheelLoadCase(orientation_deg=orientation_deg, deflections=deflections, inner_contact=False)
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)


def linear_solves(result: WheelResult) -> int:
    return sum(len(record.residuals) - 1 for record in result.increments)


@pytest.mark.slow
def test_twenty_points_in_eighty_iterations_and_one_point_in_one_increment() -> None:
    curve, end = to_30_mm(20), to_30_mm(1)
    assert len(curve.increments) == 20
    assert linear_solves(curve) <= 80
    assert len(end.increments) == 1
    assert linear_solves(end) <= 15
    assert end.curve.load[-1] == pytest.approx(curve.curve.load[-1], rel=1e-6)


@pytest.mark.slow
def test_plain_newton_does_not_make_it_in_one_increment(monkeypatch: pytest.MonkeyPatch) -> None:
    def plain(**choices: Any) -> Discretisation:
        return Discretisation(**choices, mixed_integration_points=False)

    monkeypatch.setattr(wheel_problem, "Discretisation", plain)
    monkeypatch.setattr(wheel, "solve_increments", one_attempt)
    with pytest.raises(RuntimeError, match="cut back"):
        to_30_mm(1)


def one_attempt(solver: NewtonSolver, *_: object, **__: object) -> list[ConvergedState]:
    """The first increment of `solve_increments`, without cut-back."""
    solver.problem.set_control(END)
    if not solver.solve(rise=0.98 * END).converged:
        raise RuntimeError("the increment would be cut back")
    return []
