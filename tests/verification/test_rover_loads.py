"""Claim: the rover at rest on level ground loads its wheels as its centre of mass says, on rigid and on elastic tires.

Source: `loads_vs_offset` of the rover's geometry, statics of the bogies on rigid wheels: the two wheels of a lateral
bogie carry the same, and moments about its pivots give the rear ones. The table is printed to 0.1 N, tolerance 0.06 N,
on tires a thousand times as stiff as Table II's. On Table II's tires the heavier end sinks deeper, up to 0.73 degrees,
and the centre of mass, above the pivots, moves towards it: up to 1.9 N. Statics in the turned position, solved here by
hand (`pitched`), says the same as the motion come to rest to 0.01 N, and 197.92 N on each wheel to 0.02 N for the
centre of mass that ships (chosen to 0.1 mm). Negative control: Table II's tires against the table of rigid wheels, and
statics without the pitch.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from rover_dynamics.rover.rover import build_rover
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from rover_dynamics.vehicle.vehicle import Vehicle, drive_vehicle

FloatArray = NDArray[np.float64]
ORIGIN = -0.0825
"""x of the principal body's frame, from which the table counts [m]."""
TABLE = [
    (-0.10, 162.3, 269.3),
    (0.0, 184.2, 225.3),
    (0.0623, 197.92, 197.92),
    (0.10, 206.2, 181.3),
    (0.14, 215.0, 163.7),
]
"""Centre of mass ahead of the frame [m], load of a front or centre wheel, of a rear one [N]."""


def design(offset: float) -> RoverDesign:
    """The rover with the principal body's centre of mass elsewhere."""
    shipped = read_rover()
    principal = replace(shipped.bodies[0], position=(ORIGIN + offset, 0.0, 0.43))
    return replace(shipped, bodies=(principal, *shipped.bodies[1:]))


def at_rest(vehicle: Vehicle) -> FloatArray:
    """Wheel loads after 20 s, (6,) [N]."""
    motion = drive_vehicle(vehicle, np.array([0.0, 10.0, 20.0]))
    assert np.abs(motion.velocities[-1]).max() < 1e-9
    return np.asarray(motion.tires[-1, :, 1])


def on_stiff_tires(offset: float) -> FloatArray:
    """Loads on tires a thousand times as stiff."""
    damping, stiffness = 1e3 * THESIS_BRUSH.radial_damping, 1e3 * THESIS_BRUSH.radial_stiffness
    tire = replace(THESIS_BRUSH, radial_stiffness=stiffness, radial_damping=damping)
    return at_rest(build_rover(design(offset), tire=tire, height=-24e-6))


def pitched(offset: float, *, stiffness: float) -> tuple[float, float]:
    """Front and rear load by statics in the pitched position [N].

    The lateral bogies stay level, as their two wheels carry the same; everything else turns about their pivots.
    """
    rover = design(offset)
    k, g, pivot = stiffness, rover.gravity, np.array([0.32, 0.216])
    bodies = [body for body in rover.bodies if body.name in ("principal", "pivot_rear")]
    places = [(body.mass, body.position[0], body.position[2]) for body in bodies]
    places += [(2.0 * body.mass, -0.72, body.position[2]) for body in rover.leg_bodies]

    def turned(x: float, z: float, pitch: float) -> FloatArray:
        c, s = np.cos(pitch), np.sin(pitch)
        return np.array([[c, s], [-s, c]]) @ (np.array([x, z]) - pivot)

    def loads(pitch: float) -> tuple[float, float]:
        moment = sum(m * g * turned(x, z, pitch)[0] for m, x, z in places)
        rear = moment / (2.0 * turned(-0.72, 0.0, pitch)[0])
        return (rover.mass * g - 2.0 * rear) / 4.0, rear

    def gap(pitch: float) -> float:
        front, rear = loads(pitch)
        return float(turned(-0.72, 0.0, pitch)[1] + pivot[1] - front / k + rear / k)

    return loads(float(brentq(gap, -0.1, 0.1, xtol=1e-14)))


@pytest.mark.parametrize(("offset", "front", "rear"), TABLE)
def test_rigid_wheels_carry_what_the_table_says(offset: float, front: float, rear: float) -> None:
    np.testing.assert_allclose(on_stiff_tires(offset), [front] * 4 + [rear] * 2, rtol=0, atol=0.06)


@pytest.mark.parametrize("offset", [row[0] for row in TABLE])
def test_elastic_tires_carry_what_statics_says_in_the_pitched_position(offset: float) -> None:
    found = at_rest(build_rover(design(offset), height=-0.024))
    front, rear = pitched(offset, stiffness=THESIS_BRUSH.radial_stiffness)
    np.testing.assert_allclose(found, [front] * 4 + [rear] * 2, rtol=0, atol=0.01)


def test_the_rover_that_ships_loads_all_wheels_alike() -> None:
    found = at_rest(build_rover(read_rover(), height=-0.024))
    np.testing.assert_allclose(found, 197.92, rtol=0, atol=0.02)
    assert found.sum() == pytest.approx(320.0 * 3.711, abs=1e-3)


def test_negative_control() -> None:
    """Neither the table nor statics without the pitch is met by elastic tires, and the tolerances see it."""
    offset, front, rear = TABLE[0]
    found = at_rest(build_rover(design(offset), height=-0.024))
    assert np.abs(found - ([front] * 4 + [rear] * 2)).max() > 1.0
    level = pitched(offset, stiffness=1e12)
    assert np.abs(found - ([level[0]] * 4 + [level[1]] * 2)).max() > 1.0
