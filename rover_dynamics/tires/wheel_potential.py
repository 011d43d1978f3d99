"""Potential of a wheel pressed on a plane, through its stiffness curves at orientations all around; compiled to read.

A wheel on springs carries differently on every orientation, and a spring beside the contact turns its hub. With the
rim's approach d to the plane (its radius less the hub's distance) and the orientation beta (the circumferential
position that faces the ground, growing as the wheel rolls forward) both follow from one potential,

    N = dU/dd,    M = -dU/dbeta about the axle,

so that no turn gains or loses energy. On a grouser the wheel touches higher, by a(beta) = max(0, R_tip cos(beta -
beta_tip) - R), and U begins at d = -a. It is a spline of beta and of

    x = d + a exp(-(d + a) / l),

which is the way since first touch where that begins, and the rim's approach where the grouser has sunk in with it: near
touch, curves are alike by the first, further on by the second. Over x, dU/dx is a cubic spline through every curve,
and U its integral in closed form. Over beta U is cubic between the curves, with the slopes -M that the curves' own
moments about the axle say where they hold them without friction; else a periodic spline through U.

Verified by tests/unit/test_wheel_potential.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from rover_dynamics.tires.brush_compiled import Vector, compiled, cross, dot

__all__ = [
    "AHEAD",
    "MOMENT",
    "NO_POTENTIAL",
    "Tips",
    "WheelPotential",
    "facing",
    "load_and_slope",
    "mean_stiffness",
    "raise_and_slope",
    "wheel_potential",
]

FloatArray = NDArray[np.float64]
_EVEN = 1e-6
"""Largest difference of orientations from equal spacing, over it [-]."""
_CELLS = 80
"""Pieces of the splines over x."""
MOMENT, AHEAD = "moment_left_Nm", "force_forward_N"
"""Columns of a curve: moment about the axle and force forwards, ground on wheel."""
_FREE = 1e-3
"""Largest force along the ground of a curve without friction, of its load [-]."""
_FADES = 2.0
"""l over the height of the grousers [-]; above 1, so that x rises with d."""


class Tips(NamedTuple):
    """Grousers: ``number`` at equal angles, the first at ``phase``, each tip an arc of ``half`` to both sides [rad].

    ``height`` is the tips' over the rim's ``radius`` [m], 0 for a smooth rim.
    """

    radius: float
    height: float
    number: float
    phase: float
    half: float


class WheelPotential(NamedTuple):
    """U piece by piece: m steps over x, n over the orientation.

    Attributes
    ----------
    energy : (m, n, 5, 4) float, of (x - x_i)^a (beta - beta_j)^b [N m over m^a rad^b]; m = 0 for none
    spacing : of the x_i, from 0 on [m]
    start, step : orientation of the first sample, and between two [rad]
    last : approach d up to which every curve goes [m]
    tips : of the wheel
    """

    energy: FloatArray
    spacing: float
    start: float
    step: float
    last: float
    tips: Tips


NO_POTENTIAL = WheelPotential(np.zeros((0, 1, 5, 4)), 1.0, 0.0, 1.0, np.inf, Tips(1.0, 0.0, 1.0, 0.0, 0.0))
"""Of a tire whose radial force is a line."""


class _Sampled(NamedTuple):
    orientation: float
    depths: FloatArray
    loads: FloatArray
    moments: FloatArray | None


def wheel_potential(curves: Sequence[StiffnessCurve], period: float, tips: Tips) -> WheelPotential:
    """From one curve an orientation, evenly all over one period [rad]; deflections count from first touch.

    Raises
    ------
    InputError
        For fewer than four orientations or points of a curve, and orientations that do not cover the period evenly.
    """
    from scipy.interpolate import CubicSpline

    chosen = _sorted(curves, period)
    angles = np.array([one.orientation for one in chosen])
    raised = np.array([raise_and_slope(tips, float(angle))[0] for angle in angles])
    ends = np.array([one.depths[-1] for one in chosen])
    last = float((ends - raised).min())
    reach = _faded(tips, raised, ends)[0].min()
    if not last > 0.0:
        rule = "must be longer than the grousers are high"
        raise InputError("curves of a wheel", f"{1e3 * ends.min():g} mm", rule, "sample deeper")
    spacing = float(reach) / _CELLS
    x: FloatArray = spacing * np.arange(_CELLS + 1, dtype=np.float64)
    loads, turns = np.empty((len(x), len(chosen))), np.empty((len(x), len(chosen)))
    for j, one in enumerate(chosen):
        depths = _since_touch(tips, float(raised[j]), x)
        rate = _faded(tips, raised[j], depths)[1]
        loads[:, j] = CubicSpline(one.depths, one.loads)(depths) / rate
        if one.moments is not None:
            moment = CubicSpline(one.depths, one.moments)(depths)
            turns[:, j] = -moment - loads[:, j] * _moved(tips, one.orientation, depths)
    step = period / len(chosen)
    known = all(one.moments is not None for one in chosen)
    energy = _pieces(loads, turns if known else None, spacing, step)
    return WheelPotential(energy=energy, spacing=spacing, start=float(angles[0]), step=step, last=last, tips=tips)


def mean_stiffness(potential: WheelPotential) -> float:
    """Load over approach at half of the last one, mean over the samples' orientations [N/m]."""
    half, angles = 0.5 * potential.last, potential.start + potential.step * np.arange(potential.energy.shape[1])
    return float(np.mean([load_and_slope(potential, half, float(angle))[1] for angle in angles])) / half


