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
    d(j_1, j_2)/dt = (v . t, v . e) along the rim's own piece,  v = v_hub + (omega - Omega e) x r - m R Omega t   (a rim that keeps its length)
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

from rover_dynamics.soil.field import ANGLES, SoilField, SoilGround, SoilNumbers
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, dot, over_length, vector
from rover_dynamics.tires.brush_force import BESIDE, BrushResult, HubMotions, hub_axes
from soil import laws

__all__ = ["keep_step", "soil_derivatives", "soil_forces"]

FloatArray = NDArray[np.float64]
SLOWEST = 0.005
"""Speed of a rim [m/s] below which the slip that is told is that over this speed: a standing wheel has none."""
SHORTEST = 0.01
"""Contact that is taken for no shorter where the slip follows along it [m]."""
NEAR = 1e-7
"""Change of a rim's radius over the wheel's at which it is found."""
BULGE = 1.05
"""How far a rim may reach beyond its radius, over that."""

ROUNDING = 1.0 + 1e-12
STEP, STEPS = 0.025, ANGLES
"""Of the angles at which the rim is looked at for where it touches [rad], and their number to each side."""
FARTHEST, COSINE, SINE = STEP * STEPS, math.cos(STEP), math.sin(STEP)

_mobilised = compiled(laws.mobilised)
_slip_sinkage = compiled(laws.slip_sinkage)
_lug_thrust = compiled(laws.lug_thrust)


@compiled
def _rebound(deepest: float, modulus: float, exponent: float, least: float, growth: float) -> float:
    """`soil.laws.rebound`, which calls another law."""
    return min(deepest, modulus * deepest**exponent / max(least + growth * deepest, 1e-300))


