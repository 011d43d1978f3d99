"""The brush tire of a wheel: it carries, yields and slips as it was made to; a tire of other numbers does not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import Around, StiffnessCurve
from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.terrain import Plane
from contracts.travel_curve import WRENCH, TravelCurve
from rover_dynamics.tires.brush_settings import BrushSettings, Carcass, SlipLaw, yielding
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters, with_friction
from rover_dynamics.tires.brush_wheel import BrushWheels
from rover_dynamics.tires.rigid import rigid_settings
from tests.brush_rig import RADIUS, motion
from workbench.questions.models.wheel_brush import WheelBrush, lines_beside_table_two, wheel_brush

LOAD = 200.0
STIFFNESS = {Way.FORE_AFT: (2.2e3, 3.4e3), Way.LATERAL: (12.7e3, 14.5e3), Way.TURNING: (180.0, 210.0)}
"""About that of the built-in wheel on two orientations [N/m; N m/rad]."""


def curve(orientation: float, softens: float = 0.0, **columns: np.ndarray) -> StiffnessCurve:
    """9 kN/m at first, 100 N less for each of ``softens`` at 40 mm."""
    d = np.linspace(0.0, 40e-3, 81)
    load = 9e3 * d - softens * 100.0 * (d / 40e-3) ** 2
    return StiffnessCurve(
        model="fe", orientation_deg=orientation, deflection=d, load=load, columns=columns, source="made up"
    )


def travel(way: Way, orientation: float, stiffness: float) -> TravelCurve:
    """In proportion; two more newtons stand in its first row, as friction leaves them."""
    s = np.array([0.0, 1e-3, 2e-3])
    return TravelCurve(
        model="fe",
        way=way,
        orientation_deg=orientation,
        deflection=0.02,
        travel=s,
        columns=dict.fromkeys(WRENCH, 2.0 - stiffness * s),
        source="made up",
    )


TRAVELS = [travel(way, 30.0 * k, one) for way, both in STIFFNESS.items() for k, one in enumerate(both)]


def made(curves: Sequence[StiffnessCurve] = (), given: BrushTireParameters = THESIS_BRUSH) -> WheelBrush:
    return wheel_brush(curves or (curve(0.0), curve(40.0, 0.5)), TRAVELS, LOAD, given, Around(period=120.0))


def forces(tire: BrushTireParameters, settings: BrushSettings, depth: float, moved: tuple[float, float]) -> np.ndarray:
    """Of the ground (3,) [N] on a wheel pressed in by ``depth`` whose braked hub is moved forwards and to the left [m].

    By the compiled tire alone: quasi-static, so that its bristles take the whole way.
    """
    wheels = BrushWheels(Plane(), 1, tire, settings)
    speed, steps = 1e-3, 200
    state = np.zeros((1, wheels.n_state))
    velocity = speed * np.array([*moved, 0.0]) / np.hypot(*moved)
    step = float(np.hypot(*moved)) / speed / steps
    for k in range(steps):
        at = np.array([0.0, 0.0, RADIUS - depth]) + velocity * step * (k + 0.5)
        state = state + step * wheels.forces(motion(at, velocity=velocity), state).rate
    return np.asarray(wheels.forces(motion((*moved, RADIUS - depth)), state).wrench[0, :3])


def initial_stiffness(found: WheelBrush, settings: BrushSettings) -> tuple[float, float]:
    """Forwards and to the left, of a tenth of a millimetre [N/m]."""
    way = 1e-4
    ahead, left = (forces(found.tire, settings, found.deflection, one) for one in ((way, 0.0), (0.0, way)))
    return -float(ahead[0]) / way, -float(left[1]) / way


def test_it_carries_the_load_as_deep_as_the_mean_curve() -> None:
    """By hand: the mean of equal arcs loses 25 N at 40 mm, and 200 N = 9000 d - 15 625 d^2 at 23.15 mm."""
    found = made()
    by_hand = (9e3 - np.sqrt(9e3**2 - 4.0 * 15_625.0 * LOAD)) / (2.0 * 15_625.0)
    assert found.deflection == pytest.approx(by_hand, rel=1e-4)
    assert found.tire.radial_stiffness == pytest.approx(LOAD / by_hand, rel=1e-4)
    assert found.tangent == pytest.approx(9e3 - 31_250.0 * by_hand, rel=2e-3)
    lifted = forces(found.tire, BrushSettings(), found.deflection, (1e-9, 0.0))
    assert lifted[2] == pytest.approx(LOAD, rel=1e-9)


def test_the_tires_own_force_gives_back_the_stiffness_it_was_made_of() -> None:
    """Round trip through the compiled tire: pressed as deep as the wheel, its hub moved by 0.1 mm."""
    found = made()
    assert found.carcass == pytest.approx((2.8e3, 13.6e3))
    settings = yielding(BrushSettings(), found.tire, found.carcass)
    assert initial_stiffness(found, settings) == pytest.approx(found.carcass, rel=1e-6)


def test_negative_control_bristles_of_table_two_do_not() -> None:
    """A hundred times as stiff forwards, twenty times sideways; and two ways exchanged are seen."""
    found = made()
    own = initial_stiffness(found, BrushSettings())
    assert own[0] > 90.0 * found.carcass.forward
    assert own[1] > 15.0 * found.carcass.sideways
    turned = yielding(BrushSettings(), found.tire, Carcass(found.carcass.sideways, found.carcass.forward))
    assert initial_stiffness(found, turned)[0] > 4.0 * found.carcass.forward


def test_what_a_standing_wheel_does_not_tell_stays_as_it_was_given() -> None:
    given = replace(with_friction(THESIS_BRUSH, 0.5), radial_damping=900.0, source="a bench")
    found = made(given=given)
    assert replace(found.tire, radial_stiffness=given.radial_stiffness, source=given.source) == given
    assert found.tire.source.endswith("the rest: a bench")
    numbers = found.numbers
    assert numbers.law == SlipLaw.CARCASS
    assert numbers.tangential_stiffness * numbers.relaxation_x == pytest.approx(given.longitudinal_slip_stiffness)
    sideways = numbers.lateral_ratio * numbers.tangential_stiffness
    assert sideways * numbers.relaxation_y == pytest.approx(given.cornering_stiffness)


def test_every_number_of_the_tire_has_its_line() -> None:
    """And what was not computed has none; the kept ones say so."""
    lines = {one.name: one for one in lines_beside_table_two(made())}
    assert lines["radial stiffness"].table == 8250.0
    assert lines["standing stiffness forwards"][2:4] == (pytest.approx(275e3), pytest.approx(2.8e3))
    assert lines["standing stiffness sideways"].ratio == pytest.approx(13.6 / 275.0)
    assert lines["relaxation length sideways"].table == pytest.approx(0.1771, rel=1e-3)
    turned = lines["stiffness turned on the spot"]
    assert (turned.table, turned.wheel) == (None, pytest.approx(195.0))
    assert (lines["contact length"].wheel, lines["contact length"].ratio) == (None, None)
    kept = {name for name, one in lines.items() if one.how.startswith("kept")}
    assert kept == {
        "radial damping",
        "longitudinal slip stiffness",
        "cornering stiffness",
        "friction at full slip",
        "friction at no slip",
        "rolling resistance",
    }
    assert all(lines[name].ratio == 1.0 for name in kept)


def test_the_contact_is_as_long_as_the_curves_say() -> None:
    """Half of the deflection's tenfold, say, under 200 N."""
    long = [curve(one, contact_length_m=5.0 * np.linspace(0.0, 40e-3, 81)) for one in (0.0, 40.0)]
    assert made(long).contact_length == pytest.approx(5.0 * LOAD / 9e3)
    assert made([long[0], curve(40.0)]).contact_length is None


def test_what_makes_no_tire_is_refused() -> None:
    with pytest.raises(InputError, match="lies outside the curve"):
        wheel_brush([curve(0.0)], TRAVELS, 1e3, THESIS_BRUSH)
    with pytest.raises(InputError, match="stiffness lateral of the wheel"):
        wheel_brush([curve(0.0)], TRAVELS[:2], LOAD, THESIS_BRUSH)
    with pytest.raises(InputError, match="deflection of the wheel = 0 m"):
        wheel_brush([replace(curve(0.0), load=curve(0.0).load + 300.0)], TRAVELS, 300.0, THESIS_BRUSH)
    assert wheel_brush([curve(0.0)], TRAVELS[:4], LOAD, THESIS_BRUSH).turning is None


def test_a_rigid_wheel_has_no_carcass() -> None:
    soft = yielding(BrushSettings(), THESIS_BRUSH, Carcass(2.8e3, 13.6e3))
    assert rigid_settings(soft) == rigid_settings(BrushSettings())
    fiala = replace(BrushSettings(), slip_law=SlipLaw.FIALA)
    assert rigid_settings(fiala).slip_law is SlipLaw.FIALA
