"""Laws of dry soil under a wheel, as scalar functions of plain numbers; numba compiles them as they are.

Depth z [m] counts from the undisturbed surface, downwards; pressure p [Pa] > 0 presses the soil; j [m] is how far the
soil was sheared. Sources, all from memory but where the table of soils says otherwise: Bekker (1969) for pressure and
sinkage, Wong (2010) for unloading, Janosi and Hanamoto (1961) for shear, Lyasko (2010) for slip sinkage, Rankine's
passive state for lugs. Theory: docs/theory/soil.md. Verified by tests/unit/test_soil_laws.py.
"""

from __future__ import annotations

import math

__all__ = [
    "lug_lines",
    "lug_thrust",
    "mobilised",
    "pressure_and_stiffness",
    "rebound",
    "slip_sinkage",
    "unloading_stiffness",
]


def pressure_and_stiffness(depth: float, modulus: float, exponent: float) -> tuple[float, float]:
    """Pressure p = k z^n of soil that is pressed for the first time, and dp/dz; zero above the surface.

    Bekker: k = k_c / b + k_phi with the smaller side b of what presses.

    Parameters
    ----------
    depth : z [m]
    modulus : k [N/m^(n+2)]
    exponent : n [-]
    """
    if depth <= 0.0:
        return 0.0, 0.0
    pressure = float(modulus * depth**exponent)
    return pressure, exponent * pressure / depth


def unloading_stiffness(deepest: float, least: float, growth: float) -> float:
    """k_u = k_0 + A_u z_u [N/m^3], slope of the line along which soil pressed to z_u [m] unloads and reloads (Wong).

    Parameters
    ----------
    deepest : z_u, the largest depth so far [m]
    least : k_0 [N/m^3]
    growth : A_u [N/m^4]
    """
    return least + growth * deepest


def rebound(deepest: float, modulus: float, exponent: float, least: float, growth: float) -> float:
    """How far soil pressed to a depth [m] comes back when it is let go [m]: p / k_u, never above its surface.

    modulus, exponent, least, growth : as `pressure_and_stiffness` and `unloading_stiffness` have them
    """
    if deepest <= 0.0:
        return 0.0
    pressure = float(modulus * deepest**exponent)
    return min(deepest, pressure / max(unloading_stiffness(deepest, least, growth), 1e-300))


def mobilised(sheared: float, modulus: float) -> tuple[float, float]:
    """Share 1 - exp(-|j| / K) of the shear strength, with the sign of j, and its derivative [1/m].

    Parameters
    ----------
    sheared : j [m]
    modulus : K, shear deformation modulus [m]
    """
    share = -math.expm1(-abs(sheared) / modulus)
    return math.copysign(share, sheared), (1.0 - share) / modulus


def slip_sinkage(slip: float) -> float:
    """How many times deeper a slipping wheel sinks than one that rolls: (1 + s) / (1 - s / 2) (Lyasko 2010); 1 below 0.

    Formula as in the programs of A. Lines' thesis (2021), which names Lyasko. The soil's pressure at a depth is then
    that of the depth over this factor, as part of it has been carried away.
    """
    s = min(max(slip, 0.0), 1.0)
    return (1.0 + s) / (1.0 - 0.5 * s)


def lug_lines(
    soil: tuple[float, float, float, float], lug: tuple[float, float, float], width: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """The two ways in which the ground under a rim with lugs fails, each a line of the pressure: offset [Pa], slope.

    Along the tips soil shears on soil, with the sides of the lugs' track (Bekker 1969, as Wong quotes him):
    c (1 + 2 h / b) + p tan(phi) (1 + 0.64 h / b arccot(h / b)). Or each lug pushes its wedge out, in Rankine's passive
    state under the pressure p, while the rim slides between the lugs: p tan(delta) + F / pitch,
    F = (gamma h^2 / 2 + p h) N_phi + 2 c h sqrt(N_phi). Without lugs the rim slides, which both lines say.

    Parameters
    ----------
    soil : cohesion c [Pa], friction angle phi [rad], weight gamma [N/m^3], angle of friction at the rim delta [rad]
    lug : height h [m], pitch [m], 1 if there are any, else 0
    width : b of the wheel [m]
    """
    cohesion, angle, weight, rim = soil
    height, pitch, there = lug
    slides = math.tan(rim)
    if there == 0.0 or height <= 0.0:
        return (0.0, slides), (0.0, slides)
    ratio = height / width
    tips = cohesion * (1.0 + 2.0 * ratio), math.tan(angle) * (1.0 + 0.64 * ratio * math.atan(1.0 / ratio))
    passive = math.tan(0.25 * math.pi + 0.5 * angle) ** 2
    pushed = 0.5 * weight * height * height * passive + 2.0 * cohesion * height * math.sqrt(passive)
    return tips, (pushed / pitch, slides + height * passive / pitch)


def lug_thrust(pressure: float, tips: tuple[float, float], sides: tuple[float, float]) -> float:
    """Largest shear stress [Pa] under a pressure p [Pa]: the weaker of the two ways to fail of `lug_lines`."""
    return min(tips[0] + pressure * tips[1], sides[0] + pressure * sides[1])
