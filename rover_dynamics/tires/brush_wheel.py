"""The brush tire on its terrain, one wheel through the `Tire` protocol or all wheels of a vehicle at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import Terrain
from contracts.tire import HubMotion, HubWrench, TireOutput, TireResponse
from rover_dynamics.tires.brush_derivatives import MOTION, brush_derivatives, derivative_result
from rover_dynamics.tires.brush_force import BESIDE, BrushResult, HubMotions, brush_forces, brush_result, brush_scratch
from rover_dynamics.tires.brush_settings import BrushSettings, wheel_numbers
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters

__all__ = ["BrushTire", "BrushWheels"]

FloatArray = NDArray[np.float64]


class BrushWheels:
    """The n equal wheels of a vehicle on one terrain.

    Parameters
    ----------
    terrain : the ground
    wheels : n >= 1
    parameters, settings : of the wheels

    Attributes
    ----------
    n_state : numbers of state of each wheel, two for each piece of terrain
    numbers, pieces : what the compiled calls `brush_forces` and `brush_derivatives` read

    Raises
    ------
    InputError
        For no wheel; by `forces` and `derivatives` for arrays of another shape and numbers that are not finite; by
        `forces` if a hub lies beside the terrain's height field. The compiled calls themselves check nothing.

    Verified by tests/unit/test_brush_force.py.
    """

    def __init__(
        self,
        terrain: Terrain,
        wheels: int,
        parameters: BrushTireParameters = THESIS_BRUSH,
        settings: BrushSettings | None = None,
    ) -> None:
        if wheels < 1:
            raise InputError("wheels", wheels, "must be 1 or more", "give the number of the vehicle's wheels")
        self.pieces = terrain.pieces()
        self.numbers = wheel_numbers(parameters, settings or BrushSettings())
        self.n_state = 2 * len(self.pieces.rows)
        self._wheels = wheels
        self._scratch, self._pair = brush_scratch(self.pieces), derivative_result(self.pieces)

    def initial_state(self) -> FloatArray:
        """(n, n_state) float [m]: bristles undeflected."""
        return np.zeros((self._wheels, self.n_state))

    def forces(self, motions: HubMotions, state: FloatArray) -> BrushResult:
        """Wrenches, rates and outputs of all wheels; state (n, n_state) float [m]."""
        self._check(motions, state)
        result = brush_result(self._wheels, self.pieces)
        brush_forces(motions, state, self.numbers, self.pieces, result, self._scratch)
        beside = np.flatnonzero(result.output[:, 9] == BESIDE)
        if beside.size:
            place = motions.position[beside[0], :2]
            rule = "must lie over the terrain's height field"
            raise InputError(
                f"hub of wheel {beside[0]}", f"x, y = {place[0]:g}, {place[1]:g} m", rule, "give a larger field"
            )
        return result

    def derivatives(self, motions: HubMotions, state: FloatArray) -> FloatArray:
        """(n, 6 + s, 12 + s) float, see `brush_derivatives`."""
        self._check(motions, state)
        jacobian = np.zeros((self._wheels, 6 + self.n_state, MOTION + self.n_state))
        scratch = self._scratch, self._pair
        brush_derivatives(motions, state.copy(), self.numbers, self.pieces, jacobian, scratch)
        return jacobian

    def _check(self, motions: HubMotions, state: FloatArray) -> None:
        """Refuse what the compiled loops would read beyond or carry on: other shapes, NaN."""
        n = self._wheels
        wanted = ((n, 3), (n, 3, 3), (n, 3), (n, 3), (n, self.n_state))
        found = tuple(np.shape(array) for array in (*motions, state))
        if found != wanted:
            rule = f"must be {wanted}"
            raise InputError("shapes of motions and state", found, rule, "give every wheel on this terrain its row")
        if not all(np.all(np.isfinite(array)) for array in (*motions, state)):
            value = f"positions {motions.position.tolist()} m, states {state.tolist()} m"
            raise InputError("motions and state", value, "must be finite", "shorten the time step")


class BrushTire:
    """One brush tire as `contracts.tire.Tire`; parameters as for `BrushWheels`.

    Verified by tests/unit/test_brush_force.py.
    """

    def __init__(
        self,
        terrain: Terrain,
        parameters: BrushTireParameters = THESIS_BRUSH,
        settings: BrushSettings | None = None,
    ) -> None:
        self._wheels = BrushWheels(terrain, 1, parameters, settings)

    def initial_state(self) -> FloatArray:
        """(n_state,) float [m]: bristles undeflected."""
        return np.zeros(self._wheels.n_state)

    def respond(self, motion: HubMotion, state: FloatArray, time: float) -> TireResponse:
        """See `contracts.tire.Tire`; the time does not matter."""
        motions = HubMotions(
            np.array(motion.position, dtype=np.float64)[None],
            np.array(motion.rotation, dtype=np.float64)[None],
            np.array(motion.velocity, dtype=np.float64)[None],
            np.array(motion.angular_velocity, dtype=np.float64)[None],
        )
        result = self._wheels.forces(motions, np.array(state, dtype=np.float64)[None])
        wrench, found = result.wrench[0], result.output[0]
        output = TireOutput(
            penetration=float(found[0]),
            normal_load=float(found[1]),
            slip=(float(found[2]), float(found[3])),
            patch_point=found[4:7],
            tractive_force=float(found[7]),
            lateral_force=float(found[8]),
        )
        return TireResponse(
            wrench=HubWrench(force=wrench[:3], moment=wrench[3:]), state_rate=result.rate[0], output=output
        )
