"""What the wheels of a vehicle stand on, for the compiled steps: brush tires on a terrain, or wheels on soil.

Verified by tests/verification/test_vehicle_step.py and tests/verification/test_rover_on_soil.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.soil.cells import soil_derivatives, soil_forces
from rover_dynamics.soil.field import SoilGround
from rover_dynamics.tires.brush_compiled import compiled
from rover_dynamics.tires.brush_derivatives import brush_derivatives
from rover_dynamics.tires.brush_force import BrushResult, HubMotions, brush_forces
from rover_dynamics.vehicle.system import Tires

__all__ = ["tire_derivatives", "tire_forces"]

FloatArray = NDArray[np.float64]


@compiled
def tire_forces(hubs: HubMotions, state: FloatArray, tires: Tires, result: BrushResult) -> None:
    """Wrenches, state rates and outputs of all wheels."""
    _forces(hubs, state, tires, tires.soil, result)


@compiled
def tire_derivatives(hubs: HubMotions, state: FloatArray, tires: Tires, jacobian: FloatArray) -> None:
    """(n, 6 + s, 12 + s), see `rover_dynamics.tires.brush_derivatives`."""
    _derivatives(hubs, state, tires, tires.soil, jacobian)


@compiled
def _forces(hubs: HubMotions, state: FloatArray, tires: Tires, soil: SoilGround | None, result: BrushResult) -> None:
    if soil is None:  # known when it is compiled: the other branch is left out
        brush_forces(hubs, state, tires.numbers, tires.pieces, result, tires.scratch)
    else:
        soil_forces(hubs, state, soil, result)


@compiled
def _derivatives(
    hubs: HubMotions, state: FloatArray, tires: Tires, soil: SoilGround | None, jacobian: FloatArray
) -> None:
    if soil is None:
        brush_derivatives(hubs, state, tires.numbers, tires.pieces, jacobian, (tires.scratch, tires.pair))
    else:
        soil_derivatives(hubs, state, soil, jacobian, tires.pair)
