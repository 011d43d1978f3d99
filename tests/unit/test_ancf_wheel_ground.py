"""ANCF wheel on ground of any shape: first touch, derivatives, symmetry, a step's and a rock's pieces."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.wheel.ground import GroundContact, ground_frame
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround, press
from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import Plane, Terrain
from contracts.terrain_ridges import Cleat, HalfRound, Step
from geometry.wheel import exomars_hoops

Array = NDArray[np.float64]
PENALTY = 1e11


def small(*, half_width: bool = False) -> AncfWheel:
    """Three hoops, no grousers."""
    hoops = exomars_hoops()
    inner = replace(hoops.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    design = replace(hoops, grousers=None, spring_sets=(inner,), tire=replace(hoops.tire, thickness=1e-3))
    return build_ancf_wheel(design, element_size=40e-3, axial_size=60e-3, half_width=half_width, ground_spacing=0.3e-3)


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    return small()


def _touch(wheel: AncfWheel, terrain: Terrain, camber: float = 0.0) -> float:
    contact = GroundContact(wheel, terrain, ground_frame(0.0, camber), PENALTY)
    return contact._touch


def test_the_ground_first_touches_where_geometry_says(wheel: AncfWheel) -> None:
    """A plane at the radius, a rock's crown there too, a plane's edge under camber further; within points' distance."""
    tire = exomars_hoops().tire
    radius, half = tire.outer_radius, 0.5 * tire.width
    sagitta = 0.15e-3**2 / (2.0 * radius)
    for terrain in (Plane(), HalfRound(radius=20e-3, base=-20e-3)):
        assert _touch(wheel, terrain) == pytest.approx(-radius, abs=2.0 * sagitta + 15e-6)
    assert _touch(wheel, Plane(offset=-0.3)) == pytest.approx(0.3 - radius, abs=2.0 * sagitta)
    edge = radius * math.cos(0.1) + half * math.sin(0.1)
    outermost = 0.5 * 0.139 * half * math.sin(0.1)  # the outermost of four Gauss points in each half of the width
    assert _touch(wheel, Plane(), camber=0.1) == pytest.approx(-edge, abs=outermost)


def test_forces_and_tangents_are_derivatives_of_the_grounds_energy(wheel: AncfWheel) -> None:
    """On a rock askew beside a step under camber: gaps' slopes, and what forces add, by differences."""
    rock = HalfRound(radius=30e-3, base=-30e-3, position=4e-3, yaw=0.4)
    contact = GroundContact(wheel, rock, ground_frame(0.3, 0.05), PENALTY)
    random = np.random.default_rng(4)
    plates = wheel.plates
    q = plates.reference + 1e-4 * random.standard_normal(plates.reference.shape)
    direction = random.standard_normal(plates.reference.shape) * [[1e-2], [1.0], [1.0], [1e1]]
    none = np.zeros((len(plates.plates), 16, 3, 16, 3))
    pose, step = contact.risen(8e-3), 1e-6
    held = np.zeros(contact.count)
    here = contact.near(q, pose, held, none)
    held[here.points] = random.random(len(here.points))

    def at(x: Array) -> tuple[dict[int, float], Array]:
        near = contact.near(x, pose, 0.0 * held, none)
        return dict(zip(near.points.tolist(), near.gaps.tolist(), strict=True)), -(near.slopes.T @ held[near.points])

    ahead, behind = at(q + step * direction), at(q - step * direction)
    assert set(ahead[0]) == set(behind[0]) == set(here.points.tolist())
    numeric = [(ahead[0][p] - behind[0][p]) / (2.0 * step) for p in here.points.tolist()]
    np.testing.assert_allclose(here.slopes @ direction.ravel(), numeric, rtol=1e-5, atol=1e-7)
    blocks = none.copy()
    contact.near(q, pose, held, blocks)
    change = (ahead[1] - behind[1]) / (2.0 * step)
    np.testing.assert_allclose(plates.assembled(blocks) @ direction.ravel(), change, atol=1e-5 * np.abs(change).max())


def test_the_load_is_the_energys_slope_on_a_rock_a_step_and_a_cleat(wheel: AncfWheel) -> None:
    """Forces of both pieces along the ground's normal: dW / dd within 1 %; less than on a plane."""
    loads = {}
    for name, terrain in {
        "plane": Plane(),
        "rock": HalfRound(radius=15e-3, base=-15e-3),
        "step": Step(rise=2e-3, edge_radius=1e-3, base=-2e-3),
        "cleat": Cleat(rise=10e-3, width=4e-3, edge_radius=1e-3, base=-10e-3),
    }.items():
        problem = WheelOnGround(wheel, 0.0, terrain=terrain)
        one, two, three = press(problem, [5.9e-3, 6e-3, 6.1e-3])
        assert two.load == pytest.approx((three.energy - one.energy) / 0.2e-3, rel=0.01)
        loads[name] = two.load
    assert loads["rock"] < loads["plane"]
    assert loads["step"] < loads["plane"]
    assert loads["cleat"] < loads["plane"]


def test_half_a_wheel_stands_on_symmetric_ground_alone() -> None:
    half = small(half_width=True)
    straight = HalfRound(radius=20e-3, base=-20e-3)
    with_half, with_all = (next(press(WheelOnGround(w, 0.0, terrain=straight), [3e-3])) for w in (half, small()))
    assert with_half.load == pytest.approx(with_all.load, rel=1e-6)
    uneven = HeightField(heights=np.zeros((4, 4)), spacing=(0.5, 0.5), origin=(-0.75, -0.75))
    for terrain, camber in ((replace(straight, yaw=0.2), 0.0), (Plane(), 0.1), (uneven, 0.0)):
        with pytest.raises(InputError, match="not symmetric"):
            WheelOnGround(half, 0.0, terrain=terrain, camber=camber)
    with pytest.raises(InputError, match="camber"):
        WheelOnGround(half, 0.0, camber=math.nan)


def test_cambered_ground_is_mirrored_by_the_other_camber(wheel: AncfWheel) -> None:
    one, other = (next(press(WheelOnGround(wheel, 0.0, camber=c), [4e-3])) for c in (0.06, -0.06))
    flat = next(press(WheelOnGround(wheel, 0.0), [4e-3]))
    assert one.load == pytest.approx(other.load, rel=1e-6)
    assert one.load < 0.9 * flat.load
