"""Force and moment of the ground on the wheel about the hub.

Verified by tests/verification/test_fe_working_load.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.wheel.problem import WheelProblem

__all__ = ["wrench"]

Array = NDArray[np.float64]


def wrench(wheel: WheelProblem, control: float, force: Array, moment: Array) -> dict[str, float]:
    """Columns of the ground's force (dim,) [N] and moment about the hub's centre (3,), in the plane (1,) [N m].

    In the ground's axes at a control parameter, see `ObstaclePath.axes`. Of the whole wheel: what the other half of a
    mirrored mesh does is added.
    """
    normal, tangent = wheel.contact.path().axes(control)
    if len(force) == 2:  # x and z; the plane's one moment is x f_z - z f_x, minus that about the axle
        parts = {"force_forward_N": force @ tangent, "moment_left_Nm": -moment[0]}
        return {name: float(wheel.sides * value) for name, value in parts.items()}
    left, mirrored = np.cross(normal, tangent), wheel.sides == 2.0
    parts = {
        "force_forward_N": force @ tangent,
        "force_left_N": 0.0 if mirrored else force @ left,
        "moment_forward_Nm": 0.0 if mirrored else moment @ tangent,
        "moment_left_Nm": moment @ left,
        "moment_up_Nm": 0.0 if mirrored else moment @ normal,
    }
    return {name: float(wheel.sides * value) for name, value in parts.items()}
