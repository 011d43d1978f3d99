"""How strips of a planar model are held across the plane: plane stress, plane strain, and what lies between.

St. Venant-Kirchhoff material in a plane keeps its form, S = lambda_p tr(E) I + 2 mu E over the plane's components, with

    plane strain  lambda_p = lambda,      plane stress  lambda_p = 2 lambda mu / (lambda + 2 mu),

both exact at finite strain, because E_33 follows linearly from S_33 = 0. A strip that bends wants neither: near its
free edges it takes the anticlastic curvature of a beam, far from them it bends to a cylinder like a plate. Its bending
modulus lies between E and E / (1 - nu^2) (`strip_constraint`), and lambda_p is chosen to give it.
Verified by tests/unit/test_fe_plane_state.py and tests/verification/test_fe_section.py.
"""

from __future__ import annotations

import math

from contracts.errors import InputError
from contracts.materials import Material

__all__ = ["PLANE_STRAIN", "PLANE_STRESS", "planar_lambda", "strip_constraint"]

PLANE_STRAIN, PLANE_STRESS = 1.0, 0.0
_WIDE = 60.0


def strip_constraint(width: float, radius: float, thickness: float, poisson_ratio: float) -> float:
    """How nearly a curved strip bends to a cylinder [-]: 0 as a narrow beam, 1 as an endless plate.

    The cross-section deflects by w(y), held by the hoop strain w / R: D w'''' + (E t / R^2) w = 0, with w''' = 0 and
    w'' = -nu kappa at the edges. The moment per curvature is D b (1 - nu^2 f) with

        f = (2 / a) (cosh a - cos a) / (sinh a + sin a),   a = (3 (1 - nu^2))^(1/4) b / sqrt(R t),

    (Ashwell, J. Royal Aeronautical Society 54, 1950, 708-715); the constraint is 1 - f.

    Parameters
    ----------
    width, radius, thickness : width b of one strip, radius R of its curvature, thickness t [m]
    """
    for what, value in (("width", width), ("radius", radius), ("thickness", thickness)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"strip {what}", f"{value:g} m", "must be finite and > 0", "give metres")
    a = math.sqrt(math.sqrt(3.0 * (1.0 - poisson_ratio**2))) * width / math.sqrt(radius * thickness)
    if a > _WIDE:
        return 1.0 - 2.0 / a
    return 1.0 - 2.0 / a * (math.cosh(a) - math.cos(a)) / (math.sinh(a) + math.sin(a))


def planar_lambda(material: Material, constraint: float) -> float:
    """The planar lambda_p [Pa] that gives the bending modulus E_b = E / (1 - nu^2) (1 - nu^2 (1 - constraint)).

    From E_b = 4 mu (lambda_p + mu) / (lambda_p + 2 mu). Constraint 1 gives lambda, 0 gives plane stress.
    """
    if not 0.0 <= constraint <= 1.0:
        raise InputError("transverse constraint", constraint, "must lie in 0..1", "0 is plane stress, 1 plane strain")
    nu, mu = material.poisson_ratio, material.lame_mu
    modulus = material.young_modulus * (1.0 - nu**2 * (1.0 - constraint)) / (1.0 - nu**2)
    return 2.0 * mu * (modulus - 2.0 * mu) / (4.0 * mu - modulus)
