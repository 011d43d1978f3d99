"""Where a wheel touches its terrain, and the radial deflection each contact carries; compiled.

The wheel is a rim of radius R and width b, rigid in itself and held by the hub through the radial stiffness k in its
plane. One contact for each piece of terrain has the distance phi of the piece from the hub centre in the wheel's plane,
the unit normal n and, with the camber against it, n . e = sin gamma, q = cos gamma. Across the width the deflection is
delta(y) = R - phi - y tan gamma; its mean over the width where it is positive is the contact's delta, the centre of
that y_c its place.

Several pieces at once displace the rim against the hub by D = sum lambda_i u_i, the shortest D that frees it from all,
to first order:

    lambda_i >= 0,   sum_j G_ij lambda_j >= delta_i,   one of the two an equality,   G_ij = max(u_i . u_j, 0),

u the unit vectors in the wheel's plane from the contacts to the hub. Ground and face of a step act each by itself
(G = 0), and ground that two pieces share does not count twice (G = 1). The radial force of contact i is k lambda_i; for
pieces with plane faces, k/2 lambda . G lambda is its potential.

A contact fades out between 72 and 84 degrees of camber against its piece: contact of the wheel's sides is not modelled.

Verified by tests/unit/test_brush_contact.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import PieceKind, TerrainPieces
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, ramp
from rover_dynamics.tires.brush_edges import Facing, convex_distance
from rover_dynamics.tires.brush_profile import profile_distance

__all__ = ["CONTACT_SIZE", "fading", "find_contacts"]

FloatArray = NDArray[np.float64]
CONTACT_SIZE = 18
"""Numbers of a contact: lambda, n (3), place from the hub centre (3), u (3), q, delta, and how u turns with n about the
axle, over the hub's way (3) [rad/m] and rotation (3) [-]."""
SINUSOID = int(PieceKind.SINUSOID)
STEEPEST, FADED = 0.1, 0.2
SWEEPS, TOLERANCE = 200, 1e-13


@compiled
def find_contacts(
    p: Vector, e: Vector, size: tuple[float, float], terrain: TerrainPieces, contacts: FloatArray, scratch: FloatArray
) -> None:
    """Fill the contacts (n_pieces, 18) of one wheel.

    Parameters
    ----------
    p, e : hub centre [m] and unit vector of the axle
    size : radius and width [m]
    terrain : its pieces
    contacts : written, see `CONTACT_SIZE`; lambda = 0 where a piece is not touched
    scratch : (34, 4) float
    """
    touched = 0
    for k in range(terrain.rows.shape[0]):
        piece = terrain.rows[k]
        if int(piece[0]) >= SINUSOID:
            found = profile_distance(piece, terrain.knots, p, e, size[0], scratch)
        else:
            found = convex_distance(piece, p, e)
        touched += _place(found, e, size, contacts[k])
    if touched > 1:
        _share(contacts)


@compiled
def _place(found: Facing, e: Vector, size: tuple[float, float], row: FloatArray) -> int:
    """One contact's numbers; 1 if it touches."""
    phi, n, tilt, turning = found
    row[0], row[11] = 0.0, 0.0
    q = math.sqrt(max(1.0 - tilt * tilt, 0.0))
    if q <= STEEPEST:
        return 0
    slope, width = tilt / q, size[1]
    delta, y = _across_width(size[0] - phi, slope, width)
    if delta <= 0.0:
        return 0
    u = along(n, -tilt, e)
    u = u[0] / q, u[1] / q, u[2] / q
    reach = phi + y * slope
    row[0], row[10], row[11] = delta, q, delta
    for m in range(3):
        row[1 + m], row[4 + m], row[7 + m] = n[m], y * e[m] - reach * u[m], u[m]
        row[12 + m], row[15 + m] = turning[0][m], turning[1][m]
    return 1


@compiled
def _across_width(depth: float, slope: float, width: float) -> tuple[float, float]:
    """Mean of max(depth - y slope, 0) over the width, and the centre y of it."""
    edge = 0.5 * width * abs(slope)
    if depth <= -edge:
        return 0.0, 0.0
    if depth >= edge:
        return depth, -slope * width * width / (12.0 * depth) if depth > 0.0 else 0.0
    deep = depth + edge
    return deep * deep / (4.0 * edge), -math.copysign(0.5 * width - deep * width / (6.0 * edge), slope)


@compiled
def _share(contacts: FloatArray) -> None:
    """Solve for lambda by Gauss-Seidel with projection."""
    for _ in range(SWEEPS):
        change = 0.0
        for i in range(contacts.shape[0]):
            if contacts[i, 11] <= 0.0:
                continue
            rest = contacts[i, 11]
            for j in range(contacts.shape[0]):
                if j != i and contacts[j, 0] > 0.0:
                    u, w = contacts[i], contacts[j]
                    rest -= max(u[7] * w[7] + u[8] * w[8] + u[9] * w[9], 0.0) * contacts[j, 0]
            rest = max(rest, 0.0)
            change = max(change, abs(rest - contacts[i, 0]))
            contacts[i, 0] = rest
        if change < TOLERANCE:
            break


@compiled
def fading(q: float) -> float:
    """Share [-] of a contact's force that is left at the cosine q [-] of its camber."""
    return ramp((q - STEEPEST) / FADED)
