"""Hyperelastic laws in total Lagrangian form, in UFL.

Both laws agree with isotropic linear elasticity (lambda, mu) at small strain. E is the Green-Lagrange strain,
C = F^T F, J = det F. Verified by tests/verification/test_fe_patch.py.
"""

from __future__ import annotations

from enum import StrEnum

from reference_fe.dolfinx_api import Expr, ufl

__all__ = [
    "SMALLEST_STRETCH",
    "MaterialLaw",
    "deformation_gradient",
    "green_lagrange",
    "linearised_strain",
    "second_piola_kirchhoff",
    "stress_increment",
    "von_mises_cauchy",
]


class MaterialLaw(StrEnum):
    """Choice of the stored energy."""

    ST_VENANT_KIRCHHOFF = "st_venant_kirchhoff"
    """psi = lambda/2 tr(E)^2 + mu E:E (Bonet & Wood 2008, eq. 6.27)."""
    NEO_HOOKEAN = "neo_hookean"
    """psi = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2 (Bonet & Wood 2008, eq. 6.29)."""


SMALLEST_STRETCH = 3.0**-0.5
"""Principal stretch [-] below which St. Venant-Kirchhoff material softens in uniaxial compression: P = E l (l^2 - 1)/2
is smallest at l = 1/sqrt(3). Equilibria beyond are spurious."""


def deformation_gradient(u: Expr) -> Expr:
    """F = I + grad u [-]."""
    return ufl.Identity(3) + ufl.grad(u)


def green_lagrange(u: Expr) -> Expr:
    """E = (F^T F - I)/2 [-]."""
    H = ufl.grad(u)
    return 0.5 * (H + H.T + H.T * H)


def linearised_strain(u: Expr, du: Expr) -> Expr:
    """DE(u)[du] = sym(F^T grad du) [-]."""
    return ufl.sym(deformation_gradient(u).T * ufl.grad(du))


def second_piola_kirchhoff(law: MaterialLaw, u: Expr, lame: tuple[Expr, Expr]) -> Expr:
    """Second Piola-Kirchhoff stress S = d psi / d E [Pa]; ``lame`` = (lambda, mu) [Pa]."""
    lam, mu = lame
    eye = ufl.Identity(3)
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        E = green_lagrange(u)
        return lam * ufl.tr(E) * eye + 2.0 * mu * E
    F = deformation_gradient(u)
    C_inv = ufl.inv(F.T * F)
    return mu * (eye - C_inv) + lam * ufl.ln(ufl.det(F)) * C_inv


def stress_increment(law: MaterialLaw, u: Expr, du: Expr, lame: tuple[Expr, Expr]) -> Expr:
    """Material part of the linearised stress, CC(u) : DE(u)[du] [Pa]."""
    lam, mu = lame
    dE = linearised_strain(u, du)
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        return lam * ufl.tr(dE) * ufl.Identity(3) + 2.0 * mu * dE
    F = deformation_gradient(u)
    C_inv = ufl.inv(F.T * F)
    mixed = C_inv * dE * C_inv
    return lam * ufl.inner(C_inv, dE) * C_inv + 2.0 * (mu - lam * ufl.ln(ufl.det(F))) * mixed


def von_mises_cauchy(law: MaterialLaw, u: Expr, lame: tuple[Expr, Expr]) -> Expr:
    """Von Mises equivalent of the Cauchy stress sigma = F S F^T / J [Pa]."""
    F = deformation_gradient(u)
    sigma = F * second_piola_kirchhoff(law, u, lame) * F.T / ufl.det(F)
    deviator = ufl.dev(sigma)
    return ufl.sqrt(1.5 * ufl.inner(deviator, deviator))
