"""Hyperelastic laws in total Lagrangian form, in UFL.

Both laws agree with isotropic linear elasticity (lambda, mu) at small strain. E is the Green-Lagrange strain,
C = F^T F, J = det F. In two dimensions u, F, E and S are the parts in the plane and ``lame`` the planar constants
(`reference_fe.material.plane_state`).

Free thermal expansion by the stretch theta: F = F_e theta, and the energy per volume at 20 C is theta^3 psi(F_e), so
that S = theta S_0(C_e) with C_e = C/theta^2 and S_0 the law without expansion (multiplicative split; Lu & Pister, Int.
J. Solids Struct. 11, 1975). For St. Venant-Kirchhoff this is S = [lambda tr(E - E_th) I + 2 mu (E - E_th)]/theta with
E_th = (theta^2 - 1)/2 I: the additive form S_0(E - E_th) but for the factor 1/theta.

Verified by tests/verification/test_fe_patch.py and tests/verification/test_fe_thermal.py.
"""

from __future__ import annotations

from enum import StrEnum

from reference_fe.dolfinx_api import Expr, ufl

__all__ = [
    "SMALLEST_STRETCH",
    "MaterialLaw",
    "cauchy_stress",
    "deformation_gradient",
    "green_lagrange",
    "linearised_strain",
    "second_piola_kirchhoff",
    "stored_energy_density",
    "stress_increment",
    "thermal_moduli",
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
    return _unit(u) + ufl.grad(u)


def green_lagrange(u: Expr) -> Expr:
    """E = (F^T F - I)/2 [-]."""
    H = ufl.grad(u)
    return 0.5 * (H + H.T + H.T * H)


def linearised_strain(u: Expr, du: Expr) -> Expr:
    """DE(u)[du] = sym(F^T grad du) [-]."""
    return ufl.sym(deformation_gradient(u).T * ufl.grad(du))


def second_piola_kirchhoff(law: MaterialLaw, u: Expr, lame: tuple[Expr, Expr], stretch: Expr = 1.0) -> Expr:
    """Second Piola-Kirchhoff stress S = d psi / d E [Pa]; ``lame`` = (lambda, mu) [Pa], ``stretch`` = theta [-]."""
    lam, mu = lame
    eye = _unit(u)
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        E = green_lagrange(u) - 0.5 * (stretch**2 - 1.0) * eye
        return (lam * ufl.tr(E) * eye + 2.0 * mu * E) / stretch
    F = deformation_gradient(u) / stretch
    C_inv = ufl.inv(F.T * F)
    return stretch * (mu * (eye - C_inv) + lam * ufl.ln(ufl.det(F)) * C_inv)


def stored_energy_density(law: MaterialLaw, u: Expr, lame: tuple[Expr, Expr], stretch: Expr = 1.0) -> Expr:
    """Energy per undeformed volume theta^3 psi(F/theta) [J/m^3]."""
    lam, mu = lame
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        E = (green_lagrange(u) - 0.5 * (stretch**2 - 1.0) * _unit(u)) / stretch**2
        return stretch**3 * (0.5 * lam * ufl.tr(E) ** 2 + mu * ufl.inner(E, E))
    F = deformation_gradient(u) / stretch
    log_volume = ufl.ln(ufl.det(F))
    return stretch**3 * (0.5 * mu * (ufl.tr(F.T * F) - 3.0) - mu * log_volume + 0.5 * lam * log_volume**2)


def stress_increment(law: MaterialLaw, u: Expr, du: Expr, lame: tuple[Expr, Expr], stretch: Expr = 1.0) -> Expr:
    """Material part of the linearised stress, CC(u) : DE(u)[du] [Pa]."""
    lam, mu = lame
    dE = linearised_strain(u, du) / stretch
    if law is MaterialLaw.ST_VENANT_KIRCHHOFF:
        return lam * ufl.tr(dE) * _unit(u) + 2.0 * mu * dE
    F = deformation_gradient(u) / stretch
    C_inv = ufl.inv(F.T * F)
    mixed = C_inv * dE * C_inv
    return lam * ufl.inner(C_inv, dE) * C_inv + 2.0 * (mu - lam * ufl.ln(ufl.det(F))) * mixed


def thermal_moduli(lam: float, mu: float, stretch: float) -> tuple[float, float, float]:
    """St. Venant-Kirchhoff with expansion as S = lambda' tr(E) I + 2 mu' E + s I: lambda', mu', s [Pa]."""
    offset = -(3.0 * lam + 2.0 * mu) * 0.5 * (stretch**2 - 1.0)
    return lam / stretch, mu / stretch, offset / stretch


def cauchy_stress(
    law: MaterialLaw, u: Expr, lame: tuple[Expr, Expr], stretch: Expr = 1.0, transverse: Expr = None
) -> Expr:
    """Cauchy stress sigma = F S F^T / J [Pa], 3 x 3.

    In two dimensions ``transverse`` is the strain across the plane over the trace of that in it [-], both without
    thermal strain, which gives the third row: with E = E_th + E_e, E_e33 = transverse tr(E_e) and the planar lambda,
    S_33 = (lambda tr(E_e) + 2 mu E_e33) / theta and F_33 = sqrt(theta^2 + 2 E_e33).
    """
    F, S = deformation_gradient(u), second_piola_kirchhoff(law, u, lame, stretch)
    if transverse is not None:
        trace = ufl.tr(green_lagrange(u)) - (stretch**2 - 1.0)
        F = _with_third(F, ufl.sqrt(stretch**2 + 2.0 * transverse * trace))
        S = _with_third(S, (lame[0] + 2.0 * lame[1] * transverse) * trace / stretch)
    return F * S * F.T / ufl.det(F)


def _unit(u: Expr) -> Expr:
    """Unit tensor of the dimension of u."""
    return ufl.Identity(u.ufl_shape[0])


def _with_third(A: Expr, value: Expr) -> Expr:
    """The 3 x 3 tensor with a planar tensor and the value across the plane."""
    return ufl.as_matrix([[A[0, 0], A[0, 1], 0.0], [A[1, 0], A[1, 1], 0.0], [0.0, 0.0, value]])
