"""The brush tire on a plane, written anew from the manual's formulas (docs/theory/brush_tire.md) for another code.

Plain Python on floats that imports nothing of this project. It was written with our tire's code read before: slips of
the pen in either are seen, an error of thought that both have is not. The ground is z = 0. Of the manual this leaves
out what level ground does not ask for: edges, profiles, several contacts, the fading beyond 72 degrees of camber,
Fiala's law and the carcass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

__all__ = ["Bristles", "PlainTire", "Touch"]

type Three = tuple[float, float, float]
type Two = tuple[float, float]
ITERATIONS = 4
"""Of the trapezoidal rule where bristles slide; where they stick its equation is linear."""


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Sequence[float], b: Sequence[float]) -> Three:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _plus(a: Sequence[float], s: float, b: Sequence[float]) -> Three:
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


def _smooth(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


@dataclass(slots=True, kw_only=True)
class Bristles:
    """Deflection u [m] and its rate [m/s] at the end of the last step, forward and to the left; they start straight."""

    u: Two = (0.0, 0.0)
    rate: Two = (0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Touch:
    """Where and how a wheel touches: load [N], deflection [m], places of load and of the tractive force from the hub
    [m], slip velocity [m/s], speed of transport [m/s], forward and left.
    """

    load: float
    deflection: float
    place: Three
    pulls_at: Three
    slips: Two
    transport: float
    forward: Three
    left: Three


@dataclass(frozen=True, slots=True, kw_only=True)
class PlainTire:
    """Numbers as in the manual, sections 4.1 to 4.5 [SI]; ``loaded`` takes the tractive force's lever as R - d."""

    R: float
    b: float
    k: float = 8250.0
    c: float = 8140.0
    d_0: float = 0.005
    C_s: float = 8250.0
    C_alpha: float = 850.0 * 180.0 / math.pi
    mu_min: float = 0.597
    mu_max: float = 0.757
    f: float = 0.015
    sigma: float = 0.03
    a: float = 0.03
    tau: float = 0.005
    v_0: float = 0.001
    touch_depth: float = 1e-4
    loaded: bool = False

    def touch(self, p: Sequence[float], e: Sequence[float], v: Sequence[float], w: Sequence[float]) -> Touch | None:
        """Of a hub at p with the axle e, velocity v and angular velocity w; None in the air."""
        q = math.sqrt(1.0 - e[2] * e[2])
        tan_camber = e[2] / q
        up = (-e[2] * e[0] / q, -e[2] * e[1] / q, q)
        away = p[2] / q
        deflection, y = self._across(self.R - away, tan_camber)
        if deflection <= 0.0:
            return None
        place = _plus(_plus((0.0, 0.0, 0.0), y, e), -(away + y * tan_camber), up)
        rim = _plus(place, -(self.R + _dot(place, up)), up)
        forward = (e[1] / q, -e[0] / q, 0.0)
        left = (-forward[1], forward[0], 0.0)
        v_place = _plus(v, 1.0, _cross(w, place))
        rate = -v_place[2] / q
        built = _smooth(deflection / self.d_0) if self.d_0 > 0.0 else 1.0
        transport = -_dot(_cross(w, rim), forward)
        return Touch(
            load=max(0.0, self.k * deflection + self.c * rate * built) / q,
            deflection=deflection,
            place=place,
            pulls_at=place if self.loaded else rim,
            slips=(transport - _dot(v, forward), -_dot(v_place, left)),
            transport=transport,
            forward=forward,
            left=left,
        )

    def _across(self, depth: float, tan_camber: float) -> Two:
        """Mean of max(0, depth - y tan) over the width, and the place y of its centre."""
        edge = 0.5 * self.b * abs(tan_camber)
        if depth <= -edge:
            return 0.0, 0.0
        if depth >= edge:
            return depth, -tan_camber * self.b**2 / (12.0 * depth) if depth > 0.0 else 0.0
        strip = (depth + edge) / abs(tan_camber)
        return 0.5 * (depth + edge) * strip / self.b, -math.copysign(0.5 * self.b - strip / 3.0, tan_camber)

    def sliding(self, touch: Touch, u: Two) -> tuple[Two, Two]:
        """Share h of the slip velocity that slides at the bristles' limit [m/s], and how far u is beyond [m]."""
        limit, size = 3.0 * self.mu_max * touch.load * self.sigma / self.C_s, math.hypot(*u)
        if size <= limit:
            return (0.0, 0.0), (0.0, 0.0)
        x, y, band = u[0] / size, u[1] / size, 0.5 * limit + 5e-5
        held = _smooth((size - limit) / band) * max(touch.slips[0] * x + touch.slips[1] * y, 0.0)
        beyond = max(size - limit - band, 0.0)
        return (held * x, held * y), (beyond * x, beyond * y)

    def moved(self, old: Bristles, touch: Touch | None, dt: float) -> Bristles:
        """The bristles a step later, by the trapezoidal rule."""
        lengths = self.sigma, self.C_alpha * self.sigma / self.C_s
        w = 0.0 if touch is None else _smooth(touch.deflection / self.touch_depth)
        back = [(1.0 - w) / self.tau + (0.0 if touch is None else w * abs(touch.transport) / one) for one in lengths]
        u, drive = old.u, [0.0, 0.0]
        for _ in range(ITERATIONS if touch is not None else 1):
            if touch is not None:
                h, beyond = self.sliding(touch, u)
                drive = [w * (touch.slips[m] - h[m] - beyond[m] / self.tau) for m in range(2)]
            x, y = ((old.u[m] + 0.5 * dt * (old.rate[m] + drive[m])) / (1.0 + 0.5 * dt * back[m]) for m in range(2))
            u = x, y
        return Bristles(u=u, rate=(drive[0] - back[0] * u[0], drive[1] - back[1] * u[1]))

    def along_ground(self, touch: Touch, u: Two) -> Three:
        """Tractive and lateral force [N] and aligning moment [N m]: the brush of section 4.2 at the slip of 4.3."""
        (h, _), V, k_t = self.sliding(touch, u), touch.transport, self.C_s / self.sigma
        lengths, regular = (self.sigma, self.C_alpha / k_t), math.hypot(V, self.v_0)
        slip, pull = [], []
        for m in range(2):
            rate = touch.slips[m] - abs(V) * u[m] / lengths[m] - h[m]
            slip.append((u[m] + self.tau * rate) / lengths[m] + h[m] / regular)
            pull.append(k_t * (u[m] + self.tau * rate + self.sigma * h[m] / regular))
        size, all_slip = math.hypot(*pull), math.hypot(*slip)
        mu = self.mu_max - (self.mu_max - self.mu_min) * min(all_slip, 1.0)
        if size == 0.0 or touch.load == 0.0:
            return 0.0, 0.0, 0.0
        rho = min(size / (3.0 * mu * touch.load), 1.0)
        force = mu * touch.load * (3.0 * rho - 3.0 * rho**2 + rho**3)
        aligning = -self.a * mu * touch.load * rho * (1.0 - rho) ** 3 * pull[1] / size * V / regular
        return force * pull[0] / size, force * pull[1] / size, aligning

    def wrench(self, touch: Touch | None, u: Two, e: Sequence[float]) -> tuple[Three, Three, Two]:
        """Force and moment on the hub [N, N m]; tractive and lateral force [N]."""
        if touch is None:
            return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0)
        F_x, F_y, M_z = self.along_ground(touch, u)
        pull = _plus((0.0, 0.0, 0.0), F_x, touch.forward)
        rest = _plus((0.0, 0.0, touch.load), F_y, touch.left)
        resistance = self.f * touch.load * math.hypot(*touch.place) * math.tanh(touch.transport / self.v_0)
        moment = _plus(_cross(touch.place, rest), 1.0, _cross(touch.pulls_at, pull))
        moment = _plus(_plus(moment, M_z, (0.0, 0.0, 1.0)), -resistance, e)
        return _plus(pull, 1.0, rest), moment, (F_x, F_y)
