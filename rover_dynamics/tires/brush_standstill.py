"""Slip forces that exist at standstill: Pacejka's single contact point with bristles that stop, slide and spring back.

The bristles' deflection u = (u_x, u_y) [m] is the tire's state in one contact. With the slip velocity v (ground against
tread), the speed of transport V and the relaxation lengths sigma (Pacejka 2012, section 7.2.1)

    u_dot = v - |V| u / sigma - h,    h = A(|u|) max(v . e, 0) e,    e = u / |u|.

h holds u at the sliding limit: A goes smoothly from 0 at |u| = L, where the steady law slides, to 1 at 1.5 L + 0.05 mm,
and acts on outward motion only. Below L nothing leaks, so that a wheel that stands does not creep. The force is that
of the steady law at

    s = (u + tau u_dot) / sigma + h / sqrt(V^2 + v_0^2).

Steady rolling has u_dot = 0, so that s = v / |V|: the steady law, in partial and in full sliding. The bristles'
retardation time tau damps oscillations about standstill (as the bristle damping of LuGre friction does). If |u| exceeds
1.5 L + 0.05 mm, because the load fell, u returns with the time constant tau; out of contact it fades likewise.

The brush: L = 3 mu_max N / k_t, the bristles' stiffness k_t = C_s / sigma_x = C_alpha / sigma_y being the same in
every direction. Partial slip then sees the stiffnesses C_s and C_alpha, sliding friction opposes the sliding, and at
V = 0 the force derives from a potential, so that no loop of u creates energy. Fiala's law is held in each direction for
itself: L_y = 3 mu_max N / k_t where it slides; L_x = 5 mu_max N / k_t, ten times the kappa* from which it bends, since
F_x reaches mu N only asymptotically (there 95 %; a wheel that needs more creeps by micrometres a second).

The carcass: as stiff forward as k_x = C_s / sigma_x and sideways as k_y = C_alpha / sigma_y = r k_x. Its force K u is
in proportion to u up to L = mu_max N / k_x of f = (u_x, r u_y), the force over k_x; from 1.02 L + 50 um on all slides.
e is along f, and of v as much slides along e as keeps f there: max(v . (e_x, r e_y), 0) / (e_x^2 + r e_y^2).

Verified by tests/verification/test_brush_standstill.py and tests/unit/test_brush_bristles.py.
"""

from __future__ import annotations

from rover_dynamics.tires.brush_compiled import compiled, hypotenuse, ramp
from rover_dynamics.tires.brush_settings import SlipLaw, WheelNumbers
from rover_dynamics.tires.brush_slip import brush_slip, carcass_slip, falling_friction, fiala_slip

__all__ = ["bristle_force", "held_motion"]

type Pair = tuple[float, float]
BRUSH, FIALA = int(SlipLaw.BRUSH), int(SlipLaw.FIALA)
BAND, SMALLEST = 0.5, 5e-5
"""Width of the band in which sliding sets in: share of the limit, and [m]."""
CARCASS_BAND = 0.02
"""The same share of a carcass, which yields by centimetres: force and sliding disagree within it."""


@compiled
def held_motion(u: Pair, v: Pair, limit: float, band: float, ratio: float) -> tuple[Pair, Pair]:
    """Part h of the slip velocity that slides at the limit, and how far u lies beyond its band (as a vector) [m].

    ``limit`` is of the length of (u_x, ratio u_y), ``band`` how far beyond it sliding is complete [m].
    """
    size = hypotenuse(u[0], ratio * u[1])
    if size <= limit or size == 0.0:
        return (0.0, 0.0), (0.0, 0.0)
    x, y = u[0] / size, ratio * u[1] / size
    outward = (v[0] * x + ratio * v[1] * y) / (x * x + ratio * y * y)
    held = ramp((size - limit) / band) * max(outward, 0.0)
    beyond = max(size - limit - band, 0.0) / size
    return (held * x, held * y), (beyond * u[0], beyond * u[1])


@compiled
def bristle_force(
    load: float, u: Pair, v: Pair, speed: float, numbers: WheelNumbers
) -> tuple[tuple[float, float, float], Pair, Pair]:
    """Force (F_x, F_y) [N] with aligning moment [N m], rate of u [m/s], and slip s [-] of one contact.

    Parameters
    ----------
    load : normal force N >= 0 [N]
    u : bristle deflection [m]
    v : slip velocity, ground against tread, forward and to the left [m/s]
    speed : signed speed of transport V: rolling speed (brush) or forward speed (Fiala) [m/s]
    numbers : of the wheel
    """
    law = int(numbers.law)
    unit, ratio = numbers.friction_max * load / numbers.tangential_stiffness, numbers.lateral_ratio
    if law == FIALA:
        h_x, excess_x = held_motion((u[0], 0.0), (v[0], 0.0), 5.0 * unit, 5.0 * BAND * unit + SMALLEST, 1.0)
        h_y, excess_y = held_motion((0.0, u[1]), (0.0, v[1]), 3.0 * unit, 3.0 * BAND * unit + SMALLEST, 1.0)
        h, excess = (h_x[0], h_y[1]), (excess_x[0], excess_y[1])
    elif law == BRUSH:
        h, excess = held_motion(u, v, 3.0 * unit, 3.0 * BAND * unit + SMALLEST, 1.0)
    else:
        h, excess = held_motion(u, v, unit, CARCASS_BAND * unit + SMALLEST, ratio)
    sigma_x, sigma_y, tau = numbers.relaxation_x, numbers.relaxation_y, numbers.retardation_time
    rate = v[0] - abs(speed) * u[0] / sigma_x - h[0], v[1] - abs(speed) * u[1] / sigma_y - h[1]
    regular = hypotenuse(speed, numbers.standstill_speed)
    q_x, q_y = u[0] + tau * rate[0], u[1] + tau * rate[1]
    slip = q_x / sigma_x + h[0] / regular, q_y / sigma_y + h[1] / regular
    friction = falling_friction(hypotenuse(slip[0], slip[1]), numbers.friction_min, numbers.friction_max)
    if law == FIALA:
        stiffness = numbers.tangential_stiffness * sigma_x, numbers.tangential_stiffness * sigma_y
        force = fiala_slip(slip, load, stiffness, friction, numbers.width)
    else:
        k = numbers.tangential_stiffness
        s = k * (q_x + sigma_x * h[0] / regular), k * (ratio * q_y + sigma_x * h[1] / regular)
        if law == BRUSH:
            force = brush_slip(s, load, 1.0, friction, numbers.half_length)
        else:
            force = carcass_slip(s, friction * load)
    back = rate[0] - excess[0] / tau, rate[1] - excess[1] / tau
    return (force[0], force[1], force[2] * speed / regular), back, slip
