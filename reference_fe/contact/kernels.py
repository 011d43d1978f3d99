"""Compiled loops of contact with rigid obstacles: tractions at the quadrature points, forces and blocks of the facets.

Arrays over facets m, quadrature points q, the facet's nodes k, pieces c of the obstacle, axes of space (2 or 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled
from reference_fe.contact.law import friction_traction, ramped_pressure, soil_pressure
from reference_fe.contact.obstacles import piece_gap

__all__ = ["ContactHistory", "PointForces", "Surface", "facet_blocks", "facet_forces", "point_forces"]


class Surface(NamedTuple):
    """The obstacle where it stands, and the law.

    normal, along : (dim,) unit axes z and s of the profile [-]
    level, start : z and s of the profile's origin, along those axes [m]
    pieces : (c, 5), see `obstacles.piece_gap`
    stiffness : (m,) penalty stiffness of each facet [N/m^3]
    ramp : see `contact.law.ramped_pressure` [m]
    friction : mu [-]
    stick : (m,) stiffness of sticking [N/m^3]
    soil : modulus [N/m^(n+2)] and exponent of soil that the obstacle is of; zeros for a rigid one
    level_share : (m, q) level area of each point over its undeformed one [-], on soil; else without numbers
    """

    normal: NDArray[np.float64]
    along: NDArray[np.float64]
    level: float
    start: float
    pieces: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    ramp: float
    friction: float
    stick: NDArray[np.float64]
    soil: tuple[float, float]
    level_share: NDArray[np.float64]


class ContactHistory(NamedTuple):
    """Multipliers, and what friction starts from: traction and place relative to the obstacle when last accepted.

    multiplier : (m, q, c) [Pa]
    traction : (m, q, c, dim) [Pa]
    place : (m, q, dim) [m]
    """

    multiplier: NDArray[np.float64]
    traction: NDArray[np.float64]
    place: NDArray[np.float64]


class PointForces(NamedTuple):
    """What `point_forces` fills.

    gap, pressure : (m, q, c) [m], [Pa]
    traction : (m, q, c, dim) tangential traction [Pa]
    force : (m, q, dim) on the body per undeformed area [Pa]
    stiffness : (m, q, dim, dim) minus its derivative by the point's displacement [N/m^3]
    """

    gap: NDArray[np.float64]
    pressure: NDArray[np.float64]
    traction: NDArray[np.float64]
    force: NDArray[np.float64]
    stiffness: NDArray[np.float64]

    @classmethod
    def zeros(cls, facets: int, points: int, pieces: int, dim: int) -> PointForces:
        """Room for the results."""
        per_piece, per_point = (facets, points, pieces), (facets, points, dim)
        gap, pressure, traction = np.zeros(per_piece), np.zeros(per_piece), np.zeros((*per_piece, dim))
        return cls(gap, pressure, traction, np.zeros(per_point), np.zeros((*per_point, dim)))


@compiled()
def point_forces(
    x: NDArray[np.float64], slip: NDArray[np.float64], surface: Surface, history: ContactHistory, out: PointForces
) -> None:
    """Contact law at every quadrature point.

    With gap g, unit normal n, curvature Hessian H of a piece, pressure p with stiffness k_n = -dp/dg and tangential
    traction t, the force per area is p n + t and its stiffness k_n n n^T - p H + K_t. Friction starts from the trial
    traction t_a - k_t P slip with P = I - n n^T and slip counted from the last accepted state; sticking K_t = k_t P,
    sliding along d: K_t = mu k_n d n^T + k_t mu p / |t_trial| (P - d d^T), not symmetric. The turn of n with the slip
    is left out of K_t (exact on flat pieces). Soil presses upwards, by its depth on the level area of each point.

    Parameters
    ----------
    x : (m, q, dim) deformed points [m]
    slip : (m, q, dim) displacement relative to the obstacle since the last accepted state [m]
    """
    dim = x.shape[2]
    n, t, trial, d = np.zeros(dim), np.zeros(dim), np.zeros(dim), np.zeros(dim)
    force, stiffness = np.zeros(dim), np.zeros((dim, dim))
    modulus, exponent = surface.soil
    for m in range(x.shape[0]):
        penalty, k_t = surface.stiffness[m], surface.stick[m]
        for q in range(x.shape[1]):
            s, z = -surface.start, -surface.level
            for i in range(dim):
                s += surface.along[i] * x[m, q, i]
                z += surface.normal[i] * x[m, q, i]
            force[:], stiffness[:] = 0.0, 0.0
            for c in range(len(surface.pieces)):
                gap, n_s, n_z, curvature = piece_gap(surface.pieces[c], s, z)
                if modulus > 0.0:
                    pressure, slope = soil_pressure(-gap, modulus, exponent)
                    pressure, slope = pressure * surface.level_share[m, q], slope * surface.level_share[m, q]
                else:
                    pressure, slope = ramped_pressure(gap, penalty, surface.ramp, history.multiplier[m, q, c])
                out.gap[m, q, c], out.pressure[m, q, c] = gap, pressure
                if surface.friction > 0.0:
                    out.traction[m, q, c] = 0.0
                if pressure == 0.0:
                    continue
                for i in range(dim):
                    n[i] = n_s * surface.along[i] + n_z * surface.normal[i]
                    t[i] = n_z * surface.along[i] - n_s * surface.normal[i]
                for i in range(dim):
                    force[i] += pressure * n[i]
                    for j in range(dim):
                        stiffness[i, j] += slope * n[i] * n[j] - pressure * curvature * t[i] * t[j]
                if surface.friction == 0.0:
                    continue
                limit = surface.friction * pressure
                along_normal = 0.0
                for i in range(dim):
                    along_normal += n[i] * (history.traction[m, q, c, i] - k_t * slip[m, q, i])
                for i in range(dim):
                    trial[i] = history.traction[m, q, c, i] - k_t * slip[m, q, i] - along_normal * n[i]
                share = friction_traction(trial, limit, out.traction[m, q, c], d)
                slides = 1.0 if share < 1.0 else 0.0
                for i in range(dim):
                    force[i] += out.traction[m, q, c, i]
                    for j in range(dim):
                        projected = (1.0 if i == j else 0.0) - n[i] * n[j] - d[i] * d[j]
                        # d is the direction of the traction on the body; the traction grows with p along d
                        stiffness[i, j] += k_t * share * projected + slides * surface.friction * slope * d[i] * n[j]
            out.force[m, q] = force
            out.stiffness[m, q] = stiffness


@compiled()
def facet_forces(
    active: NDArray[np.int64],
    shapes: NDArray[np.float64],
    kind: NDArray[np.int64],
    weights: NDArray[np.float64],
    force: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Nodal forces of the active facets, (n_active, k, dim) [N].

    Parameters
    ----------
    active : numbers of the facets that touch
    shapes : (kinds, q, k) shape functions at the points of a facet of each kind (its number within its cell) [-]
    kind : (m,) kind of each facet
    weights : (m, q) undeformed area of each point [m^2]
    force : (m, q, dim) [Pa]
    """
    _, points, nodes = shapes.shape
    dim = force.shape[2]
    out = np.zeros((len(active), nodes, dim))
    for row in range(len(active)):
        m = active[row]
        for q in range(points):
            for a in range(nodes):
                share = weights[m, q] * shapes[kind[m], q, a]
                for i in range(dim):
                    out[row, a, i] += share * force[m, q, i]
    return out


@compiled()
def facet_blocks(
    active: NDArray[np.int64],
    shapes: NDArray[np.float64],
    kind: NDArray[np.int64],
    weights: NDArray[np.float64],
    stiffness: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Stiffness of the active facets, (n_active, k, dim, k, dim) [N/m]; parameters as in `facet_forces`."""
    _, points, nodes = shapes.shape
    dim = stiffness.shape[2]
    out = np.zeros((len(active), nodes, dim, nodes, dim))
    for row in range(len(active)):
        m = active[row]
        for q in range(points):
            if not stiffness[m, q].any():
                continue
            for a in range(nodes):
                for b in range(nodes):
                    share = weights[m, q] * shapes[kind[m], q, a] * shapes[kind[m], q, b]
                    for i in range(dim):
                        for j in range(dim):
                            out[row, a, i, b, j] += share * stiffness[m, q, i, j]
    return out
