"""An elastic hub of the ANCF wheel: areas, where edges are tied, derivatives, contact, what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.thin_plates.shape_functions import shape_tables
from ancf_reduced.wheel.hub import HUB, HUB_PARTS
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.planar import planar
from ancf_reduced.wheel.static import WheelOnGround, press
from ancf_reduced.wheel.stress import largest_spring_stress
from ancf_reduced.wheel.ties import Ties
from contracts.errors import InputError, MeshError
from geometry.springs import leg_sides, spring_leg
from geometry.wheel import WheelDesign, exomars

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    return build_ancf_wheel(exomars(), element_size=40e-3, axial_size=60e-3, hub="elastic")


def _area(wheel: AncfWheel, part: str) -> float:
    """Of a part's plates as their reference has it [m^2]."""
    at, weight = (0.5 * (x + 1.0) if k == 0 else 0.5 * x for k, x in enumerate(np.polynomial.legendre.leggauss(4)))
    places = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
    total = 0.0
    for k in np.flatnonzero(wheel.parts == part):
        local = wheel.plates.reference[wheel.plates.plates[k]].reshape(16, 3)
        a = np.einsum("pdk,ki->dpi", shape_tables(wheel.plates.sizes[k], *places.T)[:, 1:3], local)
        J = np.linalg.norm(np.cross(a[0], a[1]), axis=1)
        total += float(np.outer(weight, weight).ravel() @ J) * float(wheel.plates.sizes[k].prod())
    return total


def test_parts_of_the_hub_have_their_area(wheel: AncfWheel) -> None:
    """Half of the wheel: cylinder, frustum, semicircles."""
    design = exomars()
    hub, inner, cone, impact = design.outer_hub, design.inner_hub, design.cone, design.impact_springs
    assert inner is not None
    assert cone is not None
    assert impact is not None
    middle = hub.inner_radius + 0.5 * hub.thickness
    assert _area(wheel, HUB) == pytest.approx(math.pi * middle * hub.width, rel=1e-4)
    slant = math.hypot(hub.inner_radius - inner.outer_radius, cone.outer_position - cone.inner_position)
    assert _area(wheel, "cone") == pytest.approx(math.pi * (hub.inner_radius + inner.outer_radius) * slant, rel=1e-4)
    leg = spring_leg(impact, (inner.outer_radius, hub.inner_radius), 0.0, 1)
    width = 0.5 * sum(b - a for a, b in impact.bands)
    legs = impact.count * len(leg_sides(impact))
    assert _area(wheel, "impact_springs") == pytest.approx(legs * leg.length * width, rel=1e-4)


def test_edges_that_are_tied_amiss_are_told(wheel: AncfWheel) -> None:
    """An edge on the wall's other side, a millimetre off, and a cone whose angle is mirrored."""
    cone, ties = wheel.ties.leaving == 1, wheel.ties
    for changes in (
        {"offset": -ties.offset},
        {"ends": ties.ends + 0.05 * (cone[:, None, None])},
        {"square": np.where(cone[:, None], ties.square * [-1.0, 1.0], ties.square)},
    ):
        with pytest.raises(MeshError, match="off where they are tied"):
            Ties(wheel.plates, replace(ties, **changes))


def test_welds_lie_on_the_side_of_their_springs(wheel: AncfWheel) -> None:
    """Along the normal, which points inwards: springs on the rim's inside and the hub's outside, impact ones in it."""
    design = exomars()
    assert design.impact_springs is not None
    thin = {springs.thickness for springs in design.spring_sets}
    heights = {"tire": set[float](), HUB: set[float]()}
    for part, layers in zip(wheel.parts.tolist(), wheel.plates.layers, strict=True):
        if part in heights:
            heights[part] |= {np.sign(one.height) for one in layers[1:] if one.thickness in thin}
    assert heights == {"tire": {1.0}, HUB: {-1.0}}
    impact = [
        one.height
        for part, layers in zip(wheel.parts.tolist(), wheel.plates.layers, strict=True)
        for one in layers[1:]
        if part == HUB and one.thickness == design.impact_springs.thickness
    ]
    assert impact
    assert min(impact) > 0.0


