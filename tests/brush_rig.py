"""One brush wheel under test: motions of its hub, and a rig that lets chosen coordinates of it move freely."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from contracts.terrain import Plane, Terrain
from rover_dynamics.tires.brush_force import BrushResult, HubMotions
from rover_dynamics.tires.brush_settings import BrushSettings
from rover_dynamics.tires.brush_tire import THESIS_BRUSH, BrushTireParameters
from rover_dynamics.tires.brush_wheel import BrushWheels

FloatArray = NDArray[np.float64]
RADIUS = 0.1425
STIFFNESS = THESIS_BRUSH.radial_stiffness
PLANE, DEFAULT = Plane(), BrushSettings()


def turned(camber: float = 0.0, steer: float = 0.0) -> FloatArray:
    """Rotation of a hub that leans to the right by ``camber`` (about x), then steers to the left (about z) [rad]."""
    c, s = np.cos(camber), np.sin(camber)
    lean = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    c, s = np.cos(steer), np.sin(steer)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ lean


def motion(
    position: tuple[float, ...] | FloatArray,
    rotation: FloatArray | None = None,
    velocity: tuple[float, ...] | FloatArray = (0.0, 0.0, 0.0),
    angular_velocity: tuple[float, ...] | FloatArray = (0.0, 0.0, 0.0),
) -> HubMotions:
    """Motion of one hub."""
    R = np.eye(3) if rotation is None else rotation
    return HubMotions(
        np.array([position], dtype=np.float64),
        np.ascontiguousarray(R, dtype=np.float64)[None],
        np.array([velocity], dtype=np.float64),
        np.array([angular_velocity], dtype=np.float64),
    )


@dataclass(kw_only=True)
class Rig:
    """A point mass on a wheel that keeps its orientation and spins as told or by its own inertia.

    The unknowns are position (3), velocity (3), spin (1) and the state of the tire.
    """

    mass: float = 320.0 / 6.0
    inertia: float = 0.08571
    gravity: tuple[float, float, float] = (0.0, 0.0, -3.711)
    terrain: Terrain = PLANE
    parameters: BrushTireParameters = THESIS_BRUSH
    settings: BrushSettings = DEFAULT
    rotation: FloatArray | None = None
    torque: Callable[[float, float], float] | None = None
    """Drive torque of time and spin [N m]; None: the spin stays as it is."""
    push: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        self.wheels = BrushWheels(self.terrain, 1, self.parameters, self.settings)
        self.axle = (np.eye(3) if self.rotation is None else self.rotation)[:, 1]

    def start(self, position: tuple[float, float, float], velocity: float = 0.0, spin: float = 0.0) -> FloatArray:
        """Unknowns of a wheel that moves along x."""
        return np.concatenate([position, [velocity, 0.0, 0.0, spin], np.zeros(self.wheels.n_state)])

    def response(self, y: FloatArray) -> BrushResult:
        """Of the tire to the unknowns."""
        hub = motion(y[:3], self.rotation, y[3:6], y[6] * self.axle)
        return self.wheels.forces(hub, np.ascontiguousarray(y[None, 7:]))

    def rate(self, t: float, y: FloatArray) -> FloatArray:
        """Of the unknowns."""
        found = self.response(y)
        acceleration = (found.wrench[0, :3] + self.push) / self.mass + self.gravity
        spin = 0.0
        if self.torque is not None:
            spin = (found.wrench[0, 3:] @ self.axle + self.torque(t, y[6])) / self.inertia
        return np.concatenate([y[3:6], acceleration, [spin], found.rate[0]])

    def run(self, y: FloatArray, times: FloatArray, rtol: float = 1e-8) -> FloatArray:
        """(n_times, n) float: unknowns at the times."""
        found = solve_ivp(
            self.rate, (times[0], times[-1]), y, "LSODA", t_eval=times, rtol=rtol, atol=1e-11, max_step=0.5
        )
        assert found.success, found.message
        return np.asarray(found.y.T)
