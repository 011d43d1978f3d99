"""Self-weight cantilever plate: flat plates, gravity and large rotation, away from the tire.

Claim: 500 x 500 x 1 mm, E = 177 GPa, nu = 0, density 7800 kg/m^3, g = 9.81 m/s^2, clamped along one edge: the tip
drops 40.3175 mm and moves to x = 498.138 mm. Source: elastica, in contracts/published/README.md (Liu, Tian, Hu 2011
give 40.3 mm from a commercial code). Tolerance: 0.15 % with 32 plates, and convergence at order 2 or more on 8, 16, 32
plates (cubic position, linear director). Negative control: E 1 % low.
"""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.equilibrium import NewtonControls, newton_solve
from ancf_reduced.plate_mass import gravity_force
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import build_plate_model

DROP, TIP_X = 40.3175e-3, 498.138e-3
X, Y, Z = np.eye(3)


def _tip(plates: int, young_modulus: float = 177e9) -> tuple[float, float]:
    """Tip drop and tip x [m] of a strip of plates clamped at x = 0, load in five steps."""
    patches = [flat_patch(i * 0.5 / plates * X, 0.5 / plates * X, 0.5 * Y, 1e-3, "plate") for i in range(plates)]
    model = build_plate_model(build_plate_mesh(patches), young_modulus=young_modulus, poisson_ratio=0.0, density=7800.0)
    points, p = model.mesh.points, model.mesh.reference_coordinates()
    free = np.flatnonzero(points[:, 0] > 1e-9)
    rows = (12 * free[:, None] + np.arange(12)).ravel()
    weight = gravity_force(model, -9.81 * Z)

    def full(x: np.ndarray) -> np.ndarray:
        q = model.mesh.reference_coordinates()
        q[free] = x.reshape(-1, 4, 3)
        return q

    def residual(x: np.ndarray, factor: float) -> tuple[np.ndarray, float]:
        return (model.elastic_force(full(x)) - factor * weight).ravel()[rows], float(np.abs(weight).max())

    x, controls = p[free].ravel(), NewtonControls(tolerance=2e-5, max_iterations=50)  # round-off of E t against E t^3
    for factor in (0.2, 0.4, 0.6, 0.8, 1.0):
        result = newton_solve(
            lambda y, factor=factor: residual(y, factor),  # type: ignore[misc]
            lambda y: model.elastic_tangent(full(y))[np.ix_(rows, rows)],
            x,
            controls,
        )
        assert result.converged
        x = result.x
    tip = full(x)[int(np.argmax(points[:, 0])), 0]
    return -float(tip[2]), float(tip[0])


def test_tip_converges_to_the_elastica() -> None:
    tips = [_tip(n) for n in (8, 16, 32)]
    errors = [abs(drop / DROP - 1.0) for drop, _ in tips]
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert errors[-1] < 1.5e-3
    assert orders.min() > 2.0
    assert tips[-1][1] == pytest.approx(TIP_X, abs=1e-5)


def test_softer_plate_is_caught() -> None:
    """Negative control: E 1 % low must break the 0.15 % tolerance."""
    assert abs(_tip(32, young_modulus=175.2e9)[0] / DROP - 1.0) > 1.5e-3