def test_joints_are_at_rest(wheel: AncfWheel) -> None:
    """At rest neither ties have energy nor the held hub."""
    problem = WheelOnGround(wheel, 0.3, inner_contact_stiffness=0.0)
    rest = np.zeros(wheel.basis.shape[1])
    none = np.zeros(sum(problem.counts))
    system = problem.linearised(rest, problem.ground.risen(0.0), (*problem.extrapolated(rest, rest), none))
    assert system.energy < 1e-12
    assert np.abs(system.residual).max() < 1e-6


def test_residual_and_tangent_are_derivatives(wheel: AncfWheel) -> None:
    problem = WheelOnGround(wheel, 0.0, inner_contact_stiffness=0.0)
    random = np.random.default_rng(1)
    free, direction = (scale * random.standard_normal(wheel.basis.shape[1]) for scale in (1e-4, 1.0))
    none = np.zeros(sum(problem.counts))

    def at(x: Array) -> tuple[float, Array, Array]:
        pose = problem.ground.risen(0.0)
        found = problem.linearised(x, pose, (*problem.extrapolated(x, 0.0 * x), none))
        return found.energy, found.residual, found.tangent @ direction

    step = 1e-7
    (up, residual_up, _), (down, residual_down, _) = (at(free + k * step * direction) for k in (1.0, -1.0))
    _, residual, bent = at(free)
    assert (up - down) / (2.0 * step) == pytest.approx(residual @ direction, rel=1e-5)
    error = np.linalg.norm((residual_up - residual_down) / (2.0 * step) - bent) / np.linalg.norm(bent)
    assert error < 1e-5


def test_a_wheel_held_by_its_cone_alone_turns_where_the_joint_is_let_go() -> None:
    """The angle between cone and hub is held: a flat disc whose joint turns freely carries less."""
    design = replace(exomars(), impact_springs=None)
    assert design.cone is not None
    disc = replace(design.cone, outer_position=20e-3, inner_position=20e-3, thickness=0.5e-3)
    wheel = build_ancf_wheel(replace(design, cone=disc), element_size=40e-3, axial_size=60e-3, hub="elastic")
    along = wheel.ties.leaving == 1
    np.testing.assert_allclose(wheel.ties.square[along], [[0.0, -1.0]] * along.sum(), atol=1e-12)
    free = np.zeros_like(wheel.ties.turning)
    loose = replace(wheel, ties=replace(wheel.ties, turning=np.where(along, free, wheel.ties.turning)))
    loads = [next(iter(press(WheelOnGround(one, 0.0), [2e-3]))).load for one in (wheel, loose)]
    assert loads[1] < loads[0]


def test_both_halves_are_the_wheel(wheel: AncfWheel) -> None:
    """Both cones, the mirrored one too, where they belong: else `Ties` would tell."""
    whole = build_ancf_wheel(exomars(), element_size=40e-3, axial_size=60e-3, hub="elastic", half_width=False)
    for part in HUB_PARTS[1:]:
        assert (whole.parts == part).sum() == 2 * (wheel.parts == part).sum()
    loads = [next(iter(press(WheelOnGround(one, 0.0), [4e-3]))).load for one in (wheel, whole)]
    assert loads[1] == pytest.approx(loads[0], rel=2e-3)


def test_springs_lie_on_an_elastic_hub_as_on_a_rigid_one() -> None:
    """Hoops pressed until they touch the hub: force on it where nothing else differs much."""
    design = exomars()
    wheel = build_ancf_wheel(design, element_size=40e-3, axial_size=60e-3, hub="elastic")
    (*_, state) = press(WheelOnGround(wheel, 0.0), [10e-3, 20e-3, 30e-3, 40e-3, 50e-3])
    rigid = build_ancf_wheel(design, element_size=40e-3, axial_size=60e-3)
    (*_, other) = press(WheelOnGround(rigid, 0.0), [10e-3, 20e-3, 30e-3, 40e-3, 50e-3])
    assert state.load == pytest.approx(other.load, rel=0.01)
    assert set(largest_spring_stress(wheel, wheel.coordinates(state.free))) == {s.name for s in design.spring_sets}


def test_what_has_no_elastic_hub_is_refused(wheel: AncfWheel) -> None:
    without = replace(exomars(), inner_hub=None, cone=None, impact_springs=None)
    with pytest.raises(InputError, match="no inner hub"):
        build_ancf_wheel(without, hub="elastic")
    with pytest.raises(InputError, match="is not known"):
        build_ancf_wheel(WheelDesign(), hub="soft")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="elastic hub"):
        planar(wheel)
