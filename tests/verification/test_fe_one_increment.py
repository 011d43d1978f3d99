"""Claim: the wheel goes from first touch to 30 mm in one increment at every orientation, all contacts included.

Source: theory of mixed integration points and of the touching set (docs/theory.md 2.3; Magisano, Leonetti, Garcea
2017). Planar model; springs, rim and hub hold each other off, or pass through each other. Tolerance: the load is that
of ten increments to 1e-6, as both meet a residual of 1e-8. Negative controls, with contact inside at 30 degrees: steps
that do not find the touching set fail, and so do those that take every inner direction whole; plain Newton, without the
stress kept at the points, takes twice the iterations.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact import newton_step as contact_step
from reference_fe.problem.static_problem import Discretisation
from reference_fe.solver import increments
from reference_fe.wheel import problem as wheel_problem
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult
from reference_fe.wheel.section import solve_section

END = 0.030


class CutBackError(Exception):
    """An increment did not converge."""


def to_30_mm(orientation_deg: float, points: int, *, inner_contact: bool = True) -> WheelResult:
    design = exomars_hoops()
    mesh = build_planar_mesh(design, element_size=16e-3)
    deflections = tuple(np.linspace(0.0, END, points + 1)[1:].tolist())
    case = WheelLoadCase(orientation_deg=orientation_deg, deflections=deflections, inner_contact=inner_contact)
    return solve_section(mesh, design, case)


@pytest.mark.parametrize(
    ("orientation_deg", "inner_contact"),
    [(0.0, True), (15.0, True), (30.0, True), (45.0, True), (60.0, True), (15.0, False), (30.0, False)],
)
def test_one_increment_ends_where_ten_do(orientation_deg: float, inner_contact: bool) -> None:
    once = to_30_mm(orientation_deg, 1, inner_contact=inner_contact)
    often = to_30_mm(orientation_deg, 10, inner_contact=inner_contact)
    assert [record.converged for record in once.increments] == [True]
    assert once.curve.load[-1] == pytest.approx(often.curve.load[-1], rel=1e-6)


@pytest.fixture
def no_cut_back(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise CutBackError

    monkeypatch.setattr(increments.StaticProblem, "restore", refuse)


def test_plain_newton_needs_twice_the_iterations(monkeypatch: pytest.MonkeyPatch) -> None:
    def plain(**choices: Any) -> Discretisation:
        return Discretisation(**choices, mixed_integration_points=False)

    mixed = to_30_mm(30.0, 1).increments[0]
    monkeypatch.setattr(wheel_problem, "Discretisation", plain)
    assert len(to_30_mm(30.0, 1).increments[0].residuals) - 1 >= 2 * (len(mixed.residuals) - 1)


@pytest.mark.usefixtures("no_cut_back")
@pytest.mark.parametrize("left_out", ["SEARCHES", "INNER_LIMIT"])
def test_touching_set_needs_inner_iterations_and_their_line_search(
    left_out: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(contact_step, left_out, 0)
    with pytest.raises(CutBackError):
        to_30_mm(30.0, 1)