def _pieces(loads: FloatArray, turns: FloatArray | None, spacing: float, step: float) -> FloatArray:
    """Coefficients (m, n, 5, 4) of U for dU/dx, and dU/dbeta at equal x if it is known, (m + 1, n) on a grid."""
    from scipy.interpolate import CubicHermiteSpline, CubicSpline

    m, n = loads.shape[0] - 1, loads.shape[1]
    x, angles = spacing * np.arange(m + 1), step * np.arange(n + 1)
    over_x = CubicSpline(x, loads, axis=0).c[::-1]  # (4, m, n), rising powers
    powers = np.arange(1, 5)[:, None, None]
    risen = over_x / powers
    whole = (risen * spacing**powers).sum(axis=0)
    terms = np.concatenate([(np.cumsum(whole, axis=0) - whole)[None], risen])  # (5, m, n)
    closed = np.concatenate([terms, terms[..., :1]], axis=-1)
    if turns is None:
        around = CubicSpline(angles, closed, axis=-1, bc_type="periodic").c
    else:
        slopes = np.zeros_like(closed)
        slopes[:4] = CubicSpline(x, np.concatenate([turns, turns[:, :1]], axis=1), axis=0).c[::-1]
        around = CubicHermiteSpline(angles, closed, slopes, axis=-1).c
    return np.ascontiguousarray(around[::-1].transpose(3, 1, 2, 0))  # from (4, n, 5, m)


def _sorted(curves: Sequence[StiffnessCurve], period: float) -> list[_Sampled]:
    found = list[_Sampled]()
    for curve in curves:
        if curve.orientation_deg is None:
            raise InputError("orientation of a curve", "none", "must be stated", "give a curve at each orientation")
        if len(curve.deflection) < 4 or curve.deflection[0] != 0.0:
            rule = "must have four points or more, the first at touch"
            what = f"curve at {curve.orientation_deg:g} deg"
            raise InputError(what, f"{len(curve.deflection)} points", rule, "ask for more points")
        angle = math.radians(curve.orientation_deg)
        found.append(_Sampled(angle, curve.deflection, curve.load, _moments(curve)))
    found.sort(key=lambda one: one.orientation)
    angles = np.array([one.orientation for one in found])
    step = period / max(len(found), 1)
    if len(found) < 4 or np.abs(np.diff(angles) - step).max() > _EVEN * step:
        rule = f"must be four or more, spread evenly over the wheel's period of {math.degrees(period):g} deg"
        given = ", ".join(f"{math.degrees(angle):g}" for angle in angles)
        raise InputError("orientations of a wheel", f"{given} deg", rule, "sample one whole period")
    return found


