"""Steady slip laws of the brush tire: isotropic brush and Fiala, compiled.

Contact frame: x forward (axle times normal), y to the left, z out of the ground. The slip (s_x, s_y) is the velocity of
the ground against the tread, over the speed of transport V > 0: the force on the wheel points along it. With the
wheel's speed (V_x, V_y), its rolling speed omega r and the usual slip angle tan alpha = V_y / |V_x|

    s_x = (omega r - V_x) / V (> 0: drive),    s_y = -V_y / V,

V = omega r in the brush (theoretical slip), V = |V_x| in Fiala's law (practical slip: s_x = kappa, s_y = -tan alpha).
The aligning moment acts about +z and is given for rolling forward; it changes sign with the direction of rolling.

Friction falls with slip in both, mu(s) = mu_max - (mu_max - mu_min) min(|s|, 1).

**Brush** with parabolic pressure, rho = C |s| / (3 mu N) (Pacejka, Tyre and Vehicle Dynamics, 3rd ed., section 3.2):

    F = mu N (3 rho - 3 rho^2 + rho^3),  M_z = -a mu N rho (1 - rho)^3 s_y / |s|     (rho < 1),    F = mu N  else.

**Fiala** (1954, as multibody codes have it: with h = 1 - C_alpha |s_y| / (3 mu N), kappa* = mu N / (2 C_s))

    F_x = C_s s_x                                   (|s_x| < kappa*),   mu N (1 - mu N / (4 C_s |s_x|)) sign s_x  else,
    F_y = mu N (1 - h^3) sign s_y,  M_z = -mu N b (1 - h) h^3 sign s_y   (h > 0),   F_y = mu N sign s_y  else.

**Carcass**: the tread does not yield and F = (C_s s_x, C_alpha s_y), shortened to mu N where it is longer; M_z = 0.

F_x and F_y of Fiala know of each other only by mu: sliding aslant, their resultant is up to sqrt(2) mu N.

Verified by tests/verification/test_brush_steady.py.
"""

from __future__ import annotations

import math

from rover_dynamics.tires.brush_compiled import compiled, hypotenuse

__all__ = ["brush_slip", "carcass_slip", "falling_friction", "fiala_slip"]

type ForceAndMoment = tuple[float, float, float]


@compiled
def falling_friction(slip: float, friction_min: float, friction_max: float) -> float:
    """Friction coefficient at a slip |s| >= 0 [-]."""
    return friction_max - (friction_max - friction_min) * min(slip, 1.0)


@compiled
def brush_slip(
    slip: tuple[float, float], load: float, stiffness: float, friction: float, half_length: float
) -> ForceAndMoment:
    """Force (F_x, F_y) [N] and aligning moment M_z [N m] of the isotropic brush.

    Parameters
    ----------
    slip : s_x, s_y [-]
    load : N >= 0 [N]
    stiffness : C, slip stiffness in every direction: 2 c a^2 for c per length of patch and unit deflection [N]
    friction : mu at this slip [-]
    half_length : a, half the length of the patch [m]
    """
    size = hypotenuse(slip[0], slip[1])
    limit = friction * load
    if size == 0.0 or limit <= 0.0:
        return 0.0, 0.0, 0.0
    rho = min(stiffness * size / (3.0 * limit), 1.0)
    x, y = slip[0] / size, slip[1] / size
    force = limit * rho * (3.0 - rho * (3.0 - rho))
    return force * x, force * y, -half_length * limit * rho * (1.0 - rho) ** 3 * y


@compiled
def fiala_slip(
    slip: tuple[float, float], load: float, stiffness: tuple[float, float], friction: float, width: float
) -> ForceAndMoment:
    """Force (F_x, F_y) [N] and aligning moment M_z [N m] of Fiala's law.

    Parameters
    ----------
    slip : s_x, s_y [-]
    load : N >= 0 [N]
    stiffness : C_s [N] and C_alpha [N/rad]
    friction : mu at this slip [-]
    width : b, the lever of the aligning moment [m]
    """
    limit = friction * load
    if limit <= 0.0:
        return 0.0, 0.0, 0.0
    x, y = abs(slip[0]), abs(slip[1])
    sliding = limit * (1.0 - limit / (4.0 * max(stiffness[0] * x, 0.5 * limit)))
    forward = stiffness[0] * x if 2.0 * stiffness[0] * x <= limit else sliding
    h = max(1.0 - stiffness[1] * y / (3.0 * limit), 0.0)
    sideways, moment = limit * (1.0 - h**3), limit * width * (1.0 - h) * h**3
    return math.copysign(forward, slip[0]), math.copysign(sideways, slip[1]), -math.copysign(moment, slip[1])


@compiled
def carcass_slip(wanted: tuple[float, float], limit: float) -> ForceAndMoment:
    """Force (F_x, F_y) [N] of a carcass that wants to pull with a force, held by friction up to a limit, both [N].

    Verified by tests/unit/test_brush_bristles.py.
    """
    size = hypotenuse(wanted[0], wanted[1])
    share = 1.0 if size <= limit else max(limit, 0.0) / size
    return share * wanted[0], share * wanted[1], 0.0
