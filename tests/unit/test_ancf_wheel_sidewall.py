"""Sidewall springs of an ANCF wheel: their surface, clamp, weld and halves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.planar import planar
from ancf_reduced.wheel.springs import sidewall_surface
from ancf_reduced.wheel.static import Equilibrium, WheelOnGround, press
from contracts.errors import InputError
from geometry.build import build_mesh, mesh_size
from geometry.parts import HubRing, Tire
from geometry.sidewall import SidewallSprings
from geometry.sidewall_mesh import elements_along
from geometry.wheel import WheelDesign

Array = NDArray[np.float64]
SIZES: dict[str, Any] = {"element_size": 14e-3, "axial_size": 20e-3}
SPRINGS = SidewallSprings(
    name="springs",
    count=8,
    width=19e-3,
    thickness=0.4e-3,
    curl_radius=5e-3,
    arc_radius=27.5e-3,
    sweep=math.radians(136.0),
    weld_length=20e-3,
    clamp_length=3e-3,
)


def design() -> WheelDesign:
    return WheelDesign(
        name="sidewall",
        tire=Tire(outer_radius=90e-3, width=70e-3, thickness=0.4e-3),
        grousers=None,
        spring_sets=(),
        sidewall_springs=SPRINGS,
        outer_hub=HubRing(outer_radius=17e-3, thickness=2e-3, width=80e-3),
        cone=None,
        impact_springs=None,
        inner_hub=None,
    )


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    return build_ancf_wheel(design(), **SIZES)


def _springs(wheel: AncfWheel) -> NDArray[np.int64]:
    return np.unique(wheel.plates.plates[wheel.parts == "springs"])


def _clamped(wheel: AncfWheel) -> NDArray[np.int64]:
    """Nodes of the strips' last edges: those nearest to the axle."""
    nodes = _springs(wheel)
    radius = np.hypot(*wheel.plates.reference[nodes, 0][:, [0, 2]].T)
    return nodes[radius < radius.min() + 2e-3]


def test_slopes_are_the_surfaces() -> None:
    """r_1, r_2 and r_12 against differences of r, on curl, arc and both sides of where they meet."""
    inner, edge, step = 89.6e-3, 35e-3, 1e-6
    middle = inner - 0.5 * SPRINGS.thickness
    meet = math.pi * SPRINGS.curl_radius
    at = np.array([0.1 * meet, 0.5 * meet, 0.99 * meet, 1.01 * meet, 2.0 * meet, 0.99 * SPRINGS.free_length])
    angles = np.linspace(-0.1, 0.1, 5)

    def r(by: float, across: float) -> Array:
        return sidewall_surface(SPRINGS, inner, edge, at + by, angles + across / middle)[:, :, 0]

    found = sidewall_surface(SPRINGS, inner, edge, at, angles)
    first = (r(step, 0.0) - r(-step, 0.0)) / (2.0 * step)
    second = (r(0.0, step) - r(0.0, -step)) / (2.0 * step)
    np.testing.assert_allclose(found[:, :, 1], first, atol=1e-7)
    np.testing.assert_allclose(found[:, :, 2], second, atol=1e-7)
    wide = 10.0 * step
    both = (r(wide, wide) - r(wide, -wide) - r(-wide, wide) + r(-wide, -wide)) / (4.0 * wide**2)
    np.testing.assert_allclose(found[:, :, 3], both, atol=1e-4 * np.abs(both).max())


def test_their_nodes_are_the_solids(wheel: AncfWheel) -> None:
    """Every node lies on one of the middle layer of the solid mesh: same surface, divided alike."""
    mesh = build_mesh(design(), **SIZES, order=1, parts="flexible", thickness_elements=2)
    inside = np.unique(mesh.cells[mesh.cell_tags == mesh.parts["springs"]])
    distance, _ = cKDTree(mesh.points[inside]).query(wheel.plates.reference[_springs(wheel), 0])
    assert distance.max() < 1e-9
    curl, arc, _ = elements_along(SPRINGS, mesh_size(design(), 14e-3, 20e-3, 1, None))
    across = len(_clamped(wheel)) // SPRINGS.count
    assert len(_springs(wheel)) == SPRINGS.count * (curl + arc + 1) * across


def test_they_leave_the_rim_at_its_edge(wheel: AncfWheel) -> None:
    reference = wheel.plates.reference
    first = reference[wheel.plates.plates[wheel.ties.spring][:, :2].ravel()]
    radius = np.hypot(first[:, 0, 0], first[:, 0, 2])
    inner = design().tire.inner_radius
    np.testing.assert_allclose(first[:, 0, 1], 35e-3, atol=1e-12)
    np.testing.assert_allclose(radius, inner - 0.5 * SPRINGS.thickness, rtol=1e-12)
    np.testing.assert_allclose(first[:, 1, [0, 2]], 0.0, atol=1e-12)
    assert first[:, 1, 1].min() > 0.0
    assert wheel.ties.offset.max() == pytest.approx(0.5 * (design().tire.thickness + SPRINGS.thickness))


def test_the_clamp_holds_places_and_slopes(wheel: AncfWheel) -> None:
    """Whatever the free coordinates are: last edges keep their places and their tangent plane, not their lengths."""
    random = np.random.default_rng(5).standard_normal(wheel.basis.shape[1])
    q = wheel.coordinates(1e-2 * random)
    nodes = _clamped(wheel)
    assert len(nodes) % SPRINGS.count == 0
    reference, moved = wheel.plates.reference[nodes], q[nodes]
    np.testing.assert_allclose(moved[:, [0, 2]], reference[:, [0, 2]], atol=1e-12)
    normal = np.cross(reference[:, 1], reference[:, 2])
    for slot in (1, 3):
        out = np.einsum("ki,ki->k", moved[:, slot] - reference[:, slot], normal)
        np.testing.assert_allclose(out, 0.0, atol=1e-12)
    assert np.abs(moved[:, 1] - reference[:, 1]).max() > 1e-4


@pytest.fixture(scope="module")
def pressed(wheel: AncfWheel) -> list[Equilibrium]:
    return list(press(WheelOnGround(wheel, 11.25), [1e-3, 2e-3, 3e-3]))


def test_half_and_whole_carry_the_same(wheel: AncfWheel, pressed: list[Equilibrium]) -> None:
    whole = build_ancf_wheel(design(), **SIZES, half_width=False)
    assert len(_clamped(whole)) == 2 * len(_clamped(wheel))
    assert whole.sides == 1.0
    state = next(press(WheelOnGround(whole, 11.25), [2e-3]))
    assert state.load == pytest.approx(pressed[1].load, rel=1e-6)


def test_it_stands_and_takes_few_steps(pressed: list[Equilibrium]) -> None:
    assert all(state.negative == 0 for state in pressed)
    assert max(state.iterations for state in pressed) <= 4
    assert 20.0 < pressed[1].load < 60.0


def test_there_is_no_planar_wheel(wheel: AncfWheel) -> None:
    with pytest.raises(InputError, match="sidewall springs"):
        planar(wheel)
