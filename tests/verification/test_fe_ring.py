"""Claim: a thin elastic ring pressed between frictionless rigid plates follows the elastica to 60 % compression.

Source: contracts/published/ring_between_plates_elastica.csv (quadrature of the inextensible elastica). Tolerance 1 %:
the ring is 0.6 mm thick at R = 142.5 mm (t/R = 0.4 %), so that extension, shear and thickness together stay far below
it. Effort: at most 60 Newton iterations in all. The model is reference_fe/verification/ring_between_plates.py.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from contracts.errors import InputError
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.static_problem import Discretisation
from reference_fe.verification.ring_between_plates import (
    RADIUS,
    STRIP,
    THICKNESS,
    PressedRing,
    elastica,
    press,
    pressed_ring,
    quarter_ring,
)


@functools.cache
def reference_run() -> PressedRing:
    return pressed_ring()


def test_ring_follows_the_elastica() -> None:
    assert reference_run().error < 0.01


def test_ring_needs_few_newton_iterations() -> None:
    assert reference_run().iterations <= 60


def test_a_wrong_thickness_is_caught() -> None:
    """Negative control: one per cent of thickness is three per cent of bending stiffness."""
    assert pressed_ring(thickness=1.01 * THICKNESS).error > 0.02


def test_full_integration_locks_on_a_coarse_mesh() -> None:
    """Negative control of the quadrature: with three points along the arc, 12 elements are far too stiff."""
    reduced = pressed_ring(12, (0.1,))
    full = pressed_ring(12, (0.1,), discretisation=Discretisation(gauss_points=(3, 3, 3)))
    assert reduced.error < 0.01
    assert full.load[0] / full.elastica[0] - 1.0 > 0.2


def test_every_increment_balances() -> None:
    assert reference_run().imbalance < 1e-6
    assert reference_run().residual <= 1e-8


@pytest.mark.parametrize("law", list(MaterialLaw))
def test_plain_newton_finds_the_same_state(law: MaterialLaw) -> None:
    """The mixed integration points change the way, not the solution (Magisano et al. 2017): equal load to 1e-6."""
    mixed = press(quarter_ring(12, Discretisation(law=law)), (0.01,))
    plain = press(
        quarter_ring(12, Discretisation(law=law, mixed_integration_points=False)), (0.001, 0.004, 0.007, 0.01)
    )
    assert plain[-1].contact_force[2] == pytest.approx(mixed[-1].contact_force[2], rel=1e-6)


def test_a_flipped_normal_is_caught() -> None:
    """Negative control: a plane whose normal points away from the ring is refused before anything is solved."""
    with pytest.raises(InputError, match="normal pointing to the body"):
        quarter_ring(12, normal=(0.0, 0.0, -1.0))


def test_stress_is_that_of_bending() -> None:
    """At 10 % compression the elastica gives the curvatures; fibre stress = E t/2 times their change, to 2 %."""
    problem = quarter_ring(40)
    press(problem, (0.1,))
    table, ends = elastica(), ("kappa_contact", "kappa_equator")
    curvature = np.array([np.interp(0.1, table["compression_over_D"], table[end]) for end in ends])
    curvature_change = (curvature - 1.0) / RADIUS
    fibre_stress = STRIP.young_modulus * 0.5 * THICKNESS * np.abs(curvature_change)
    recovery = StressRecovery(problem)
    assert recovery.largest_by_part()["body"] == pytest.approx(fibre_stress.max(), rel=0.02)
    points, stress = problem.domain.tagged.points, recovery.nodal_von_mises()
    at_ends = [stress[np.abs(points[:, axis]) < 1e-9].max() for axis in (0, 2)]  # contact, and a quarter turn on
    np.testing.assert_allclose(at_ends, fibre_stress, rtol=0.03)
    principal, radius = recovery.nodal_principal_stress(), np.hypot(points[:, 0], points[:, 2])
    for axis, expected, flattened in zip((0, 2), fibre_stress, (True, False), strict=True):
        end = np.flatnonzero(np.abs(points[:, axis]) < 1e-9)
        pulled, pressed = end[principal[end, 0].argmax()], end[principal[end, 2].argmin()]
        stresses = principal[pulled, 0], -principal[pressed, 2]
        np.testing.assert_allclose(stresses, expected, rtol=0.03)
        assert bool(radius[pulled] < radius[pressed]) == flattened  # where it becomes straighter, the inside is pulled
