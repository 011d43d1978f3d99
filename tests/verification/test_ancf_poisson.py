"""Claim: with Poisson locking relieved, a narrow cantilever of nu = 0.33 bends as beam theory says, to 0.3 %.

1 N at the tip: P L^3 / (3 E I) = 17.99 mm. Source: contracts/published/README.md (the element as it is locks in
thickness, about 12 %); the model is ancf_reduced/verification/narrow_cantilever.py, linear, its section free to curve
across the width. Also: the plate held flat across its width bends with E / (1 - nu^2). Convergence over 8, 16, 32
plates. Negative control: the element as it is.
"""

from __future__ import annotations

import functools

import pytest

from ancf_reduced.plates.model import PoissonLocking
from ancf_reduced.verification.narrow_cantilever import bent_cantilever

bent = functools.cache(bent_cantilever)


def test_narrow_plate_bends_as_a_beam() -> None:
    relieved = bent(0.33, PoissonLocking.RELIEVED)
    assert relieved.expected == pytest.approx(17.99e-3, rel=3e-4)
    assert relieved.ratio == pytest.approx(1.0, rel=3e-3)
    assert bent(0.0, PoissonLocking.AS_IS).ratio == pytest.approx(1.0, rel=3e-3)


def test_plate_held_flat_bends_with_the_plate_modulus() -> None:
    flat = bent(0.33, PoissonLocking.RELIEVED, held_flat=True)
    assert flat.ratio == pytest.approx(1.0, rel=3e-3)
    assert flat.expected == pytest.approx((1.0 - 0.33**2) * 17.99e-3, rel=3e-4)


def test_relieved_element_converges() -> None:
    errors = [abs(bent(0.33, PoissonLocking.RELIEVED, n).ratio - 1.0) for n in (8, 16, 32)]
    assert errors[0] > errors[1] > errors[2]


def test_the_element_as_it_is_locks() -> None:
    """Negative control: about 12 % too stiff however fine the mesh, held flat even more."""
    assert 0.80 < bent(0.33, PoissonLocking.AS_IS).ratio < 0.95
    assert bent(0.33, PoissonLocking.AS_IS, held_flat=True).ratio < 0.8
