"""One ANCF plate against exact reference matrices.

Claim: mass, gravity and elastic force of thesis eq. 2.13 equal the reference within 1e-10 relative to the largest
entry. Source: contracts/published/ancf_plate_*.csv (exact quadrature; agrees with Project Chrono's published 3443
element to 1e-11); the model is ancf_reduced/verification/plate_matrices.py. Tolerance: the references carry 12 or more
digits, and 8 x 8 x 4 Gauss points are exact for this polynomial; 1e-10 is the room left for round-off. Negative
control: one flipped sign in one shape function of eq. 2.13.
"""

from __future__ import annotations

from dataclasses import astuple

import numpy as np
import pytest

from ancf_reduced.plates.shape_functions import PlateShape, plate_shape, plate_shape_gradient
from ancf_reduced.verification.plate_matrices import misread_shape, plate_errors, reference_plate
from contracts.errors import MeshError

TOLERANCE = 1e-10


def test_plate_matches_the_reference() -> None:
    """Mass, gravity and elastic force."""
    errors = astuple(plate_errors())
    assert len(errors) == 3
    assert max(errors) < TOLERANCE


def test_misread_sign_is_caught() -> None:
    """Negative control: each of the three must fail, and by far."""
    assert min(astuple(plate_errors(shape=misread_shape()))) > 1e4 * TOLERANCE


@pytest.mark.parametrize("index", range(1, 16))  # s_1 belongs to the origin: turned, it moves nothing
def test_function_of_wrong_sign_cannot_even_build(index: int) -> None:
    """A whole shape function turned makes the reference configuration fold over: det J0 <= 0 stops it."""
    sign = np.where(np.arange(16) == index, -1.0, 1.0)
    turned = PlateShape(
        value=lambda x, d: sign * plate_shape(x, d), gradient=lambda x, d: sign * plate_shape_gradient(x, d)
    )
    with pytest.raises(MeshError, match="det J0"):
        reference_plate(shape=turned)


@pytest.mark.parametrize(
    ("quadrature", "published"), [((2, 2, 2), 0.14), ((3, 3, 2), 3.3e-3), ((4, 4, 2), 5e-7), ((5, 5, 2), 3e-10)]
)
def test_gauss_orders_have_their_published_errors(quadrature: tuple[int, int, int], published: float) -> None:
    """Source: contracts/published/README.md; one digit is printed, so within a factor of two."""
    assert published / 2 < plate_errors(quadrature).elastic_force < 2 * published
