"""ANCF wheel: areas, welds, supports and the ground's points of its network."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ancf_reduced.wheel.joints import RIGID_RATIO, turning_stiffness
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from geometry.springs import spring_leg
from geometry.wheel import WheelDesign


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    return build_ancf_wheel(WheelDesign())


def _area(wheel: AncfWheel, part: str) -> float:
    return float(np.prod(wheel.plates.sizes[wheel.parts == part], axis=1).sum())


def test_rim_and_springs_have_their_area(wheel: AncfWheel) -> None:
    """Half of the wheel: half of the rim's cylinder, and of every leg its length times half of its bands."""
    design = WheelDesign()
    tire = design.tire
    middle = 0.5 * (tire.inner_radius + tire.outer_radius)
    assert _area(wheel, "tire") == pytest.approx(2.0 * math.pi * middle * 0.5 * tire.width, rel=1e-12)
    for springs in design.spring_sets:
        leg = spring_leg(springs, (design.outer_hub.outer_radius, tire.inner_radius), 0.0, springs.direction)
        width = 0.5 * sum(b - a for a, b in springs.bands)
        assert _area(wheel, springs.name) == pytest.approx(springs.count * leg.length * width, rel=1e-9)


def test_welds_and_grousers_are_layers_of_the_rim(wheel: AncfWheel) -> None:
    """Their areas and masses: count times length times width, at the layer's own radius."""
    design = WheelDesign()
    tire, fins = design.tire, design.grousers
    assert fins is not None
    middle = 0.5 * (tire.inner_radius + tire.outer_radius)
    for springs in design.spring_sets:
        welded = [
            wheel.plates.sizes[k].prod()
            for k in np.flatnonzero(wheel.parts == "tire")
            if any(layer.thickness == springs.thickness for layer in wheel.plates.layers[k][1:])
        ]
        width = 0.5 * sum(b - a for a, b in springs.bands)
        assert sum(welded) == pytest.approx(springs.count * springs.weld_length * middle / tire.inner_radius * width)
    heights = {layer.height for layers in wheel.plates.layers for layer in layers}
    assert -0.5 * (tire.thickness + fins.height) in heights


def test_springs_begin_at_the_rims_offset(wheel: AncfWheel) -> None:
    """Edge nodes of a spring's first plate lie at the tie's offset along the rim's normal."""
    plates, ties = wheel.plates, wheel.ties
    for spring, rim, offset in zip(ties.spring, ties.rim, ties.offset, strict=True):
        for corner in (0, 1):
            r, a, b, _ = plates.reference[plates.plates[rim, corner]]
            n = np.cross(a, b)
            foot = plates.reference[plates.plates[spring, corner]]
            np.testing.assert_allclose(foot[0], r + offset * n / np.linalg.norm(n), atol=1e-12)
            assert abs(foot[1] @ n) < 1e-9


def test_supports_hold_the_hub_and_the_mirror(wheel: AncfWheel) -> None:
    """No free coordinate moves an edge on the hub or breaks the mirror image at y = 0."""
    random = np.random.default_rng(3).standard_normal(wheel.basis.shape[1])
    q, reference = wheel.coordinates(random), wheel.plates.reference
    radius = np.hypot(reference[:, 0, 0], reference[:, 0, 2])
    hub = radius < WheelDesign().outer_hub.outer_radius + 1e-3
    np.testing.assert_allclose(q[hub, 0], reference[hub, 0])
    np.testing.assert_allclose(q[hub, 2], reference[hub, 2])
    middle = (np.abs(reference[:, 0, 1]) < 1e-12) & ~hub
    assert middle.any()
    np.testing.assert_allclose(q[middle, 0, 1], 0.0)
    np.testing.assert_allclose(q[middle, 2][:, [0, 2]], 0.0)


def test_the_hubs_welds_hold_edges_against_turning(wheel: AncfWheel) -> None:
    """Energy of all legs turned by a small angle about the axle: half of stiffness, width and its square."""
    design, angle = WheelDesign(), 1e-3
    reference = wheel.plates.reference
    radius = np.hypot(reference[:, 0, 0], reference[:, 0, 2])
    q = reference.copy()
    hub = radius < design.outer_hub.outer_radius + 1e-3
    q[hub, 1] += angle * reference[hub, 0] * [1.0, 0.0, 1.0] / radius[hub, None]
    free = np.asarray(wheel.basis.T @ (q - reference).ravel())  # columns are orthonormal
    np.testing.assert_allclose(wheel.coordinates(free), q, atol=1e-15)
    expected = 0.0
    for springs in design.spring_sets:
        width = springs.count * 0.5 * sum(b - a for a, b in springs.bands)
        expected += 0.5 * turning_stiffness(springs.material, springs.thickness, RIGID_RATIO) * width * angle**2
    assert 0.5 * free @ wheel.held @ free == pytest.approx(expected, rel=1e-9)


def test_the_grounds_points_lie_on_the_outer_face(wheel: AncfWheel) -> None:
    """Radii of outer face and tips; areas add up to both."""
    design, ground = WheelDesign(), wheel.ground
    fins = design.grousers
    assert fins is not None
    tips = ground.height < -fins.height
    assert ground.area[tips].sum() == pytest.approx(fins.count * fins.thickness * 0.5 * design.tire.width)
    half = math.asin(0.5 * fins.thickness / design.tire.outer_radius)
    rest = (2.0 * math.pi - fins.count * 2.0 * half) * design.tire.outer_radius * 0.5 * design.tire.width
    assert ground.area[~tips].sum() == pytest.approx(rest)
