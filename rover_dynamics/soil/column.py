"""What one cell of soil does below a piece of rim, and what it remembers, compiled.

Verified by tests/unit/test_rover_soil_cells.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import inlined
from rover_dynamics.soil.field import SoilField, SoilNumbers
from rover_dynamics.tires.brush_compiled import Vector, compiled
from soil import laws

__all__ = ["pressure_of", "remember", "shear_stress", "sheared_way", "within"]

FloatArray = NDArray[np.float64]
ROUNDING = 1.0 + 1e-12

_mobilised = compiled(laws.mobilised)
_lug_thrust = compiled(laws.lug_thrust)


@inlined
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


@inlined
def shear_stress(sheared: float, pressure: float, n: SoilNumbers) -> tuple[float, Vector]:
    """Shear stress over the way sheared [Pa/m], its derivatives by that [Pa/m] and, over it, by p [1/m]."""
    share, rising = _mobilised(sheared, n.shear_modulus)
    strength = _lug_thrust(pressure, n.tips, n.sides)
    over = 1.0 / max(sheared, 1e-300)
    if sheared < 1e-12:
        over, share = 1.0, rising
    slope = n.tips[1] if n.tips[0] + pressure * n.tips[1] < n.sides[0] + pressure * n.sides[1] else n.sides[1]
    return strength * share * over, (strength * rising, slope * share * over, sheared)


@inlined
def sheared_way(slides: Vector, sliding: Vector, field: SoilField, cell: tuple[int, int]) -> Vector:
    """How far the soil below a piece of rim is sheared, ahead and aside [m], and the share of a step's way in that.

    The rim takes along what it sheared, so that j is that of the rim's own piece: it comes from the cell that the rim
    slides from, upwind and implicit. ``slides`` over the ground in the world's axes, ``sliding`` ahead and aside [m/s],
    and the share of the cell that carries, which is all that is sheared while a wheel comes over it.
    """
    dt, before, (row, column) = field.clock[0], field.clock[1], cell
    j, k, whole, last = dt * sliding[2] * sliding[0], dt * sliding[2] * sliding[1], 1.0, int(before) % 2
    per_cell = dt / field.cell if before > 0.0 else 0.0
    if field.touched[last, row, column] == before:
        j += field.ahead[last, row, column]
        k += field.aside[last, row, column]
    for axis in range(2):
        share = abs(slides[axis]) * per_cell
        from_side = -1 if slides[axis] > 0.0 else 1
        m, q = (row + from_side, column) if axis == 0 else (row, column + from_side)
        whole += share
        inside = 0 <= m < field.touched.shape[1] and 0 <= q < field.touched.shape[2]
        if inside and field.touched[last, m, q] == before:
            j += share * field.ahead[last, m, q]
            k += share * field.aside[last, m, q]
    return j / whole, k / whole, 1.0 / whole


@inlined
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


@inlined
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
    field.touched[now % 2, *cell] = now
    field.ahead[now % 2, *cell], field.aside[now % 2, *cell] = sheared
    if yields:
        most = max(pressure, field.unloading[cell] * (field.deepest[cell] - field.carries_from[cell]))
        deepest = max(field.deepest[cell], z)
        stiffness = max(n.least + n.growth * deepest, max(n.exponent, 1.0) * most / deepest)
        field.deepest[cell], field.unloading[cell] = deepest, stiffness
        field.carries_from[cell] = deepest - most / stiffness
