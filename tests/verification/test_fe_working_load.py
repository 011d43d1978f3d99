"""Claim: forces and moments of a wheel whose hub is moved over the ground balance, and its two models agree on them.

Source: Coulomb's law (a wheel that slides is held by mu N), energy (the hub's work goes into the wheel, into elastic
slip and into friction), and the thin plates, which share nothing with the solid but the design. Tolerances: work by the
trapezoidal rule over few steps 3 %; a coarse solid mesh against fine plates 5 % (fine meshes 0.4 %),
the load where it is pressed 1.5 %.
"""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround, press
from contracts.errors import InputError
from contracts.hub_travel import HubTravel, Way
from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.wheel.pressed import WheelLoadCase, WheelResult, solve_wheel

START, FRICTION, ORIENTATION = 6e-3, 0.3, 15.0
APPROACH = (START / 3, 2 * START / 3, START)
STEPS = {
    Way.FORE_AFT: (1e-3, 2e-3),
    Way.LATERAL: (0.4e-3, 0.8e-3, 1.0e-3, 1.2e-3, 2.0e-3),
    Way.TURNING: (4e-3, 8e-3),
    Way.WIND_UP: (5e-3, 10e-3, 20e-3, 40e-3),
}


def travel_of(way: Way) -> HubTravel:
    return HubTravel.along(way=way, start=START, steps=STEPS[way])


@functools.cache
def moved(way: Way, *, half_width: bool = False) -> WheelResult:
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=half_width)
    case = WheelLoadCase(
        orientation_deg=ORIENTATION,
        deflections=APPROACH,
        friction=FRICTION,
        travel=travel_of(way),
    )
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)


def column(result: WheelResult, name: str) -> np.ndarray:
    """From where the hub stands on, row by row."""
    standing = result.curve.load if name == "load_N" else result.curve.columns[name]
    return np.array([standing[-1], *(row[name] for row in result.travelled)])


@pytest.mark.long
def test_half_a_wheel_moves_forwards_as_the_whole_does() -> None:
    half, whole = moved(Way.FORE_AFT, half_width=True), moved(Way.FORE_AFT)
    for name in ("load_N", "force_forward_N", "moment_left_Nm"):
        np.testing.assert_allclose(column(half, name), column(whole, name), rtol=1e-5, atol=1e-6, err_msg=name)
    assert np.abs(column(whole, "force_left_N")).max() < 1e-6 * column(whole, "load_N").max()


@pytest.mark.long
def test_sideways_it_slides_at_the_limit_of_friction() -> None:
    """And the friction is along the slip, so that what it has in front of it is given up."""
    result = moved(Way.LATERAL)
    pull = np.hypot(column(result, "force_left_N"), column(result, "force_forward_N"))
    assert column(result, "force_left_N")[1] < 0.0
    assert (pull <= FRICTION * column(result, "load_N") * (1.0 + 1e-6)).all()
    assert pull[-1] == pytest.approx(FRICTION * column(result, "load_N")[-1], rel=2e-3)
    assert np.ptp(pull[-2:]) < 0.05 * pull[-1]


@pytest.mark.parametrize(("way", "name"), [(Way.LATERAL, "force_left_N"), (Way.WIND_UP, "moment_left_Nm")])
def test_the_hubs_work_is_stored_or_lost(way: Way, name: str) -> None:
    result = moved(way, half_width=way is Way.WIND_UP)
    travel = np.array([0.0, *(travel_of(way).at(row["control"]) for row in result.travelled)])
    force = -column(result, name)
    work = float((0.5 * (force[1:] + force[:-1]) * np.diff(travel)).sum())
    parts = [np.diff(column(result, f"{name}_J")[[0, -1]])[0] for name in ("stored_energy", "slip_energy")]
    lost = float(np.diff(column(result, "friction_dissipation_J")[[0, -1]])[0])
    assert lost > 0.3 * work
    assert sum(parts) + lost == pytest.approx(work, rel=0.03)


@pytest.mark.parametrize(
    ("way", "name"),
    [
        pytest.param(Way.FORE_AFT, "force_forward_N", marks=pytest.mark.long),
        (Way.LATERAL, "force_left_N"),
        pytest.param(Way.TURNING, "moment_up_Nm", marks=pytest.mark.long),
        (Way.WIND_UP, "moment_left_Nm"),
    ],
)
def test_plates_resist_as_the_solid_does(way: Way, name: str) -> None:
    half = way is Way.WIND_UP
    result = moved(way, half_width=half)
    travel = HubTravel.along(way=way, start=START, steps=STEPS[way][:2])
    wheel = build_ancf_wheel(exomars_hoops(), element_size=10e-3, axial_size=20e-3, half_width=half)
    problem = WheelOnGround(wheel, math.radians(ORIENTATION), friction=FRICTION, travel=travel)
    states = list(press(problem, [*APPROACH, *travel.controls]))[-3:]
    wrenches = np.array([np.concatenate(problem.wrench(state)) for state in states])
    names = ["force_forward_N", "force_left_N", "load_N", "moment_forward_Nm", "moment_left_Nm", "moment_up_Nm"]
    plates = wrenches[:, names.index(name)]
    np.testing.assert_allclose([s.load for s in states], wrenches[:, 2], rtol=1e-9)
    np.testing.assert_allclose(wrenches[:, 2], column(result, "load_N")[:3], rtol=0.015)
    solid = column(result, name)[:3]
    np.testing.assert_allclose(plates[1:] - plates[0], solid[1:] - solid[0], rtol=0.05)


def test_a_wheel_without_friction_or_of_half_width_is_not_moved_sideways() -> None:
    travel = HubTravel.along(way=Way.LATERAL, start=START, steps=(1e-3,))
    with pytest.raises(InputError, match="nothing resists"):
        WheelLoadCase(orientation_deg=0.0, deflections=APPROACH, travel=travel)
    with pytest.raises(InputError, match="must be the last deflection"):
        WheelLoadCase(orientation_deg=0.0, deflections=(1e-3,), friction=0.3, travel=travel)
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=True)
    case = WheelLoadCase(orientation_deg=0.0, deflections=APPROACH, friction=0.3, travel=travel)
    with pytest.raises(InputError, match="mesh the full width"):
        solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
    wheel = build_ancf_wheel(exomars_hoops(), element_size=40e-3, axial_size=60e-3)
    with pytest.raises(InputError, match="build the full width"):
        WheelOnGround(wheel, 0.0, friction=0.3, travel=travel)
    with pytest.raises(InputError, match="nothing resists"):
        WheelOnGround(wheel, 0.0, travel=travel)
