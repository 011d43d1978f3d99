"""Claim: 20 points from first touch to 30 mm take at most 80 Newton iterations at every orientation, contacts included.

Source: the project's own aim (docs/theory.md 2.3, benchmarks/README.md "Increments"). An iteration is one linearisation
of the body, with one factorisation. Planar model at five orientations, and a coarse solid model between two springs,
where the touching set moves most; springs, rim and hub hold each other off. The solid model's load at 30 mm is that of
a single increment to 1e-6, as both meet a residual of 1e-8. Negative control: steps that do not find the touching set
need more than 80, and end at the same load.
"""

from __future__ import annotations

import numpy as np
import pytest

from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact import newton_step as contact_step
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel
from reference_fe.wheel.section import solve_section

END, POINTS, MOST = 0.030, 20, 80


def load_case(orientation_deg: float, points: int) -> WheelLoadCase:
    deflections = tuple(np.linspace(0.0, END, points + 1)[1:].tolist())
    return WheelLoadCase(orientation_deg=orientation_deg, deflections=deflections)


def planar(orientation_deg: float) -> WheelResult:
    design = exomars_hoops()
    return solve_section(build_planar_mesh(design, element_size=16e-3), design, load_case(orientation_deg, POINTS))


def solid(points: int) -> WheelResult:
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=True)
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), load_case(15.0, points))


def iterations(result: WheelResult) -> int:
    return sum(len(record.residuals) - 1 for record in result.increments)


@pytest.mark.parametrize("orientation_deg", [0.0, 15.0, 30.0, 45.0, 60.0])
def test_planar_wheel_takes_at_most_eighty_iterations(orientation_deg: float) -> None:
    result = planar(orientation_deg)
    assert len(result.increments) == POINTS
    assert iterations(result) <= MOST


def test_without_the_search_for_the_touching_set_it_takes_more(monkeypatch: pytest.MonkeyPatch) -> None:
    found = planar(15.0)
    monkeypatch.setattr(contact_step, "INNER_LIMIT", 0)
    plain = planar(15.0)
    assert iterations(plain) > MOST
    assert plain.curve.load[-1] == pytest.approx(found.curve.load[-1], rel=1e-6)


@pytest.mark.long
@pytest.mark.slow
def test_solid_wheel_takes_at_most_eighty_iterations_and_one_increment_to_the_end() -> None:
    curve, end = solid(POINTS), solid(1)
    assert len(curve.increments) == POINTS
    assert iterations(curve) <= MOST
    assert [record.converged for record in end.increments] == [True]
    assert iterations(end) <= 15
    assert end.curve.load[-1] == pytest.approx(curve.curve.load[-1], rel=1e-6)