@compiled
def soil_forces(hubs: HubMotions, state: FloatArray, ground: SoilGround, result: BrushResult) -> None:
    """Wrenches, state rates and outputs of all wheels; the field is left as it was.

    Parameters
    ----------
    hubs : motions of n wheels at the end of the step under way
    state : (n, 2 m + 2) float, a_k and b_k of m harmonics [m], sigma and rho [-]
    ground : soil, wheels and field
    result : overwritten; outputs as `rover_dynamics.tires.brush_force.OUTPUT_SIZE` has them: way the rim gives below the
        hub, load along z, slips, centre of pressure, force along the wheel's heading and to its left
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
    heading = over_length((e[1], -e[0], 0.0))
    left, down = (-heading[1], heading[0], 0.0), cross(e, heading)
    spin, ahead = dot(omega, e), dot(v, heading)
    rolls = abs(n.radius * spin)
    output[2], output[3] = (n.radius * spin - ahead) / max(rolls, SLOWEST), dot(v, left) / max(rolls, SLOWEST)
    length = math.sqrt(max(n.radius * n.radius - p[2] * p[2], SHORTEST * SHORTEST))
    rate[-2] = (rolls - math.copysign(ahead, ahead * spin) - rolls * state[-2]) / length
    rate[-1] = (n.radius * spin - rolls * state[-1]) / length
    modulus = n.modulus / (_slip_sinkage(state[-2]) ** (n.slip_sinkage * n.exponent))
    depths = ground.depths[i]
    falls = _falling_off(p[2], state, n, ground.rut[i], depths)
    (begin, end), inside = _cells(p, (e, heading), n, field)
    output[9] = 0.0 if inside else BESIDE
    thrust, turning, widest = 0.0, along(omega, -spin, e), 0.5 * (n.width + field.cell) + abs(e[2]) * BULGE * n.radius
    for row in range(begin[0], end[0]):
        for column in range(begin[1], end[1]):
            dx, dy = field.x + row * field.cell - p[0], field.y + column * field.cell - p[1]
            s, side = dx * heading[0] + dy * heading[1], dx * left[0] + dy * left[1]
            if abs(side) > widest:
                continue
            depth, slope, radius = _rim_over(s, state, n.radius)
            across = (side - depth * dot(down, left)) / dot(e, left)
            share = min((0.5 * n.width - abs(across)) / field.cell + 0.5, 1.0)
            z = -(p[2] + depth * down[2] + across * e[2])
            if depth <= 0.0 or share <= 0.0 or z <= field.carries_from[row, column]:
                continue
            cosine, sine = depth / radius, s / radius
            first = modulus * (z * _share_of_depth(sine, z, state[-1], falls, depths)) ** n.exponent
            pressure, stiffness, yields = _pressure(z, first, n, field, (row, column))
            r = along(along((s * heading[0], s * heading[1], 0.0), depth, down), across, e)
            t = _tangent(heading, down, radius * cosine - slope * sine, -radius * sine - slope * cosine)
            normal = cross(t, e)
            area = share * field.cell * field.cell / normal[2]
            slides = along(along(v, 1.0, cross(turning, r)), -n.shear_radius * spin, t)
            sliding = dot(slides, t), dot(slides, e)
            j, k = _sheared(slides, sliding, field, (row, column))
            a, b = j + n.lag * sliding[0], k + n.lag * sliding[1]
            shear, by = _shear(math.sqrt(a * a + b * b), pressure, n)
            force = along(along(along((0.0, 0.0, 0.0), pressure, normal), -shear * a, t), -shear * b, e)
            moment = cross(r, force)
            for q in range(3):
                wrench[q] += area * force[q]
                wrench[3 + q] += area * moment[q]
                output[4 + q] += area * pressure * r[q]
            output[1] += area * pressure
            thrust += area * shear * a
            _add_harmonics(rate, cosine, sine, area * pressure)
            if jacobian.shape[0]:
                _derive(
                    (r, t, normal, e, (cosine, sine, area)),
                    (shear, by, stiffness, pressure if yields else 0.0),
                    (a, b),
                    ground,
                    state[-2],
                    jacobian,
                )
            if keeps:
                _remember((row, column), (z, pressure, yields), (j, k), n, field)
    if keeps:
        ground.rut[i] = _rut_ahead((p, heading, left), math.copysign(falls[0], state[-1]), n, field)
    _finish((p, e, heading, left), n.shear_radius * thrust, wrench, output)
    _follow(rate, state, ground)
    if jacobian.shape[0]:
        _derive_states((heading, e), (rolls, spin, length), ground, jacobian)
    for q in range(state.shape[0] // 2 - 1):  # the harmonics
        output[0] += state[q]


@compiled
def _shear(sheared: float, pressure: float, n: SoilNumbers) -> tuple[float, Vector]:
    """Shear stress over how far the soil was sheared [Pa/m], its derivatives by that [Pa/m] and, over it, by p [1/m]."""
    share, rising = _mobilised(sheared, n.shear_modulus)
    strength = _lug_thrust(pressure, n.tips, n.sides)
    over = 1.0 / max(sheared, 1e-300)
    if sheared < 1e-12:
        over, share = 1.0, rising
    slope = n.tips[1] if n.tips[0] + pressure * n.tips[1] < n.sides[0] + pressure * n.sides[1] else n.sides[1]
    return strength * share * over, (strength * rising, slope * share * over, sheared)


@compiled
def _tangent(heading: Vector, down: Vector, along_x: float, along_z: float) -> Vector:
    """Unit vector forwards along the rim."""
    return over_length(along((along_x * heading[0], along_x * heading[1], along_x * heading[2]), along_z, down))


@compiled
def _cells(
    p: Vector, axes: tuple[Vector, Vector], n: SoilNumbers, field: SoilField
) -> tuple[tuple[tuple[int, int], tuple[int, int]], bool]:
    """First row and column below a wheel, and those behind the last; whether the field has all of them."""
    e, heading = axes
    largest = BULGE * n.radius
    ahead = math.sqrt(max(largest * largest - max(p[2], 0.0) ** 2, 0.0))
    if ahead == 0.0:
        return ((0, 0), (0, 0)), True
    aside = 0.5 * n.width + abs(e[2]) * largest + field.cell
    x = ahead * abs(heading[0]) + aside * abs(heading[1])
    y = ahead * abs(heading[1]) + aside * abs(heading[0])
    rows, columns = field.deepest.shape
    i, k = int(math.ceil((p[0] - x - field.x) / field.cell)), int(math.ceil((p[1] - y - field.y) / field.cell))
    m, q = int((p[0] + x - field.x) / field.cell) + 1, int((p[1] + y - field.y) / field.cell) + 1
    inside = i >= 0 and k >= 0 and m <= rows and q <= columns
    return ((max(i, 0), max(k, 0)), (min(m, rows), min(q, columns))), inside


@compiled
def _rim_over(s: float, state: FloatArray, radius: float) -> tuple[float, float, float]:
    """Depth of the rim below the hub at the place s ahead [m], dw/d theta [m], and R - w [m]; depth 0 if beside it."""
    rho, slope, count = radius, 0.0, state.shape[0] // 2 - 1
    for _ in range(4):
        if abs(s) >= rho:
            return 0.0, 0.0, rho
        before, sine = rho, s / rho
        cosine = math.sqrt(1.0 - sine * sine)
        w, slope, c, d = 0.0, 0.0, 1.0, 0.0
        for k in range(count):
            w += state[k] * c + state[count + k] * d
            slope += k * (state[count + k] * c - state[k] * d)
            c, d = c * cosine - d * sine, d * cosine + c * sine
        rho = radius - w
        if abs(rho - before) < NEAR * radius:
            break
    return (math.sqrt(rho * rho - s * s) if abs(s) < rho else 0.0), slope, rho


@compiled
def _way(cosine: float, sine: float, state: FloatArray) -> float:
    """w at an angle [m]."""
    w, c, d, count = 0.0, 1.0, 0.0, state.shape[0] // 2 - 1
    for k in range(count):
        w += state[k] * c + state[count + k] * d
        c, d = c * cosine - d * sine, d * cosine + c * sine
    return w


@compiled
def _falling_off(height: float, state: FloatArray, n: SoilNumbers, rut: float, depths: FloatArray) -> Vector:
    """theta_1, theta_m and theta_2 [rad] of a wheel that rolls ahead, mirrored for one that rolls back.

    ``depths`` (2 `STEPS` + 1,) is filled with those of the rim [m], at angles from behind to ahead.
    """
    side, lowest = math.copysign(1.0, state[-1]), 0.0
    cosine, sine = math.cos(FARTHEST), -math.sin(FARTHEST)
    for k in range(2 * STEPS + 1):
        depths[k] = (n.radius - _way(cosine, side * sine, state)) * cosine - height
        lowest = max(lowest, depths[k])
        cosine, sine = cosine * COSINE - sine * SINE, sine * COSINE + cosine * SINE
    entry = _crossed(depths, rut, 2 * STEPS, -1)
    top = (n.peaks[0] + n.peaks[1] * min(max(state[-2], 0.0), 1.0)) * entry
    softer = _slip_sinkage(state[-2]) ** n.slip_sinkage
    peak, modulus = max(_at(top, depths), 0.0), n.modulus / softer**n.exponent
    behind = _crossed(depths, lowest - _rebound(peak, modulus, n.exponent, n.least, n.growth), 0, 1)
    return entry, top, min(behind, top - 1e-6)


@compiled
def _crossed(depths: FloatArray, level: float, begin: int, way: int) -> float:
    """Angle at which the rim first lies below a depth [rad], looked for from one end."""
    k = begin
    while 0 <= k < 2 * STEPS + 1 and depths[k] <= level:
        k += way
    if not 0 <= k < 2 * STEPS + 1:
        return 0.0
    if k == begin:
        return (k - STEPS) * STEP
    return (k - STEPS - way * (depths[k] - level) / (depths[k] - depths[k - way])) * STEP


@compiled
def _at(angle: float, depths: FloatArray) -> float:
    """Depth of the rim at an angle [m]."""
    place = min(max(angle / STEP + STEPS, 0.0), 2.0 * STEPS - 1e-9)
    k = int(place)
    return depths[k] + (place - k) * (depths[k + 1] - depths[k])


@compiled
def _share_of_depth(sine: float, z: float, rolled: float, falls: Vector, depths: FloatArray) -> float:
    """Depth whose pressure a piece of rim has, over its own depth: 1 ahead of theta_m, less behind (Wong and Reece)."""
    entry, top, behind = falls
    angle = math.asin(math.copysign(sine, sine * rolled))
    if angle >= top or rolled == 0.0:
        return 1.0
    there = max(_at(min(top + (top - angle) * (entry - top) / (top - behind), entry), depths), 0.0)
    return 1.0 - abs(rolled) * (1.0 - min(there / z, 1.0))


@compiled
def _rut_ahead(axes: tuple[Vector, Vector, Vector], entry: float, n: SoilNumbers, field: SoilField) -> float:
    """Depth at which the ground begins to carry, mean over the width just ahead of the first contact [m]."""
    p, heading, left = axes
    total, count = 0.0, 0
    way = math.copysign(1.0, entry)
    for step in range(4):
        for across in range(-2, 3):
            s, side = n.radius * math.sin(entry) + way * (0.5 + step) * field.cell, 0.2 * across * n.width
            row = int(round((p[0] + s * heading[0] + side * left[0] - field.x) / field.cell))
            column = int(round((p[1] + s * heading[1] + side * left[1] - field.y) / field.cell))
            if 0 <= row < field.deepest.shape[0] and 0 <= column < field.deepest.shape[1]:
                total += field.carries_from[row, column]
                count += 1
    return total / max(count, 1)


@compiled
def _sheared(
    slides: Vector, sliding: tuple[float, float], field: SoilField, cell: tuple[int, int]
) -> tuple[float, float]:
    """How far the soil below a piece of rim is sheared, ahead and aside [m].

    The rim takes along what it sheared, so that j is that of the rim's own piece: it comes from the cell that the rim
    slides from, upwind and implicit.
    """
    j, k = field.clock[0] * sliding[0], field.clock[0] * sliding[1]
    whole, per_cell = 1.0, field.clock[0] / field.cell
    if field.clock[1] > 0.0:
        if field.touched[cell] == field.clock[1]:
            j += field.ahead[cell]
            k += field.aside[cell]
        for axis in range(2):
            share = abs(slides[axis]) * per_cell
            from_side = -1 if slides[axis] > 0.0 else 1
            other = (cell[0] + from_side, cell[1]) if axis == 0 else (cell[0], cell[1] + from_side)
            whole += share
            within = 0 <= other[0] < field.touched.shape[0] and 0 <= other[1] < field.touched.shape[1]
            if within and field.touched[other] == field.clock[1]:
                j += share * field.ahead[other]
                k += share * field.aside[other]
    return j / whole, k / whole


@compiled
def _pressure(
    z: float, first: float, n: SoilNumbers, field: SoilField, cell: tuple[int, int]
) -> tuple[float, float, bool]:
    """Pressure of a cell at a depth [Pa], its derivative [Pa/m], and whether the soil yields; ``first`` its pressure
    as of soil that was never pressed.
    """
    deepest, begins, stiffness = field.deepest[cell], field.carries_from[cell], field.unloading[cell]
    line = stiffness * (z - begins)
    yields = deepest == 0.0 or first <= line
    if not yields and z > deepest:  # firmer than the line: as much was carried before, or the soil was softer then
        yields = first * (deepest / z) ** n.exponent <= stiffness * (deepest - begins) * ROUNDING
    if yields:
        return first, n.exponent * first / z, True
    return line, stiffness, False


@compiled
def _remember(
    cell: tuple[int, int],
    pressed: tuple[float, float, bool],
    sheared: tuple[float, float],
    n: SoilNumbers,
    field: SoilField,
) -> None:
    """Keep what a cell went through.

    It comes back from its largest pressure along a line no flatter than its own law, never above the ground.
    """
    z, pressure, yields = pressed
    field.touched[cell] = int(field.clock[1]) + 1
    field.ahead[cell], field.aside[cell] = sheared
    if yields:
        most = max(pressure, field.unloading[cell] * (field.deepest[cell] - field.carries_from[cell]))
        deepest = max(field.deepest[cell], z)
        stiffness = max(n.least + n.growth * deepest, max(n.exponent, 1.0) * most / deepest)
        field.deepest[cell], field.unloading[cell] = deepest, stiffness
        field.carries_from[cell] = deepest - most / stiffness


@compiled
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
    axes: tuple[Vector, Vector, Vector, Vector], about_axle: float, wrench: FloatArray, output: FloatArray
) -> None:
    """Moment about the axle, and outputs that are sums over the cells; ``axes`` place, axle, heading and left."""
    p, e, heading, left = axes
    moment = wrench[3] * e[0] + wrench[4] * e[1] + wrench[5] * e[2]
    carried = max(output[1], 1e-300)
    for q in range(3):
        wrench[3 + q] += (about_axle - moment) * e[q]
        output[4 + q] = p[q] + output[4 + q] / carried
    force = vector(wrench)
    output[1], output[7], output[8] = force[2], dot(force, heading), dot(force, left)


@compiled
def _derive(
    axes: tuple[Vector, Vector, Vector, Vector, Vector],
    laws_of: tuple[float, Vector, float, float],
    sheared: tuple[float, float],
    ground: SoilGround,
    sigma: float,
    jacobian: FloatArray,
) -> None:
    """Add one cell's derivatives.

    Parameters
    ----------
    axes : lever, tangent, normal, axle; cosine and sine of the place on the rim and area [m^2]
    laws_of : shear stress over way, `_shear`'s derivatives, dp/dz, and p where the soil yields, else 0
    sheared : ahead and aside, lag included [m]
    sigma : slip along the contact [-]
    """
    r, t, normal, e, (cosine, sine, area) = axes
    shear, (rising, by_pressure, way), stiffness, yielding = laws_of
    a, b = sheared
    n, count = ground.numbers, (jacobian.shape[0] - 8) // 2
    unit = along(along(normal, -by_pressure * a, t), -by_pressure * b, e)  # of the force per area, by the pressure
    on_wrench = _wrench((r, e), unit, -by_pressure * a, (n.shear_radius, area))
    turned = cross(r, normal)
    by_motion = (*normal, *turned)
    for q in range(6):
        dp = -stiffness * by_motion[q] / normal[2]
        for m in range(6):
            jacobian[m, q] += on_wrench[m] * dp
        _add_rates(jacobian, q, (cosine, sine), area * dp)
    c, d = 1.0, 0.0
    for k in range(count):
        for column, value in ((12 + k, c), (12 + count + k, d)):
            dp = -stiffness * value / normal[2]
            for m in range(6):
                jacobian[m, column] += on_wrench[m] * dp
            _add_rates(jacobian, column, (cosine, sine), area * dp)
        c, d = c * cosine - d * sine, d * cosine + c * sine
    if 0.0 < sigma < 1.0:
        dp = -yielding * n.exponent * n.slip_sinkage * (1.0 / (1.0 + sigma) + 0.5 / (1.0 - 0.5 * sigma))
        for m in range(6):
            jacobian[m, 12 + 2 * count] += on_wrench[m] * dp
        _add_rates(jacobian, 12 + 2 * count, (cosine, sine), area * dp)
    over = 1.0 / max(way, 1e-12)
    x, y = a * over, b * over
    change = -(ground.field.clock[0] + n.lag)
    first = change * (shear * (1.0 - x * x) + rising * x * x)
    mixed = change * (rising - shear) * x * y
    second = change * (shear * (1.0 - y * y) + rising * y * y)
    zero = (0.0, 0.0, 0.0)
    on_ahead = _wrench((r, e), along(along(zero, first, t), mixed, e), first, (n.shear_radius, area))
    on_aside = _wrench((r, e), along(along(zero, mixed, t), second, e), mixed, (n.shear_radius, area))
    spun = cross(r, t)
    ahead = (*t, *along(spun, -dot(spun, e) - n.shear_radius, e))
    aside = (*e, *cross(r, e))
    for q in range(6):
        for m in range(6):
            jacobian[m, 6 + q] += on_ahead[m] * ahead[q] + on_aside[m] * aside[q]


@compiled
def _wrench(
    axes: tuple[Vector, Vector], stress: Vector, ahead: float, sizes: tuple[float, float]
) -> tuple[float, float, float, float, float, float]:
    """Force and moment of a stress over an area at a lever, that about the axle by its part ahead along the rim."""
    r, e = axes
    lever, area = sizes
    moment = cross(r, stress)
    moment = along(moment, -dot(moment, e) - lever * ahead, e)
    return (
        area * stress[0],
        area * stress[1],
        area * stress[2],
        area * moment[0],
        area * moment[1],
        area * moment[2],
    )


@compiled
def _add_rates(jacobian: FloatArray, column: int, place: tuple[float, float], force: float) -> None:
    """A radial force in the harmonics' rows."""
    count, c, d = (jacobian.shape[0] - 8) // 2, 1.0, 0.0
    for k in range(count):
        jacobian[6 + k, column] += force * c
        jacobian[6 + count + k, column] += force * d
        c, d = c * place[0] - d * place[1], d * place[0] + c * place[1]


@compiled
def _derive_states(
    axes: tuple[Vector, Vector], rolling: tuple[float, float, float], ground: SoilGround, jacobian: FloatArray
) -> None:
    """Bring the harmonics' rows from forces to rates, and fill that of the slip; ``axes`` heading and axle."""
    heading, e = axes
    rolls, spin, length = rolling
    count, n = (jacobian.shape[0] - 8) // 2, ground.numbers
    for k in range(2 * count):
        for column in range(jacobian.shape[1]):
            jacobian[6 + k, column] *= ground.compliance[k % count] / n.settling
        jacobian[6 + k, 12 + k] -= 1.0 / n.settling
    last, way = 6 + 2 * count, math.copysign(1.0, spin)
    for k in range(2):
        jacobian[last + k, 12 + 2 * count + k] = -rolls / length
    for q in range(3):
        jacobian[last, 6 + q] = -way * heading[q] / length
        jacobian[last, 9 + q] = way * n.radius * e[q] / length
        jacobian[last + 1, 9 + q] = n.radius * e[q] / length
