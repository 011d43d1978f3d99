"""Compiled loops over the contact points that touch: force, power, record, exact tangents (thesis eqs. 2.21, 2.22).

Verified by tests/unit/test_ancf_plate_contact.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import Symmetric, Vector, compiled, dot, inlined
from ancf_reduced.contact.law import normal_force, point_force, point_tangents, slip
from ancf_reduced.contact.search import TOUCH, Constants, at_point, find_touching, named, touch_at

__all__ = ["contact_force_kernel", "contact_record_kernel", "contact_tangent_kernel"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Account = tuple[int, float, float, float, float]
BATCH = 4
"""Points whose tangents are added to a plate's matrix together."""


@compiled
def _inward_normal(a: Vector, b: Vector) -> tuple[Vector, float]:
    """Unit normal into the tire, -(a x b) / |a x b|, and |a x b|."""
    x, y, z = a[2] * b[1] - a[1] * b[2], a[0] * b[2] - a[2] * b[0], a[1] * b[0] - a[0] * b[1]
    size = max(np.sqrt(x * x + y * y + z * z), 1e-300)
    return (x / size, y / size, z / size), size


@inlined
def _normal(p: FloatArray, nodes: IntArray, slopes: FloatArray, m: Vector, by_surface: bool) -> tuple[Vector, bool]:
    """Normal the force has, and whether there is one: a face turned away from the ground is not pressed."""
    if not by_surface:
        return m, True
    n = _inward_normal(at_point(p, nodes, slopes[0]), at_point(p, nodes, slopes[1]))[0]
    return n, dot(n, m) > 0.0


@inlined
def _add_force(f: Vector, nodes: IntArray, functions: FloatArray, force: FloatArray) -> None:
    """Add a point's force to the mesh's (n_nodes, 4, 3)."""
    for n in range(4):
        node = force[nodes[n]]
        for c in range(4):
            s = functions[4 * n + c]
            node[c, 0] += s * f[0]
            node[c, 1] += s * f[1]
            node[c, 2] += s * f[2]


@compiled
def contact_force_kernel(
    p: FloatArray, v: FloatArray, constants: Constants, search: bool, force: FloatArray
) -> Account:
    """Generalised force of the ground on the mesh, and where its power goes.

    Parameters
    ----------
    p, v : (n_nodes, 4, 3) float, structure coordinates in the world frame [m, -] and their rates [m/s, 1/s]
    constants : see `Constants`
    search : see `find_touching`
    force : (n_nodes, 4, 3) float [N, N m], overwritten

    Returns
    -------
    count : as `find_touching`
    energy : stored in the penalty, sum of k delta^2 / 2 [J]
    damping, friction : power dissipated by normal damping and by friction, >= 0 [W]
    power : of all contact forces on the tire [W]; -d(energy)/dt - damping - friction with the terrain's normal
    """
    grid, terrain, law, by_surface = named(constants)
    capacity = len(grid.nodes) * grid.interpolation.shape[1] * len(terrain.rows)
    where, touch = np.empty((capacity, 2), dtype=np.int64), np.empty((capacity, TOUCH))
    count = find_touching(p, grid, terrain, search, where, touch)
    energy, damping, friction, power = 0.0, 0.0, 0.0, 0.0
    force[:] = 0.0
    for row in range(count):
        j, point = where[row, 0], where[row, 1]
        nodes, functions = grid.nodes[j], grid.interpolation[j, point]
        gap, m, _ = touch_at(touch[row])
        n, pressed = _normal(p, nodes, grid.slopes[j, point], m, by_surface)
        if not pressed:
            continue
        velocity = at_point(v, nodes, functions)
        rate = -dot(m, velocity)
        N = normal_force(law, -gap, rate)
        f = point_force(law, N, n, velocity)
        t, tau, _ = slip(law, n, velocity)
        energy += 0.5 * law.stiffness * gap * gap
        damping += (N + law.stiffness * gap) * rate
        friction += law.friction * N * dot(t, tau)
        power += dot(f, velocity)
        _add_force(f, nodes, functions, force)
    return count, energy, damping, friction, power


@compiled
def contact_record_kernel(
    p: FloatArray,
    v: FloatArray,
    constants: Constants,
    where: IntArray,
    record: FloatArray,
) -> int:
    """List the touching points with their forces, for output.

    where : (n, 2) int as `find_touching`; record : (n, 14) float, overwritten: penetration [m], N [N], position [m],
    force [N], slip velocity [m/s], normal; the other arguments as `contact_force_kernel`. Returns the entries.
    """
    grid, terrain, law, by_surface = named(constants)
    touch = np.empty((len(where), TOUCH))
    count = find_touching(p, grid, terrain, True, where, touch)
    for row in range(count):
        j, point = where[row, 0], where[row, 1]
        nodes, functions, entry = grid.nodes[j], grid.interpolation[j, point], record[row]
        gap, m, _ = touch_at(touch[row])
        n, pressed = _normal(p, nodes, grid.slopes[j, point], m, by_surface)
        velocity = at_point(v, nodes, functions)
        N = normal_force(law, -gap, -dot(m, velocity)) if pressed else 0.0
        entry[0], entry[1] = -gap, N
        entry[2], entry[3], entry[4] = at_point(p, nodes, functions)
        entry[5], entry[6], entry[7] = point_force(law, N, n, velocity)
        entry[8], entry[9], entry[10] = slip(law, n, velocity)[0]
        entry[11], entry[12], entry[13] = n
    return count


