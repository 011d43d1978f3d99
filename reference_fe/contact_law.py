"""Penalty law of frictionless contact with a rigid plane, with a short quadratic ramp around touch."""

from __future__ import annotations

from reference_fe.dolfinx_api import Expr, ufl

__all__ = ["plane_pressure"]


def plane_pressure(gap: Expr, lag: Expr, penalty: Expr, ramp: float) -> tuple[Expr, Expr]:
    """Contact pressure and its stiffness, linearised about a lagged gap.

    Pressure law, with normal gap g (open > 0), penalty k and ramp d:
    p = 0 for g > d; p = k (d - g)^2 / (4 d) for |g| <= d; p = -k g for g < -d. It is continuously differentiable, so
    points that are barely open do not flicker between two stiffnesses. With a lag l the law is replaced by its tangent
    line at g + l: p(g + l) + k'(g + l) l. The plane's rise used as lag gives, in the first solve of an increment, the
    linearisation about the last converged state with its contact set; l = 0 gives the law itself.

    Parameters
    ----------
    gap : normal gap g [m]
    lag : l [m]
    penalty : k [N/m^3]
    ramp : d > 0 [m]

    Returns
    -------
    pressure, stiffness : p [Pa] and -dp/dg [N/m^3] as UFL expressions

    Verified by tests/verification/test_fe_ring.py (elastica ring) and tests/unit/test_fe_contact_law.py.
    """
    g = gap + lag
    touching, closed = ufl.lt(g, ramp), ufl.lt(g, -ramp)
    slope = ufl.conditional(closed, 1.0, ufl.conditional(touching, (ramp - g) / (2.0 * ramp), 0.0))
    depth = ufl.conditional(closed, -g, ufl.conditional(touching, (ramp - g) ** 2 / (4.0 * ramp), 0.0))
    return penalty * (depth + slope * lag), penalty * slope
