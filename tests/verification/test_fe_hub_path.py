"""Claim: along a path of the hub energy is neither made nor lost: a wheel without friction gives back what was put in,
one that rubs dissipates what its contact counts.

Source: conservation of energy. The hub's work comes from force and moment on it, the stored energy from the energy
function, what friction takes from the points of contact. Tolerance: without friction the states on the way back are
those of the way there, so that work closes to Newton's tolerance of 1e-8, 1e-6 here; with friction 1e-4 of what is
dissipated: it slides at constant force, which the trapezoid rule takes exactly, and 1.2e-5 is left where it turns.
Negative controls: a force 1 % off and a dissipation left out are caught, and without friction nothing is dissipated.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.hub_travel import HubTravel, Way
from contracts.materials import TI_6AL_4V
from contracts.path_curve import PathCurve
from geometry.build import build_mesh
from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel
from reference_fe.wheel.section import solve_section

START = 0.006


def path_of(result: WheelResult, travel: HubTravel) -> PathCurve:
    """Of a planar wheel, whose columns are those of its plane."""
    curve, rows = result.curve, result.travelled
    pressed = {"load_N": curve.load, **curve.columns}
    columns = {name: np.array([*pressed[name], *(row.get(name, 0.0) for row in rows)]) for name in pressed}
    none = np.zeros(len(curve.load) + len(rows))
    columns = {"force_left_N": none, "moment_forward_Nm": none, "moment_up_Nm": none} | columns
    controls = [*curve.deflection, *(row["control"] for row in rows)]
    places = np.array([travel.place(control) for control in controls])
    return PathCurve(model="section", orientation_deg=15.0, places=places, columns=columns, source="test")


def moved(*places: dict[Way, float], friction: float, longest: float) -> PathCurve:
    travel = HubTravel.through([{Way.RADIAL: START}, *places], longest)
    case = WheelLoadCase(
        orientation_deg=15.0,
        deflections=(*(START * k / 6 for k in range(1, 6)), START),
        friction=friction,
        contact_stiffness=1e12,
        travel=travel,
    )
    mesh = build_planar_mesh(exomars_hoops(), element_size=14e-3)
    return path_of(solve_section(mesh, exomars_hoops(), case), travel)


@pytest.fixture(scope="module")
def rubbed() -> PathCurve:
    """Pushed far beyond the limit of friction, on less load back, and pressed again."""
    places = {Way.FORE_AFT: 0.03}, {Way.RADIAL: 0.004}, {Way.FORE_AFT: 0.0}, {Way.RADIAL: START}
    return moved(*places, friction=0.2, longest=0.5e-3)


def _open(curve: PathCurve) -> float:
    """What the hub's work leaves open over what is dissipated [-]."""
    return float(abs(curve.work[-1] - curve.stored[-1] - curve.lost[-1]) / curve.lost[-1])


def test_friction_takes_what_the_contact_says(rubbed: PathCurve) -> None:
    assert rubbed.lost[-1] > 2.0 * rubbed.stored[-1]
    assert (np.diff(rubbed.lost) >= -1e-15).all()
    assert _open(rubbed) < 1e-4
    pull, load = np.abs(rubbed.columns["force_forward_N"]), rubbed.columns["load_N"]
    assert pull[60] == pytest.approx(0.2 * load[60], rel=1e-6)


def test_a_force_that_is_off_or_a_loss_left_out_is_caught(rubbed: PathCurve) -> None:
    off = {**rubbed.columns, "force_forward_N": 1.01 * rubbed.columns["force_forward_N"]}
    assert _open(replace(rubbed, columns=off)) > 5e-3
    assert rubbed.work[-1] - rubbed.stored[-1] > 0.5 * rubbed.work[-1]


def test_without_friction_a_path_up_and_down_gives_everything_back() -> None:
    curve = moved({Way.RADIAL: 0.002}, {Way.RADIAL: START}, friction=0.0, longest=1e-3)
    top, end = 6, len(curve.places) - 1
    assert curve.work[top + 4] < 0.3 * curve.work[top]
    for values in (curve.work, curve.stored, curve.columns["load_N"]):
        assert values[end] == pytest.approx(values[top], rel=1e-6)
    assert curve.lost[-1] == 0.0


@pytest.mark.long
def test_leant_over_and_back_without_friction_the_whole_wheel_closes() -> None:
    """Two ways at once, a turn among them; there and back along another line, to what the trapezoid rule errs by."""
    mesh = build_mesh(exomars_hoops(), element_size=24e-3, axial_size=60e-3, parts="flexible", half_width=False)
    places = {Way.RADIAL: 0.004, Way.LEANING: 0.1}, {Way.LEANING: 0.0}, {Way.RADIAL: START}
    travel = HubTravel.through([{Way.RADIAL: START}, *places], 1e-3)
    case = WheelLoadCase(orientation_deg=15.0, deflections=(0.002, 0.004, START), travel=travel)
    curve = path_of(solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case), travel)
    assert np.abs(curve.columns["moment_forward_Nm"]).max() > 1.0
    assert curve.stored[-1] == pytest.approx(curve.stored[3], rel=1e-5)
    assert curve.work[-1] == pytest.approx(curve.work[3], rel=5e-3)
