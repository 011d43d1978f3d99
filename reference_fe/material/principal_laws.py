"""Laws of material in principal directions of elastic stretch: Kirchhoff stress, its derivatives, energy, plastic flow.

With x_a = lambda_a^2 = 1 + e_a, eps_a = ln(x_a)/2 and dev eps_a = eps_a less the mean of the three, each law gives

    tau_a,     D_ab = d tau_a / d eps_b,     d_ab = (tau_b - tau_a) / (x_b - x_a),

all without loss of digits where stretches coincide: with r = (x_b - x_a)/x_a the differences are log1p(r)/(2 r) of
strains and expm1(alpha log1p(r)/2)/r of powers of stretches. Energies: `contracts.material_laws`; of the nearly
incompressible laws this is the isochoric part, of their volumetric part only tau = J p I, see
`material.point_response`.

    neo-Hookean (compressible)  tau_a = mu e_a + lambda ln J
    Ogden (Mooney-Rivlin: exponents 2, -2)  tau_a = sum_p mu_p (y_a - mean of y),   y_a = exp(alpha_p dev eps_a)
    J2 plasticity               tau_a = beta 2 mu dev eps_a,   beta = 1 - 2 mu dgamma / |2 mu dev eps|

J2: radial return in logarithmic strains (Simo, Comput. Methods Appl. Mech. Engrg. 99, 1992, 61-112; from memory) with
|tau| = sqrt(2/3) R(alpha + sqrt(2/3) dgamma) of the Kirchhoff stress; the derivative is that of the return itself.
Verified by tests/unit/test_fe_point_laws.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled

__all__ = ["J2", "NEO_HOOKEAN", "OGDEN", "plastic_work", "principal_stress"]

Array = NDArray[np.float64]
NEO_HOOKEAN, OGDEN, J2 = 0, 1, 2
"""Kinds; constants in this order: lambda, mu; mu_1, alpha_1, mu_2 ... (a zero mu_p is no term);
mu, R, hardening modulus, saturation stress, saturation rate."""
PAIRS = ((0, 1), (1, 2), (0, 2))
_TWO_THIRDS = np.sqrt(2.0 / 3.0)
_ROUND_OFF = 1e-9
"""Share of the yield stress by which a point must lie beyond it to flow: one that has just flowed lies on it."""
RETURN_LIMIT = 50
"""Iterations for the plastic multiplier; where the material hardens the function is convex and none fails."""


@compiled(error_model="numpy")
def principal_stress(
    kind: int, c: Array, e: Array, alpha: float, tau: Array, D: Array, d: Array, flow: Array
) -> tuple[float, float]:
    """Fill tau (3,), D (3, 3) and d (3,) [Pa], the pairs 01, 12, 02, and flow (3,) [-]; return (dalpha, energy).

    Parameters
    ----------
    c : constants of the law, see `OGDEN`
    e : (3,) squared stretch less 1 [-], of J2 that of the elastic trial state
    alpha : equivalent plastic strain so far [-]
    flow : takes dgamma n_a, plastic logarithmic strain of this step [-]

    Returns
    -------
    dalpha : equivalent plastic strain of this step [-]
    energy : elastic energy [J/m^3]
    """
    flow[:] = 0.0
    if kind == NEO_HOOKEAN:
        return 0.0, _neo_hookean(c, e, tau, D, d)
    if kind == OGDEN:
        return 0.0, _ogden(c, e, tau, D, d)
    return _j2(c, e, alpha, tau, D, d, flow)


@compiled(error_model="numpy")
def _neo_hookean(c: Array, e: Array, tau: Array, D: Array, d: Array) -> float:
    lam, mu = c[0], c[1]
    volume = 0.5 * (np.log1p(e[0]) + np.log1p(e[1]) + np.log1p(e[2]))
    for a in range(3):
        tau[a] = mu * e[a] + lam * volume
        d[a] = mu
        for b in range(3):
            D[a, b] = lam
        D[a, a] += 2.0 * mu * (1.0 + e[a])
    energy: float = 0.5 * mu * (e[0] + e[1] + e[2]) - mu * volume + 0.5 * lam * volume * volume
    return energy


@compiled(error_model="numpy")
def _ogden(c: Array, e: Array, tau: Array, D: Array, d: Array) -> float:
    strain, y = np.empty(3), np.empty(3)
    _deviatoric_strain(e, strain)
    tau[:], D[:], d[:] = 0.0, 0.0, 0.0
    energy = 0.0
    for p in range(c.shape[0] // 2):
        mu, exponent = c[2 * p], c[2 * p + 1]
        if mu == 0.0:
            continue
        excess = 0.0
        for a in range(3):
            excess += np.expm1(exponent * strain[a])
            y[a] = np.exp(exponent * strain[a])
        mean = 1.0 + excess / 3.0
        energy += mu / exponent * excess
        for a in range(3):
            tau[a] += mu * (np.expm1(exponent * strain[a]) - excess / 3.0)
            for b in range(3):
                D[a, b] += mu * exponent * (mean - y[a] - y[b]) / 3.0
            D[a, a] += mu * exponent * y[a]
        for k in range(3):
            a, b = PAIRS[k]
            r = (e[b] - e[a]) / (1.0 + e[a])
            share = 0.5 * exponent if r == 0.0 else np.expm1(0.5 * exponent * np.log1p(r)) / r
            d[k] += mu * y[a] * share / (1.0 + e[a])
    return energy


@compiled(error_model="numpy")
def _j2(c: Array, e: Array, alpha: float, tau: Array, D: Array, d: Array, flow: Array) -> tuple[float, float]:
    strain = np.empty(3)
    _deviatoric_strain(e, strain)
    twice = 2.0 * c[0]
    trial = twice * np.sqrt(strain[0] ** 2 + strain[1] ** 2 + strain[2] ** 2)
    multiplier, beta, rate = 0.0, 1.0, 0.0
    if trial > _TWO_THIRDS * yield_stress(c, alpha)[0] * (1.0 + _ROUND_OFF):
        multiplier, slope = _return_length(c, trial, alpha)
        beta = 1.0 - twice * multiplier / trial
        rate = 1.0 / (1.0 + slope / (3.0 * c[0])) - (1.0 - beta)
    square = 0.0
    for a in range(3):
        tau[a] = beta * twice * strain[a]
        square += (beta * strain[a]) ** 2
        for b in range(3):
            D[a, b] = -beta * twice / 3.0
            if multiplier > 0.0:
                D[a, b] -= rate * twice * (twice * strain[a] / trial) * (twice * strain[b] / trial)
        D[a, a] += beta * twice
        if multiplier > 0.0:
            flow[a] = multiplier * twice * strain[a] / trial
    for k in range(3):
        a, b = PAIRS[k]
        r = (e[b] - e[a]) / (1.0 + e[a])
        share = 0.5 if r == 0.0 else 0.5 * np.log1p(r) / r
        d[k] = beta * twice * share / (1.0 + e[a])
    return _TWO_THIRDS * multiplier, 0.5 * twice * square


@compiled(error_model="numpy")
def _deviatoric_strain(e: Array, strain: Array) -> None:
    """Logarithmic strains ln(1 + e)/2 less their mean, (3,) [-]."""
    for a in range(3):
        strain[a] = 0.5 * np.log1p(e[a])
    mean = (strain[0] + strain[1] + strain[2]) / 3.0
    for a in range(3):
        strain[a] -= mean


@compiled(error_model="numpy")
def _return_length(c: Array, trial: float, alpha: float) -> tuple[float, float]:
    """Plastic multiplier dgamma > 0 [-] and R' there [Pa], from |s_trial| [Pa]."""
    multiplier = 0.0
    for _ in range(RETURN_LIMIT):
        stress, slope = yield_stress(c, alpha + _TWO_THIRDS * multiplier)
        excess = trial - 2.0 * c[0] * multiplier - _TWO_THIRDS * stress
        step = excess / (2.0 * c[0] + 2.0 / 3.0 * slope)
        multiplier += step
        if abs(step) <= 1e-15 * multiplier:
            break
    return multiplier, yield_stress(c, alpha + _TWO_THIRDS * multiplier)[1]


@compiled(error_model="numpy")
def yield_stress(c: Array, alpha: float) -> tuple[float, float]:
    """R(alpha) and R'(alpha) [Pa], see `contracts.material_laws.J2Plasticity`."""
    gone = np.exp(-c[4] * alpha)
    beyond = c[3] - c[1]
    return c[1] + c[2] * alpha + beyond * (1.0 - gone), c[2] + c[4] * beyond * gone


@compiled(error_model="numpy")
def plastic_work(c: Array, alpha: float) -> float:
    """Integral of R over the equivalent plastic strain, 0 to alpha [J/m^3]: all work of plastic flow."""
    saturating = 0.0
    if c[4] > 0.0:
        saturating = (c[3] - c[1]) * (alpha + np.expm1(-c[4] * alpha) / c[4])
    work: float = c[1] * alpha + 0.5 * c[2] * alpha**2 + saturating
    return work
