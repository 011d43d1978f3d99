"""What one wheel feels of the cells below it, compiled.

The wheel is a cylinder whose rim gives way by w(theta) towards the hub, theta from straight down forwards, in the plane
of the wheel. Below it a cell's depth z is that of the rim, and a piece of rim over the cell of area A carries
A / n_z times the stresses p n and -tau (j_1 t + j_2 e) / |j|, with the normal n of the rim into the wheel, t forwards
along the rim, the axle e, and tau = t(p) (1 - exp(-|j| / K)):

    p = min(k_u (z - z_0), k z^n / S^n)   for z <= z_u, else k z^n / S^n, but no more than z_u's line where the wheel
        slipped more when it pressed the soil; S: `soil.laws.slip_sinkage` of the slip sigma, to its power
    L d(sigma)/dt = |Omega| R (s - sigma)   L the length of the contact ahead: soil is carried away along it
    L d(rho)/dt = |Omega| R (sign(Omega) - rho)   by which a wheel that rolls has its pressure fall off behind theta_m
        as Wong and Reece (1967) have it, z there that of the rim at the angle ahead with the same pressure
    d(j_1, j_2)/dt = (v . t, v . e) along the rim's own piece,  v = v_hub + (omega - Omega e) x r - m R Omega t,
        of a rim that keeps its length
    force = sum of all,  moment = sum of r x force, about the axle  -m R sum of tau t's part, as of an inextensible rim
    w(theta) = sum_k a_k cos(k theta) + b_k sin(k theta),  T da_k/dt = g_k int p cos(k theta) - a_k,  b_k with sin

In steady rolling these are the integrals of `soil.steady_wheel`. What a step of the integration finds is kept by
`keep_step` only, so that a step can be tried again. Wheels at their edges press the share of a cell that they cover.

Verified by tests/unit/test_rover_soil_cells.py and tests/verification/test_rover_on_soil.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import inlined
from rover_dynamics.soil.column import pressure_of, remember, shear_stress, sheared_way, within
from rover_dynamics.soil.derivatives import add_derivatives, finish_derivatives
from rover_dynamics.soil.field import SoilField, SoilGround, SoilNumbers
from rover_dynamics.soil.lie import lie_below, lies_higher
from rover_dynamics.soil.rim import BULGE, LEAST_COSINE, falling_off, rim_over, share_of_depth
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, dot, hypotenuse, over_length, vector
from rover_dynamics.tires.brush_force import BESIDE, BrushResult, HubMotions, hub_axes
from soil import laws

__all__ = ["keep_step", "soil_derivatives", "soil_forces"]

FloatArray = NDArray[np.float64]
SLOWEST = 0.005
"""Speed of a rim [m/s] below which the slip that is told is that over this speed: a standing wheel has none."""
SHORTEST = 0.01
"""Contact that is taken for no shorter where the slip follows along it [m]."""
LEAST_COVER = 1e-9
"""Share of a cell from which on a wheel covers it."""

_slip_sinkage = compiled(laws.slip_sinkage)


@compiled
def soil_forces(hubs: HubMotions, state: FloatArray, ground: SoilGround, result: BrushResult) -> None:
    """Wrenches, state rates and outputs of all wheels; the field is left as it was.

    Parameters
    ----------
    hubs : motions of n wheels at the end of the step under way
    state : (n, 2 m + 2) float, a_k and b_k of m harmonics [m], sigma and rho [-]
    ground : soil, wheels and field
    result : overwritten; outputs as `rover_dynamics.tires.brush_force.OUTPUT_SIZE` has them: way the rim gives below
        the hub, load out of the ground, slips, centre of pressure, force along the wheel's heading and to its left
    """
    nothing = np.zeros((0, 0))
    for i in range(hubs.position.shape[0]):
        found = result.wrench[i], result.rate[i], result.output[i]
        _wheel(_motion(hubs, i), state[i], (ground, i), found, nothing, False)


@compiled
def soil_derivatives(
    hubs: HubMotions, state: FloatArray, ground: SoilGround, jacobian: FloatArray, pair: BrushResult
) -> None:
    """Fill (n, 6 + s, 12 + s) as `rover_dynamics.tires.brush_derivatives` does, of each cell by its own laws.

    How normal, lever and area turn with the wheel is left out, a tenth of the whole or less: the residual is exact, so
    that it costs iterations only. ``pair`` is working memory.
    """
    jacobian[:] = 0.0
    for i in range(hubs.position.shape[0]):
        found = pair.wrench[0], pair.rate[0], pair.output[0]
        _wheel(_motion(hubs, i), state[i], (ground, i), found, jacobian[i], False)


@compiled
def keep_step(hubs: HubMotions, state: FloatArray, ground: SoilGround, result: BrushResult) -> None:
    """Let the field remember the end of a step whose length is in its clock; fills ``result``."""
    nothing = np.zeros((0, 0))
    for i in range(hubs.position.shape[0]):
        found = result.wrench[i], result.rate[i], result.output[i]
        _wheel(_motion(hubs, i), state[i], (ground, i), found, nothing, True)
    ground.field.clock[1] += 1.0


@compiled
def _motion(hubs: HubMotions, i: int) -> tuple[Vector, Vector, Vector, Vector]:
    """Place of a hub, axle, velocity and angular velocity."""
    e, _ = hub_axes(hubs.rotation[i])
    return vector(hubs.position[i]), e, vector(hubs.velocity[i]), vector(hubs.angular_velocity[i])


@compiled
def _wheel(
    motion: tuple[Vector, Vector, Vector, Vector],
    state: FloatArray,
    on: tuple[SoilGround, int],
    found: tuple[FloatArray, FloatArray, FloatArray],
    jacobian: FloatArray,
    keeps: bool,
) -> None:
    """Wrench, state rate and output of one wheel; with ``keeps`` its cells remember it.

    Parameters
    ----------
    motion, state : of this wheel, as `_motion` and `soil_forces` have them
    on : the ground, and the number of the wheel
    found : overwritten
    jacobian : (6 + s, 12 + s) float that is added to, or of no size
    """
    (p, e, v, omega), (ground, i) = motion, on
    n, field = ground.numbers, ground.field
    wrench, rate, output = found
    wrench[:], rate[:], output[:] = 0.0, 0.0, 0.0
    lie = lie_below(p, n.radius, field)
    up, height, slopes = lie
    heading = over_length(cross(e, up))
    left, down, leans = cross(up, heading), cross(e, heading), dot(e, up)
    spin, ahead = dot(omega, e), dot(v, heading)
    rolls = abs(n.radius * spin)
    output[2], output[3] = (n.radius * spin - ahead) / max(rolls, SLOWEST), dot(v, left) / max(rolls, SLOWEST)
    length = math.sqrt(max(n.radius * n.radius - height * height, SHORTEST * SHORTEST))
    rate[-2] = (rolls - math.copysign(ahead, ahead * spin) - rolls * state[-2]) / length
    rate[-1] = (n.radius * spin - rolls * state[-1]) / length
    modulus = n.modulus / (_slip_sinkage(state[-2]) ** (n.slip_sinkage * n.exponent))
    depths = ground.depths[i]
    falls, farthest = falling_off(height, state, n, ground.rut[i], depths)
    foot = along(p, -height, up)
    (begin, end), inside = _cells(foot, height, (leans, heading), n, field)
    output[9] = 0.0 if inside else BESIDE
    thrust, turning, widest = 0.0, along(omega, -spin, e), 0.5 * (n.width + field.cell) + abs(leans) * BULGE * n.radius
    drop, shift, level, radius = -dot(down, up), dot(down, left), dot(e, left), n.radius
    pair = np.empty((2, len(state) + 5))
    least, beyond = height - abs(leans) * widest, farthest * farthest + field.cell * field.cell
    for row in range(begin[0], end[0]):
        for column in range(begin[1], end[1]):
            dx, dy = field.x + row * field.cell - p[0], field.y + column * field.cell - p[1]
            place = dx, dy, slopes[0] * dx + slopes[1] * dy - slopes[2]
            s, side = dot(place, heading), dot(place, left)
            if abs(side) > widest:
                continue
            higher, begins = lies_higher(row, column, place, lie, p, field), field.carries_from[row, column]
            needed = (least + begins - higher) / drop  # of a piece of rim, or of its tangent within the cell, to touch
            if needed > 0.0 and s * s + needed * needed > beyond + field.cell * abs(s):
                continue
            depth, slope, rho = rim_over(s, state, n.radius, radius)
            across = (side - depth * shift) / level
            share = min((0.5 * n.width - abs(across)) / field.cell + 0.5, 1.0)
            if depth <= rho * LEAST_COSINE or share <= LEAST_COVER:
                continue
            radius = rho
            cosine, sine = depth / radius, s / radius
            x_rate, z_rate = radius * cosine - slope * sine, -radius * sine - slope * cosine
            lower = higher - height + depth * drop - across * leans
            reached, share_within = within(lower - begins, z_rate / x_rate * field.cell)
            if share_within == 0.0:
                continue
            z = begins + reached
            first = modulus * (z * share_of_depth(sine, z, state[-1], falls, depths)) ** n.exponent
            pressure, stiffness, yields = pressure_of(z, first, n, field, (row, column))
            r = along(along(along((0.0, 0.0, 0.0), s, heading), depth, down), across, e)
            t = _tangent(heading, down, x_rate, z_rate)
            normal = cross(t, e)
            facing = dot(normal, up)
            area = share * field.cell * field.cell / (facing * up[2])
            slides = along(along(v, 1.0, cross(turning, r)), -n.shear_radius * spin, t)
            sliding = dot(slides, t), dot(slides, e)
            over = along(slides, -dot(slides, up), up)
            j, k, kept = sheared_way(over, (sliding[0], sliding[1], share_within), field, (row, column))
            a, b = j + n.lag * sliding[0], k + n.lag * sliding[1]
            shear, by = shear_stress(math.sqrt(a * a + b * b), pressure, n)
            force = along(along(along((0.0, 0.0, 0.0), pressure, normal), -shear * a, t), -shear * b, e)
            moment = cross(r, force)
            for q in range(3):
                wrench[q] += area * force[q]
                wrench[3 + q] += area * moment[q]
                output[4 + q] += area * pressure * r[q]
            output[1] += area * pressure
            thrust += area * shear * a
            conjugate = area * radius / hypotenuse(x_rate, z_rate)
            _add_harmonics(rate, cosine, sine, conjugate * pressure)
            if jacobian.shape[0]:
                add_derivatives(
                    (r, t, normal, e, (cosine, sine, area, conjugate, facing)),
                    (shear, by, share_within * stiffness, pressure if yields else 0.0),
                    (a, b, field.clock[0] * share_within * kept + n.lag),
                    n,
                    state[-2],
                    (jacobian, pair),
                )
            if keeps:
                remember((row, column), (z, pressure, yields), (j, k), n, field)
    if keeps:
        ground.rut[i] = _rut_ahead((foot, heading, left), math.copysign(falls[0], state[-1]), n, field)
    _finish((p, e, heading, left), up, n.shear_radius * thrust, wrench, output)
    _follow(rate, state, ground)
    if jacobian.shape[0]:
        finish_derivatives((heading, e), (rolls, spin, length), ground, jacobian)
    for q in range(state.shape[0] // 2 - 1):  # the harmonics
        output[0] += state[q]


@inlined
def _tangent(heading: Vector, down: Vector, along_x: float, along_z: float) -> Vector:
    """Unit vector forwards along the rim."""
    return over_length(along((along_x * heading[0], along_x * heading[1], along_x * heading[2]), along_z, down))


@compiled
def _cells(
    foot: Vector, height: float, axes: tuple[float, Vector], n: SoilNumbers, field: SoilField
) -> tuple[tuple[tuple[int, int], tuple[int, int]], bool]:
    """First row and column below a wheel, and those behind the last; whether the field has all of them."""
    leans, heading = axes
    largest = BULGE * n.radius
    ahead = math.sqrt(max(largest * largest - max(height, 0.0) ** 2, 0.0))
    if ahead == 0.0:
        return ((0, 0), (0, 0)), True
    aside = 0.5 * n.width + abs(leans) * largest + field.cell
    x = ahead * abs(heading[0]) + aside * abs(heading[1])
    y = ahead * abs(heading[1]) + aside * abs(heading[0])
    rows, columns = field.deepest.shape
    i, k = math.ceil((foot[0] - x - field.x) / field.cell), math.ceil((foot[1] - y - field.y) / field.cell)
    m, q = int((foot[0] + x - field.x) / field.cell) + 1, int((foot[1] + y - field.y) / field.cell) + 1
    inside = i >= 0 and k >= 0 and m <= rows and q <= columns
    return ((max(i, 0), max(k, 0)), (min(m, rows), min(q, columns))), inside


@compiled
def _rut_ahead(axes: tuple[Vector, Vector, Vector], entry: float, n: SoilNumbers, field: SoilField) -> float:
    """Depth at which the ground begins to carry, mean over the width just ahead of the first contact [m]."""
    foot, heading, left = axes
    total, count = 0.0, 0
    way = math.copysign(1.0, entry)
    for step in range(4):
        for across in range(-2, 3):
            s, side = n.radius * math.sin(entry) + way * (0.5 + step) * field.cell, 0.2 * across * n.width
            row = round((foot[0] + s * heading[0] + side * left[0] - field.x) / field.cell)
            column = round((foot[1] + s * heading[1] + side * left[1] - field.y) / field.cell)
            if 0 <= row < field.deepest.shape[0] and 0 <= column < field.deepest.shape[1]:
                total += field.carries_from[row, column]
                count += 1
    return total / max(count, 1)


@inlined
def _add_harmonics(rate: FloatArray, cosine: float, sine: float, force: float) -> None:
    """Parts of a radial force [N] in each harmonic."""
    count, c, d = rate.shape[0] // 2 - 1, 1.0, 0.0
    for k in range(count):
        rate[k] += force * c
        rate[count + k] += force * d
        c, d = c * cosine - d * sine, d * cosine + c * sine


@compiled
def _follow(rate: FloatArray, state: FloatArray, ground: SoilGround) -> None:
    """Rates of the rim's harmonics [m/s], from the forces in each."""
    count = rate.shape[0] // 2 - 1
    for k in range(2 * count):
        rate[k] = (ground.compliance[k % count] * rate[k] - state[k]) / ground.numbers.settling


@compiled
def _finish(
    axes: tuple[Vector, Vector, Vector, Vector], up: Vector, about_axle: float, wrench: FloatArray, output: FloatArray
) -> None:
    """Moment about the axle, and outputs that are sums over the cells; ``axes`` place, axle, heading and left."""
    p, e, heading, left = axes
    moment = wrench[3] * e[0] + wrench[4] * e[1] + wrench[5] * e[2]
    carried = max(output[1], 1e-300)
    for q in range(3):
        wrench[3 + q] += (about_axle - moment) * e[q]
        output[4 + q] = p[q] + output[4 + q] / carried
    force = vector(wrench)
    output[1], output[7], output[8] = dot(force, up), dot(force, heading), dot(force, left)
