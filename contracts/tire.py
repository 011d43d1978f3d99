"""What a vehicle knows of a tire: motion of the hub and the tire's own state in, wrench on the hub out.

The hub frame is fixed in the wheel, its y axis is the axle (to the left when the wheel rolls along x with z up); a
positive spin about +y rolls the wheel forward. Everything is given in the world frame, SI. Rigid, brush and ANCF tires
implement `Tire`, and so can an adapter to another solver: see `rover_dynamics.tires.brush_wheel.BrushTire` for an
example.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["HubMotion", "HubWrench", "Tire", "TireOutput", "TireResponse"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class HubMotion:
    """Where a wheel's hub frame is and how it moves.

    Attributes
    ----------
    position : (3,) float [m], hub centre
    rotation : (3, 3) float [-], R_wh takes hub to world; its second column is the axle
    velocity : (3,) float [m/s], of the hub centre
    angular_velocity : (3,) float [rad/s], of the wheel, spin included

    Raises
    ------
    InputError
        For another shape, a number that is not finite, or a rotation that is not orthonormal and right-handed to 1e-6.

    Verified by tests/unit/test_tire_contract.py.
    """

    position: FloatArray
    rotation: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray

    def __post_init__(self) -> None:
        for name, shape in (("position", (3,)), ("rotation", (3, 3)), ("velocity", (3,)), ("angular_velocity", (3,))):
            value = np.asarray(getattr(self, name))
            if value.shape != shape or not np.all(np.isfinite(value)):
                what, rule = f"hub {name.replace('_', ' ')}", f"must be finite and of shape {shape}"
                raise InputError(what, f"shape {value.shape}, {value.tolist()}", rule, "give world components in SI")
        R = np.asarray(self.rotation)
        if np.abs(R.T @ R - np.eye(3)).max() > 1e-6 or np.linalg.det(R) < 0.0:
            rule = "must be orthonormal and right-handed"
            raise InputError("hub rotation", R.tolist(), rule, "build it from a unit quaternion")


@dataclass(frozen=True, slots=True, kw_only=True)
class HubWrench:
    """What the tire does to the hub.

    Attributes
    ----------
    force : (3,) float [N], on the hub, world
    moment : (3,) float [N m], on the hub about its centre, world
    """

    force: FloatArray
    moment: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class TireOutput:
    """What a tire tells about its contact; of several contacts, slip is that of the most loaded one.

    Attributes
    ----------
    penetration : largest radial deflection >= 0 [m]
    normal_load : sum of the normal forces >= 0 [N]
    slip : longitudinal (> 0: drive) and lateral (> 0: ground moves to the left under the wheel) [-]
    patch_point : (3,) float [m], load-weighted centre of the contacts, world; the hub centre in the air
    tractive_force : sum of the forces along the wheel's forward direction in each contact [N]
    lateral_force : sum of the forces to the left in each contact [N]
    """

    penetration: float
    normal_load: float
    slip: tuple[float, float]
    patch_point: FloatArray
    tractive_force: float
    lateral_force: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TireResponse:
    """A tire's answer to one motion of its hub.

    Attributes
    ----------
    wrench : on the hub
    state_rate : (n_state,) float, time derivative of the tire's own state [state unit/s]
    output : what to plot
    """

    wrench: HubWrench
    state_rate: FloatArray
    output: TireOutput


class Tire(Protocol):
    """A tire on its terrain, as the vehicle sees it."""

    def initial_state(self) -> FloatArray:
        """State (n_state,) float of a tire at rest and unloaded; n_state may be 0."""

    def respond(self, motion: HubMotion, state: FloatArray, time: float) -> TireResponse:
        """Wrench, rate of the state and outputs.

        Parameters
        ----------
        motion : of the hub, world
        state : (n_state,) float, the tire's own, as `initial_state` lays it out
        time : [s]; tires without explicit time dependence ignore it
        """
