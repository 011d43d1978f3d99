"""What is asked of the wheels' motors: speed as such, speed bounded by slip, or torque shared by load.

A controller is sampled: what it asks for over a step follows from what it saw at the end of the last one, as of sensors
of load, of slip and of the wheels' speeds; nothing of it is known to the equations of the step.

* **speed**: every wheel is to turn at the speed of its law.
* **slip**: no wheel may run ahead of the ground by more than the share s of the speed v asked for, v_c <= V / R + s v,
  with V the speed of its hub in the wheel's plane.
* **shared**: gains in proportion to the wheels' loads, k_i = k N_i / mean N, soft enough that all wheels give way
  together (droop), and one speed for all raised until they turn on average as fast as asked, with the time `SHARES`.
  It sets out from the torques that the brakes held, each wheel's own, which come together with the same time.

Droop is how generators that feed one grid share its load (from memory). Verified by
tests/verification/test_motor_drives.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.vehicle.motors import ASKED, BRAKE, BRAKED, GAIN, JointMotor

__all__ = ["Controller", "DriveControl", "Motoring", "Sight"]

FloatArray = NDArray[np.float64]
SHARES = 0.5
"""Time in which the shared speed is raised [s]."""
LEAST = 0.02
"""Least gain of a wheel that carries next to nothing, of the mean [-]."""


class Sight(NamedTuple):
    """What sensors see of the wheels at the end of a step.

    Attributes
    ----------
    t, dt : end and length of the step [s]
    speeds : (n,) float, of the motors' joints [rad/s]
    loads : (n,) float [N]
    hub_speeds : (n,) float >= 0, of the wheels' centres in the wheels' planes [m/s]
    """

    t: float
    dt: float
    speeds: FloatArray
    loads: FloatArray
    hub_speeds: FloatArray


class Controller(StrEnum):
    """Names, as rover files give them."""

    SPEED = "speed"
    SLIP = "slip"
    SHARED = "shared"


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveControl:
    """How the motors of a rover's wheels are told what to do.

    Attributes
    ----------
    controller : which one
    allowed_slip : of the controller ``slip``, slip speed over the speed asked for [-], in 0..1
    share_gain : mean gain of the controller ``shared`` [N m s/rad]

    Raises
    ------
    InputError
        For a slip that is not between 0 and 1, or a gain that is not > 0.
    """

    controller: Controller = Controller.SPEED
    allowed_slip: float = 0.2
    share_gain: float = 100.0

    def __post_init__(self) -> None:
        if not 0.0 < self.allowed_slip < 1.0:
            rule = "must lie between 0 and 1"
            raise InputError("allowed slip of the drives", f"{self.allowed_slip:g}", rule, "give e.g. 0.2")
        if not self.share_gain > 0.0:
            value = f"{self.share_gain:g} N m s/rad"
            raise InputError("share gain of the drives", value, "must be > 0", "give e.g. 100")


@dataclass(slots=True, eq=False)
class Motoring:
    """A controller at work on one motion's motors, one a wheel, in the order of the wheels.

    Attributes
    ----------
    motors, control : what is told, and how
    radius : of the wheels [m]
    raised : of the controller ``shared``, (n,) over the speeds of the laws [rad/s]
    """

    motors: tuple[JointMotor, ...]
    control: DriveControl
    radius: float
    raised: FloatArray = field(init=False)
    _gains: FloatArray = field(init=False)
    _ceilings: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.raised = np.zeros(len(self.motors))
        self._gains = np.array([one.motor.gain for one in self.motors])
        self._ceilings = np.full(len(self.motors), np.inf)

    def state(self) -> FloatArray:
        """What it carries from step to step, (3 n,)."""
        return np.concatenate([self.raised, self._gains, self._ceilings])

    def restore(self, state: FloatArray) -> None:
        """Go on from a `state`."""
        self.raised, self._gains, self._ceilings = np.split(state.copy(), 3)

    def asked(self, t: float) -> FloatArray:
        """Of each motor at t [s], (n, 3), as `rover_dynamics.vehicle.motors.add_motor_torques` takes it."""
        rows = np.zeros((len(self.motors), 3))
        told = zip(rows, self.motors, self._gains, self._ceilings, self.raised, strict=True)
        for row, one, gain, ceiling, raised in told:
            if one.stands(t):
                row[:] = 0.0, BRAKE, 1.0
                continue
            asked = one.law.at(t)[1] + raised
            row[ASKED], row[GAIN], row[BRAKED] = np.clip(asked, -ceiling, ceiling), gain, 0.0
        return rows

    def saw(self, sight: Sight) -> None:
        """Take over what sensors saw at the end of a step."""
        laws = np.array([one.law.at(sight.t)[1] for one in self.motors])
        if self.control.controller is Controller.SLIP:
            self._ceilings = sight.hub_speeds / self.radius + self.control.allowed_slip * np.abs(laws)
        elif self.control.controller is Controller.SHARED:
            mean = float(sight.loads.mean())
            shares = sight.loads / mean if mean > 0.0 else np.ones_like(sight.loads)
            self._gains = self.control.share_gain * np.maximum(shares, LEAST)
            if all(one.stands(sight.t) for one in self.motors):
                self.raised = -BRAKE * sight.speeds / self._gains
                return
            signs, share = np.sign(laws), min(sight.dt / SHARES, 1.0)
            common = float(np.mean(self.raised * signs))
            missing = float(np.mean((laws - sight.speeds) * signs))
            self.raised += share * (signs * (common + missing) - self.raised)