def _moments(curve: StiffnessCurve) -> FloatArray | None:
    """About the axle, ground on wheel [N m]; None where not known, or friction has a part in it."""
    moments, ahead = (curve.columns.get(name) for name in (MOMENT, AHEAD))
    if moments is None or ahead is None or np.abs(ahead).max() > _FREE * np.abs(curve.load).max():
        return None
    return moments


def _moved(tips: Tips, orientation: float, depth: FloatArray) -> FloatArray:
    """dx/dbeta at equal approach [m], at ways since first touch [m]."""
    raised, slope = raise_and_slope(tips, orientation)
    if tips.height == 0.0:
        return np.zeros_like(depth)
    fades = _FADES * tips.height
    return np.asarray(slope * np.exp(-depth / fades) * (1.0 - raised / fades))


def _faded[T: (float, FloatArray)](tips: Tips, raised: T, depth: T) -> tuple[T, T]:
    """x and dx/dd at ways since first touch [m]; ``raised`` is a."""
    if tips.height == 0.0:
        return depth, 1.0 + 0.0 * depth
    share = np.exp(-depth / (_FADES * tips.height))
    return depth - raised * (1.0 - share), 1.0 - raised / (_FADES * tips.height) * share


def _since_touch(tips: Tips, raised: float, x: FloatArray) -> FloatArray:
    """Ways since first touch of given x, by Newton's method: x is convex and rises, so from above it converges."""
    depth = x + raised
    for _ in range(50):
        value, rate = _faded(tips, np.full_like(x, raised), depth)
        depth = depth - (value - x) / rate
    return depth


@compiled
def raise_and_slope(tips: Tips, orientation: float) -> tuple[float, float]:
    """a [m] and da/dbeta [m] at an orientation [rad]."""
    if tips.height <= 0.0:
        return 0.0, 0.0
    period = 2.0 * math.pi / tips.number
    off = orientation - tips.phase
    off -= period * math.floor(off / period + 0.5)
    away = max(abs(off) - tips.half, 0.0)
    tip = tips.radius + tips.height
    raised = tip * math.cos(away) - tips.radius
    if raised <= 0.0:
        return 0.0, 0.0
    return raised, -tip * math.sin(away) * (1.0 if off >= 0.0 else -1.0)


@compiled
def load_and_slope(potential: WheelPotential, approach: float, orientation: float) -> Vector:
    """Way since first touch [m], N [N] and dU/dbeta [N m] at an approach [m] of the rim and an orientation [rad].

    Beyond the last deflection the last piece goes on; who uses it has to look at the deflection.
    """
    raised, raise_slope = raise_and_slope(potential.tips, orientation)
    depth = approach + raised
    if depth <= 0.0:
        return 0.0, 0.0, 0.0
    x, x_rate, x_slope = depth, 1.0, 0.0
    if potential.tips.height > 0.0:
        fades = _FADES * potential.tips.height
        share = math.exp(-depth / fades)
        x = approach + raised * share
        x_rate = 1.0 - raised / fades * share
        x_slope = raise_slope * share * (1.0 - raised / fades)
    m, n = potential.energy.shape[0], potential.energy.shape[1]
    i = min(int(x / potential.spacing), m - 1)
    turns = (orientation - potential.start) / potential.step
    whole = math.floor(turns)
    j = int(whole) % n
    u, y = x - i * potential.spacing, (turns - whole) * potential.step
    force, slope = 0.0, 0.0
    for a in range(4, -1, -1):
        c = potential.energy[i, j, a]
        value = c[0] + y * (c[1] + y * (c[2] + y * c[3]))
        if a > 0:
            force = force * u + a * value
        slope = slope * u + c[1] + y * (2.0 * c[2] + y * 3.0 * c[3])
    return depth, force * x_rate, slope + force * x_slope


@compiled
def facing(up: Vector, ahead: Vector, axle: Vector) -> float:
    """Orientation [rad] that faces the ground: ``up`` from contact to hub, ``ahead`` and ``axle`` of the hub frame."""
    return math.atan2(-dot(up, ahead), dot(up, cross(ahead, axle)))
