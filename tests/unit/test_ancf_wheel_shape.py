"""Distance of middle surfaces: nodes found on them, and how far a moved surface is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.shape import MiddleSurface
from contracts.errors import InputError
from geometry.wheel import exomars_hoops


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    hoops = exomars_hoops()
    inner = replace(hoops.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    design = replace(hoops, grousers=None, spring_sets=(inner,), tire=replace(hoops.tire, thickness=1e-3))
    return build_ancf_wheel(design, element_size=25e-3, axial_size=60e-3)


def ring(radius: float) -> np.ndarray:
    angle, y = np.meshgrid(np.linspace(0.0, 6.0, 40), np.linspace(5e-3, 55e-3, 5))
    return np.stack([radius * np.sin(angle), y, -radius * np.cos(angle)], axis=-1).reshape(-1, 3)


def test_nodes_on_the_surface_are_told_from_those_beside_it(wheel: AncfWheel) -> None:
    """The rim's middle has the radius 142 mm; nodes on its faces do not count."""
    nodes = np.concatenate([ring(142.0e-3), ring(142.5e-3), ring(141.5e-3)])
    surface = MiddleSurface(wheel, "tire", nodes)
    np.testing.assert_array_equal(surface.nodes, np.arange(200))


def test_a_lifted_surface_is_as_far_as_it_was_lifted_and_a_slid_one_is_not(wheel: AncfWheel) -> None:
    surface = MiddleSurface(wheel, "tire", ring(142.0e-3))
    lifted = surface.distances(wheel.plates.reference, ring(142.3e-3))
    np.testing.assert_allclose(lifted, 0.3e-3, rtol=2e-3)  # arcs of cubics
    turned = ring(142.0e-3) @ np.array(
        [[np.cos(0.1), 0.0, np.sin(0.1)], [0.0, 1.0, 0.0], [-np.sin(0.1), 0.0, np.cos(0.1)]]
    )
    assert surface.distances(wheel.plates.reference, turned).max() < 2e-6


def test_another_wheels_nodes_are_refused(wheel: AncfWheel) -> None:
    with pytest.raises(InputError, match="middle surface"):
        MiddleSurface(wheel, "tire", ring(150e-3))
