"""What the rover's drop and its drive by a constant torque come to without the engine.

Verified by tests/verification/test_rover_statics.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw
from rover_dynamics.tires.brush_tire import BrushTireParameters

__all__ = ["drive_force", "single_wheel_drop"]

FloatArray = NDArray[np.float64]


def drive_force(design: RoverDesign, tire: BrushTireParameters, torque: float) -> float:
    """Mean tractive force of a wheel [N] while every wheel is driven by the same torque [N m] on level ground.

    Each wheel T = F l + f N (R - N / k) + I a / R, l the tire's lever R or R - N / k, the rover n F = M a, so

        F = (T - f N (R - N / k)) / (l + n I / (M R)),    N = M g / n.

    Slip makes the wheels' acceleration larger by F / C_s, a quarter of a percent of the last term, which is left out.
    """
    wheel = next(body for body in design.leg_bodies if body.name == "wheel")
    n, R, weight = len(design.legs), design.wheel_radius, design.mass * design.gravity
    load = weight / n
    deflection = load / tire.radial_stiffness
    resistance = tire.rolling_resistance * load * (R - deflection)
    return (torque - resistance) / (tire.lever_at(R, deflection) + n * wheel.inertia[1] / (design.mass * R))


def single_wheel_drop(
    design: RoverDesign, height: float, times: FloatArray, tire: BrushTireParameters, settings: BrushSettings
) -> FloatArray:
    """Load (n,) [N] at ascending times of one wheel with its share of the rover's mass, dropped from a height [m].

    m d'' = m g - max(0, k d + c d' w(d / d_0)) from first touch on, at sqrt(2 h / g) with sqrt(2 g h); w the smooth
    step 3 x^2 - 2 x^3, or 1 for the damper as printed. The rover falls like that as long as its wheels are loaded
    alike: then nothing turns.
    """
    mass, g = design.mass / len(design.legs), design.gravity
    touch, speed = math.sqrt(2.0 * height / g), math.sqrt(2.0 * g * height)

    def load(d: FloatArray, rate: FloatArray) -> FloatArray:
        x = np.clip(d / settings.damping_ramp, 0.0, 1.0)
        share = x * x * (3.0 - 2.0 * x) if settings.damper_law is DamperLaw.BUILDS_UP else 1.0
        force = tire.radial_stiffness * d + tire.radial_damping * rate * share
        return np.asarray(np.where(d >= 0.0, np.maximum(force, 0.0), 0.0))

    def rates(_: float, y: FloatArray) -> FloatArray:
        return np.array([y[1], g - float(load(y[0], y[1])) / mass])

    after = times[times >= touch]
    found = np.zeros(len(times))
    if len(after):
        span = (touch, float(after[-1]))
        path = solve_ivp(rates, span, [0.0, speed], method="LSODA", t_eval=after, rtol=1e-9, atol=1e-12)
        found[times >= touch] = load(path.y[0], path.y[1])
    return found
