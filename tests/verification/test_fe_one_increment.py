"""Claim: the wheel goes from first touch to 30 mm in one increment at every orientation, ground contact included.

Source: theory of mixed integration points (docs/theory.md 2.3; Magisano, Leonetti, Garcea 2017). Planar model, without
contact between springs and rim, whose changing touching set needs more (benchmarks/README.md). Tolerance: the load is
that of ten increments to 1e-6, as both meet a residual of 1e-8. Negative control: plain Newton fails.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from geometry import WheelDesign
from geometry.planar import build_planar_mesh
from reference_fe import increments, wheel_problem
from reference_fe.section import solve_section
from reference_fe.static_problem import Discretisation
from reference_fe.wheel import WheelLoadCase, WheelResult

END = 0.030


def to_30_mm(orientation_deg: float, points: int) -> WheelResult:
    design = WheelDesign()
    mesh = build_planar_mesh(design, element_size=16e-3)
    deflections = tuple(np.linspace(0.0, END, points + 1)[1:].tolist())
    case = WheelLoadCase(orientation_deg=orientation_deg, deflections=deflections, inner_contact=False)
    return solve_section(mesh, design, case)


@pytest.mark.parametrize("orientation_deg", [0.0, 15.0, 30.0])
def test_one_increment_ends_where_ten_do(orientation_deg: float) -> None:
    once, often = to_30_mm(orientation_deg, 1), to_30_mm(orientation_deg, 10)
    assert [record.converged for record in once.increments] == [True]
    assert once.curve.load[-1] == pytest.approx(often.curve.load[-1], rel=1e-6)


def test_plain_newton_needs_cut_backs(monkeypatch: pytest.MonkeyPatch) -> None:
    def plain(**choices: Any) -> Discretisation:
        return Discretisation(**choices, mixed_integration_points=False)

    class CutBackError(Exception):
        pass

    def refuse(*_: object) -> None:
        raise CutBackError

    monkeypatch.setattr(wheel_problem, "Discretisation", plain)
    monkeypatch.setattr(increments.StaticProblem, "restore", refuse)
    with pytest.raises(CutBackError):
        to_30_mm(0.0, 1)
