"""Claim: ANCF plates follow the cantilever benchmarks, end shear and end moment (rolled up), and converge to them.

Source: Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569, sections 3.1 and 3.2: contracts/published/sze31 for
the shear (three decimals), the exact circle for the moment; the model is ancf_reduced/verification/cantilever.py.
Tolerances: 0.1 % of the length along the path with 32 plates for the shear, 0.5 % with 48 for the moment; orders
between the two coarsest meshes at least 2.5 (measured 3.2 and 3.9: the error is that of locking in the deformed, curved
plates). Negative controls: 2 % of thickness; a moment that keeps its direction.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ancf_reduced.verification.cantilever import THICKNESS, cantilever_path, cantilever_table
from contracts.published import published_table

path = functools.cache(cantilever_path)


def test_exact_circle_is_that_of_the_published_table() -> None:
    table, circle = published_table("sze32_cantilever_end_moment"), cantilever_table("moment")
    np.testing.assert_allclose(circle[1:, 1], table["minus_U_tip_exact"][1:], rtol=0.0, atol=6e-4)
    np.testing.assert_allclose(circle[1:, 2], table["W_tip_exact"][1:], rtol=0.0, atol=6e-4)


def test_end_shear_follows_the_table_and_converges() -> None:
    errors = [path("shear", n).error for n in (8, 16, 32)]
    assert errors[2] < 1e-3
    assert np.log2(errors[0] / errors[1]) > 2.5


@pytest.mark.slow
def test_end_moment_follows_the_circle_and_converges() -> None:
    errors = [path("moment", n).error for n in (24, 48)]
    assert errors[1] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 2.5


def test_a_thicker_strip_is_caught() -> None:
    """Negative control: 2 % of thickness is 6 % of bending stiffness, against 2 % more force."""
    assert path("shear", 32, thickness=1.02 * THICKNESS).error > 5e-3


def test_a_moment_that_keeps_its_direction_is_caught() -> None:
    """Negative control: it cannot roll the strip up; a quarter of the way it is already far from the circle."""
    assert path("moment", 24, (0.05, 0.1, 0.15, 0.2, 0.25), follows=False).error > 0.05
