"""What one cell of soil does below a piece of rim, and what it remembers, compiled.

Verified by tests/unit/test_rover_soil_cells.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.soil.field import SoilField, SoilNumbers
from rover_dynamics.tires.brush_compiled import Vector, compiled
from soil import laws

__all__ = ["pressure_of", "remember", "shear_stress", "sheared_way", "within"]

FloatArray = NDArray[np.float64]
ROUNDING = 1.0 + 1e-12

_mobilised = compiled(laws.mobilised)
_lug_thrust = compiled(laws.lug_thrust)


@compiled
def within(depth: float, across: float) -> tuple[float, float]:
    """Mean depth over a cell where its soil carries [m], and the share of it that does, by three of its places.

    ``across`` is how much deeper the rim lies at one end of the cell than at the other [m].
    """
    total, share = 0.0, 0.0
    for k in range(-1, 2):
        there = depth + k * across / 3.0
        if there > 0.0:
            total += there / 3.0
            share += 1.0 / 3.0
    return total, share


@compiled
def shear_stress(sheared: float, pressure: float, n: SoilNumbers) -> tuple[float, Vector]:
    """Shear stress over the way sheared [Pa/m], its derivatives by that [Pa/m] and, over it, by p [1/m]."""
    share, rising = _mobilised(sheared, n.shear_modulus)
    strength = _lug_thrust(pressure, n.tips, n.sides)
    over = 1.0 / max(sheared, 1e-300)
    if sheared < 1e-12:
        over, share = 1.0, rising
    slope = n.tips[1] if n.tips[0] + pressure * n.tips[1] < n.sides[0] + pressure * n.sides[1] else n.sides[1]
    return strength * share * over, (strength * rising, slope * share * over, sheared)


@compiled
def sheared_way(slides: Vector, sliding: Vector, field: SoilField, cell: tuple[int, int]) -> Vector:
    """How far the soil below a piece of rim is sheared, ahead and aside [m], and the share of a step's way in that.

    The rim takes along what it sheared, so that j is that of the rim's own piece: it comes from the cell that the rim
    slides from, upwind and implicit. ``slides`` over the ground in the world's axes, ``sliding`` ahead and aside [m/s],
    and the share of the cell that carries, which is all that is sheared while a wheel comes over it.
    """
    j, k = field.clock[0] * sliding[2] * sliding[0], field.clock[0] * sliding[2] * sliding[1]
    whole, per_cell = 1.0, field.clock[0] / field.cell
    if field.clock[1] > 0.0:
        last = int(field.clock[1]) % 2
        ahead, aside, touched = field.ahead[last], field.aside[last], field.touched[last]
        if touched[cell] == field.clock[1]:
            j += ahead[cell]
            k += aside[cell]
        for axis in range(2):
            share = abs(slides[axis]) * per_cell
            from_side = -1 if slides[axis] > 0.0 else 1
            other = (cell[0] + from_side, cell[1]) if axis == 0 else (cell[0], cell[1] + from_side)
            whole += share
            within = 0 <= other[0] < touched.shape[0] and 0 <= other[1] < touched.shape[1]
            if within and touched[other] == field.clock[1]:
                j += share * ahead[other]
                k += share * aside[other]
    return j / whole, k / whole, 1.0 / whole


@compiled
def pressure_of(
    z: float, first: float, n: SoilNumbers, field: SoilField, cell: tuple[int, int]
) -> tuple[float, float, bool]:
    """Pressure of a cell at a depth [Pa], its derivative [Pa/m], and whether the soil yields; ``first`` its pressure
    as of soil that was never pressed.
    """
    deepest, begins, stiffness = field.deepest[cell], field.carries_from[cell], field.unloading[cell]
    line = stiffness * (z - begins)
    yields = deepest == 0.0 or first <= line
    if not yields and z > deepest:  # firmer than the line: as much was carried before, or the soil was softer then
        yields = first * (deepest / z) ** n.exponent <= stiffness * (deepest - begins) * ROUNDING
    if yields:
        return first, n.exponent * first / z, True
    return line, stiffness, False


@compiled
def remember(
    cell: tuple[int, int],
    pressed: tuple[float, float, bool],
    sheared: tuple[float, float],
    n: SoilNumbers,
    field: SoilField,
) -> None:
    """Keep what a cell went through.

    It comes back from its largest pressure along a line no flatter than its own law, never above the ground.
    """
    z, pressure, yields = pressed
    now = int(field.clock[1]) + 1
    field.touched[now % 2][cell] = now
    field.ahead[now % 2][cell], field.aside[now % 2][cell] = sheared
    if yields:
        most = max(pressure, field.unloading[cell] * (field.deepest[cell] - field.carries_from[cell]))
        deepest = max(field.deepest[cell], z)
        stiffness = max(n.least + n.growth * deepest, max(n.exponent, 1.0) * most / deepest)
        field.deepest[cell], field.unloading[cell] = deepest, stiffness
        field.carries_from[cell] = deepest - most / stiffness