@inlined
def _add_right(A: FloatArray, functions: FloatArray, right: FloatArray) -> None:
    """Add A_ij functions_t to right (3, 48), column 3 t + j."""
    for i in range(3):
        for t in range(16):
            for j in range(3):
                right[i, 3 * t + j] += A[i, j] * functions[t]


@compiled
def _subtract_batch(left: FloatArray, right: FloatArray, K: FloatArray) -> None:
    """Subtract the sum over a batch of left_s right_i from K (48, 48): left (BATCH, 16), right (BATCH, 3, 48)."""
    for s in range(16):
        a, b, c, d = left[0, s], left[1, s], left[2, s], left[3, s]
        for i in range(3):
            for column in range(48):
                K[3 * s + i, column] -= (
                    a * right[0, i, column]
                    + b * right[1, i, column]
                    + c * right[2, i, column]
                    + d * right[3, i, column]
                )


@inlined
def _add_slopes(A: FloatArray, a: Vector, b: Vector, slopes: FloatArray, right: FloatArray) -> None:
    """Add to right (3, 48) what the force changes with the normal n = -(a x b) / |a x b|; A is its derivative by n."""
    n, size = _inward_normal(a, b)
    both = np.empty((2, 3, 3))
    for i in range(3):
        along = A[i, 0] * n[0] + A[i, 1] * n[1] + A[i, 2] * n[2]
        x, y, z = (A[i, 0] - along * n[0]) / size, (A[i, 1] - along * n[1]) / size, (A[i, 2] - along * n[2]) / size
        both[0, i, 0], both[0, i, 1], both[0, i, 2] = y * b[2] - z * b[1], z * b[0] - x * b[2], x * b[1] - y * b[0]
        both[1, i, 0], both[1, i, 1], both[1, i, 2] = z * a[1] - y * a[2], x * a[2] - z * a[0], y * a[0] - x * a[1]
    _add_right(both[0], slopes[0], right)
    _add_right(both[1], slopes[1], right)


@inlined
def _add_curvature(A: FloatArray, H: Symmetric, by_position: FloatArray) -> None:
    """Add A H to ``by_position`` (3, 3)."""
    for i in range(3):
        by_position[i, 0] += A[i, 0] * H[0] + A[i, 1] * H[5] + A[i, 2] * H[4]
        by_position[i, 1] += A[i, 0] * H[5] + A[i, 1] * H[1] + A[i, 2] * H[3]
        by_position[i, 2] += A[i, 0] * H[4] + A[i, 1] * H[3] + A[i, 2] * H[2]


@compiled
def contact_tangent_kernel(
    p: FloatArray,
    v: FloatArray,
    constants: Constants,
    by_position: FloatArray,
    by_rate: FloatArray,
) -> int:
    """Minus the derivatives of each plate's contact force by its coordinates and by their rates, not symmetric.

    by_position, by_rate : (n_plates, 48, 48) float [N/m, ...] and [N s/m, ...], overwritten, laid out as in
    `tangent_kernels.tangent_kernel`; the other arguments as `contact_force_kernel`. Returns its count.
    """
    grid, terrain, law, by_surface = named(constants)
    capacity = len(grid.nodes) * grid.interpolation.shape[1] * len(terrain.rows)
    where, touch = np.empty((capacity, 2), dtype=np.int64), np.empty((capacity, TOUCH))
    count = find_touching(p, grid, terrain, True, where, touch)
    A, plate, filled = np.empty((3, 3, 3)), -1, 0
    left, by_p, by_v = np.zeros((BATCH, 16)), np.zeros((BATCH, 3, 48)), np.zeros((BATCH, 3, 48))
    by_position[:] = 0.0
    by_rate[:] = 0.0
    for row in range(count):
        j, point = where[row, 0], where[row, 1]
        nodes, functions, slopes = grid.nodes[j], grid.interpolation[j, point], grid.slopes[j, point]
        gap = touch_at(touch[row])
        n, pressed = _normal(p, nodes, slopes, gap[1], by_surface)
        if not (pressed and point_tangents(law, gap, n, at_point(v, nodes, functions), A)):
            continue
        if filled == BATCH or (filled > 0 and grid.plates[j] != plate):
            _subtract_batch(left, by_p, by_position[plate])
            _subtract_batch(left, by_v, by_rate[plate])
            left[:] = 0.0
            filled = 0
        plate, left[filled], by_p[filled], by_v[filled] = grid.plates[j], functions, 0.0, 0.0
        if by_surface:
            _add_slopes(A[2], at_point(p, nodes, slopes[0]), at_point(p, nodes, slopes[1]), slopes, by_p[filled])
        else:
            _add_curvature(A[2], gap[2], A[0])
        _add_right(A[0], functions, by_p[filled])
        _add_right(A[1], functions, by_v[filled])
        filled += 1
    if filled > 0:
        _subtract_batch(left, by_p, by_position[plate])
        _subtract_batch(left, by_v, by_rate[plate])
    return count
