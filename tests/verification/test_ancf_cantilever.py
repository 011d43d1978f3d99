"""Self-weight cantilever plate: flat plates, gravity and large rotation, away from the tire.

Claim: 500 x 500 x 1 mm under its own weight, clamped along one edge: the tip drops 40.3175 mm and moves to
x = 498.138 mm. Source: elastica, in contracts/published/README.md; the model is
ancf_reduced/verification/self_weight.py. Tolerance: 0.15 % with 32 plates, and convergence at order 2 or more on 8, 16,
32 plates (cubic position, linear director). Negative control: E 1 % low.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ancf_reduced.verification.self_weight import TIP_X, hanging_plate

hang = functools.cache(hanging_plate)


def test_tip_converges_to_the_elastica() -> None:
    plates = [hang(n) for n in (8, 16, 32)]
    errors = np.array([plate.error for plate in plates])
    assert errors[-1] < 1.5e-3
    assert np.log2(errors[:-1] / errors[1:]).min() > 2.0
    assert plates[-1].tip_x == pytest.approx(TIP_X, abs=1e-5)


def test_softer_plate_is_caught() -> None:
    """Negative control: E 1 % low must break the 0.15 % tolerance."""
    assert hang(32, young_modulus=175.2e9).error > 1.5e-3
