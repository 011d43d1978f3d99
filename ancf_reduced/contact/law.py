"""The force of one contact point: penalty with damping, never tensile, and smooth Coulomb friction (thesis 2.21, 2.22).

With the gap g(r) of the terrain, its normal m and curvature H, penetration delta = -g > 0 and its rate d = -m . v:
    N = max(k delta + c(delta) d, 0),   f = N (n - mu tau),   tau = v_t / sqrt(v_t . v_t + v_0^2),
    v_t = v - (n . v) n,   c(delta) = c w(delta) + k chi delta.
n is m, or the inward normal of the tire's surface. v_0 is the slip velocity at which friction is 71 % of mu N; at
10 v_0 it is 99.5 %. Below it friction is a damper mu N / v_0: a tire held by a share s of mu N creeps, at v_0 s /
sqrt(1 - s^2). Of the damping, c with w = 1 is the thesis; a depth h lets it grow smoothly, w = x^2 (3 - 2 x) with
x = delta / h up to 1, so that a point that arrives fast meets no sudden force. The other part is Hunt and Crossley's
(1975, from memory), N = k delta (1 + chi d): it begins at zero by itself, and a slow point that strikes at v rebounds
with 1 - 2/3 chi v of its speed.

Verified by tests/unit/test_ancf_contact_law.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import Symmetric, Vector, compiled, dot
from contracts.errors import InputError

__all__ = ["ContactLaw", "LawNumbers", "normal_force", "point_force", "point_tangents", "slip"]

FloatArray = NDArray[np.float64]


class LawNumbers(NamedTuple):
    """`ContactLaw` for compiled loops."""

    stiffness: float
    damping: float
    damping_depth: float
    dissipation: float
    friction: float
    slip_velocity: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactLaw:
    """What a contact point feels.

    Attributes
    ----------
    stiffness : k per point [N/m]
    damping : c per point [N s/m]
    damping_depth : penetration at which c is fully there [m]; 0: at once (thesis eq. 2.22)
    dissipation : chi of Hunt and Crossley's damping, k chi delta [s/m]
    friction : Coulomb's coefficient mu [-]
    slip_velocity : v_0 that smooths friction about standstill [m/s]

    Raises
    ------
    InputError
        For values out of range.
    """

    stiffness: float
    damping: float = 0.0
    damping_depth: float = 0.0
    dissipation: float = 0.0
    friction: float = 0.0
    slip_velocity: float = 1e-3

    def __post_init__(self) -> None:
        units = {"stiffness": "N/m", "damping": "N s/m", "damping_depth": "m", "dissipation": "s/m"}
        units |= {"friction": "-", "slip_velocity": "m/s"}
        for name, unit in units.items():
            value, positive = getattr(self, name), name in ("stiffness", "slip_velocity")
            if not (math.isfinite(value) and (value > 0.0 if positive else value >= 0.0)):
                rule = f"must be finite and {'> 0' if positive else '>= 0'}"
                raise InputError(f"contact {name.replace('_', ' ')}", f"{value:g} {unit}", rule, "check the unit")

    @property
    def numbers(self) -> LawNumbers:
        """The same for compiled loops."""
        names = (self.stiffness, self.damping, self.damping_depth, self.dissipation, self.friction, self.slip_velocity)
        return LawNumbers(*names)

    @property
    def is_damped(self) -> bool:
        """Whether there is damping along the normal."""
        return self.damping > 0.0 or self.dissipation > 0.0

    def undamped(self) -> ContactLaw:
        """The same without damping along the normal."""
        return replace(self, damping=0.0, damping_depth=0.0, dissipation=0.0)


@compiled
def _damping(law: LawNumbers, depth: float) -> tuple[float, float]:
    """Damping c(delta) at a penetration, and its derivative [N s/m, N s/m^2]."""
    own = law.stiffness * law.dissipation
    if depth >= law.damping_depth:
        return law.damping + own * depth, own
    x = depth / law.damping_depth
    grown, slope = x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) / law.damping_depth
    return law.damping * grown + own * depth, law.damping * slope + own


@compiled
def normal_force(law: LawNumbers, depth: float, rate: float) -> float:
    """N [N] at penetration ``depth`` > 0 [m] that grows at ``rate`` [m/s]."""
    return max(law.stiffness * depth + _damping(law, depth)[0] * rate, 0.0)


@compiled
def slip(law: LawNumbers, n: Vector, v: Vector) -> tuple[Vector, Vector, float]:
    """Slip velocity v_t [m/s], its smoothed direction tau [-] and sqrt(v_t . v_t + v_0^2) [m/s]."""
    across = dot(n, v)
    t = v[0] - across * n[0], v[1] - across * n[1], v[2] - across * n[2]
    size = math.sqrt(dot(t, t) + law.slip_velocity**2)
    return t, (t[0] / size, t[1] / size, t[2] / size), size


@compiled
def point_force(law: LawNumbers, N: float, n: Vector, v: Vector) -> Vector:
    """Force of the ground on a point [N]."""
    tau, mu = slip(law, n, v)[1], law.friction
    return N * (n[0] - mu * tau[0]), N * (n[1] - mu * tau[1]), N * (n[2] - mu * tau[2])


@compiled
def point_tangents(
    law: LawNumbers, gap: tuple[float, Vector, Symmetric], n: Vector, v: Vector, tangents: FloatArray
) -> bool:
    """Derivatives of the force by position (normal fixed), velocity and normal; False if there is no force.

    Parameters
    ----------
    gap : g < 0, m, H of the terrain at the point
    n, v : normal the force has, velocity
    tangents : (3, 3, 3) float [N/m, N s/m, N], overwritten; [0] by r at fixed n, [1] by v, [2] by n at fixed r
    """
    depth, m, H = -gap[0], gap[1], gap[2]
    rate, mu = -dot(m, v), law.friction
    N = normal_force(law, depth, rate)
    if N <= 0.0:
        return False
    c, c_prime = _damping(law, depth)
    tau, size = slip(law, n, v)[1:]
    across = dot(n, v)
    elastic = law.stiffness + c_prime * rate
    bent = (  # H v
        H[0] * v[0] + H[5] * v[1] + H[4] * v[2],
        H[5] * v[0] + H[1] * v[1] + H[3] * v[2],
        H[4] * v[0] + H[3] * v[1] + H[2] * v[2],
    )
    for i in range(3):
        f = n[i] - mu * tau[i]
        for j in range(3):
            same = 1.0 if i == j else 0.0
            spread = same - tau[i] * tau[j]
            tangents[0, i, j] = -f * (elastic * m[j] + c * bent[j])
            tangents[1, i, j] = -f * c * m[j] - N * mu / size * (spread - n[i] * n[j])
            tangents[2, i, j] = N * (same + mu / size * (across * spread + n[i] * v[j] - tau[i] * dot(tau, n) * v[j]))
    return True
