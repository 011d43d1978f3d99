"""What the thesis' coarse mesh costs: geometry and load against the number of plates.

Claim 1: the unloaded outer face lies t/2 (1 - cos(alpha/2)) inside the nominal circle at mid-element, 3.66 mm for four
plates and t = 25 mm, falling at order 2. Source: bilinear interpolation of unit directors alpha apart (project theory
notes, section 1: 3.7 mm). Tolerance: 1e-6 relative for the formula. Negative control: unit tangents, which pull the
mid-surface in as well.

Claim 2 (finding): between spokes the load of the 4-plate rim is more than three times that of 16 plates at 20 mm (one
element per 90 deg locks), and spoke down it is a quarter too high. Source: computed here. It is no limit value: one
plate per spoke still locks, and plates shorter than thick soften the corners (tests/verification/test_ancf_arch.py).
"""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import refined_preset, thesis_preset
from ancf_reduced.tire.static import solve_tire
from ancf_reduced.tire.surfaces import outer_face_error

COUNTS = (4, 8, 12, 16)


def _shrinkage(plates: int) -> float:
    return float(0.5 * thesis_preset().rim_thickness * (1.0 - np.cos(np.pi / plates)))


@pytest.mark.parametrize("plates", COUNTS)
def test_outer_face_lies_inside_the_circle_by_the_directors_shrinkage(plates: int) -> None:
    assert outer_face_error(build_tire(refined_preset(thesis_preset(), plates))) == pytest.approx(
        _shrinkage(plates), rel=1e-6
    )


def test_four_plates_lie_3_7_mm_inside_and_converge_at_order_two() -> None:
    errors = np.array([outer_face_error(build_tire(refined_preset(thesis_preset(), n))) for n in (4, 8, 16)])
    assert errors[0] == pytest.approx(3.7e-3, abs=0.05e-3)
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2.0, atol=0.1)


def test_unit_tangents_are_caught() -> None:
    """Negative control: the mid-surface then lies 2 mm further in."""
    error = outer_face_error(build_tire(thesis_preset(), tangent_length=lambda angle: 1.0))
    assert error > _shrinkage(4) + 1.5e-3


def test_four_plates_are_far_from_converged() -> None:
    loads = {
        n: [solve_tire(build_tire(refined_preset(thesis_preset(), n)), phi, [0.02]).load[0] for phi in (0.0, np.pi / 4)]
        for n in COUNTS
    }
    down, between = np.array([loads[n] for n in COUNTS]).T
    assert np.all(np.diff(down) < 0.0)
    assert np.all(np.diff(between) < 0.0)
    assert 1.2 < down[0] / down[-1] < 1.4
    assert between[0] / between[-1] > 3.0
