"""Curved plates and shared-gradient joints against beam theory.

Claim 1: a 90 deg arch of rim plates (R = 130 mm, t = 25 mm, nu = 0), clamped at both ends, line load at its crown,
converges to the Timoshenko arch. Source: beams assembled in ancf_reduced/verification/arch.py, the model beside them.
Tolerance: 1.5 % at 32 plates: beam theory leaves out terms of order t/R squared, and the kink of slope under the line
load is spread over one plate. The differences between meshes fall at an order above 1.4 (the kink), on 8, 16, 32
plates. Negative control: 24 mm plates.

Claim 2 (a limitation found here): a corner of two plates that share 12 structure coordinates passes moments only by
shear strain of the plates next to the node, so its rotational stiffness falls in proportion to the plates' length.
Source: computed here, L of two 100 mm arms against beam theory with a rigid corner. Tolerance: order 1 +- 0.1.
"""

from __future__ import annotations

import numpy as np

from ancf_reduced.verification.arch import corner_stiffness, pressed_arch


def test_arch_converges_to_beam_theory() -> None:
    arches = [pressed_arch(n) for n in (8, 16, 32)]
    assert arches[-1].error < 0.015
    first, second, third = (arch.stiffness for arch in arches)
    assert np.log2((first - second) / (second - third)) > 1.4


def test_thinner_arch_is_caught() -> None:
    """Negative control: 24 mm plates must miss the 1.5 %."""
    assert pressed_arch(32, thickness=0.024).error > 0.015


def test_shared_gradients_make_a_corner_that_softens_with_the_mesh() -> None:
    stiffness = np.array([corner_stiffness(n) for n in (8, 16, 32)])
    np.testing.assert_allclose(np.log2(stiffness[:-1] / stiffness[1:]), 1.0, atol=0.1)
