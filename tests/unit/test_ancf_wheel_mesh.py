"""ANCF wheel: areas, welds, supports and the ground's points of its network."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.wheel.joints import turning_stiffness
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from contracts.errors import InputError
from geometry.build import build_mesh
from geometry.hexahedra import gauss_points, jacobians, reference_nodes
from geometry.parts import SpringSet
from geometry.springs import polar, spring_leg, station_angles, weld_angle
from geometry.wheel import WheelDesign, exomars_hoops
from workbench.study.reading import read_study
from workbench.study.wheel_design import wheel_design

Array = NDArray[np.float64]
ROOT = Path(__file__).parents[2]


def strips() -> WheelDesign:
    """AMALIA's wheel: sidewall springs alone."""
    return wheel_design(read_study(ROOT / "studies/amalia.toml"))


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
    """Edge nodes of a spring's first plate lie at half of both thicknesses along the rim's normal."""
    plates, ties = wheel.plates, wheel.ties
    for spring, rim, offset in zip(ties.spring, ties.rim, ties.offset, strict=True):
        assert offset == pytest.approx(0.5 * (plates.layers[spring][0].thickness + plates.layers[rim][0].thickness))
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
        expected += 0.5 * turning_stiffness(springs.material, springs.thickness, None) * width * angle**2
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


def test_a_grouser_cut_by_a_weld_keeps_its_tip() -> None:
    """The first outer weld ends inside a grouser's foot: both pieces together have the tip's area and width."""
    design = WheelDesign()
    fins, outer = design.grousers, design.spring_sets[0]
    assert fins is not None
    end = float(station_angles(outer)[0]) + 0.5 * weld_angle(outer, design.tire.inner_radius)
    turned = replace(design, grousers=replace(fins, phase=end + 0.2 * fins.thickness / design.tire.outer_radius))
    wheel = build_ancf_wheel(turned)
    tips = wheel.ground.height < -fins.height
    assert wheel.ground.area[tips].sum() == pytest.approx(fins.count * fins.thickness * 0.5 * design.tire.width)
    assert wheel.ground.at[tips].min() >= 0.0
    assert wheel.ground.at[tips].max() <= 1.0
    whole = build_ancf_wheel(design)
    assert tips.sum() > (whole.ground.height < -fins.height).sum()


def test_the_rim_is_as_wide_as_it_is_where_the_hub_is_wider() -> None:
    design = WheelDesign()
    hub = replace(design.outer_hub, width=design.tire.width + 30e-3)
    wheel = build_ancf_wheel(replace(design, outer_hub=hub))
    middle = 0.5 * (design.tire.inner_radius + design.tire.outer_radius)
    assert _area(wheel, "tire") == pytest.approx(2.0 * math.pi * middle * 0.5 * design.tire.width, rel=1e-12)
    plates, ties = wheel.plates, wheel.ties
    for spring, rim in zip(ties.spring, ties.rim, strict=True):
        assert plates.reference[plates.plates[spring], 0, 1] == pytest.approx(
            plates.reference[plates.plates[rim], 0, 1]
        )


@pytest.mark.parametrize(
    ("sizes", "named"),
    [
        ({"element_size": 0.0}, "element size"),
        ({"axial_size": -1.0}, "axial size"),
        ({"element_size": math.nan}, "element size"),
        ({"factor": 0.5}, "factor"),
        ({"factor": math.nan}, "factor"),
    ],
)
def test_sizes_that_divide_nothing_are_refused(sizes: dict[str, float], named: str) -> None:
    with pytest.raises(InputError, match=named):
        build_ancf_wheel(WheelDesign(), **sizes)


def test_bands_that_all_but_meet_are_refused() -> None:
    """Edges a tenth of a millimetre apart: plates narrower than thick; they may coincide."""
    design = WheelDesign()
    outer, inner = design.spring_sets
    edge = outer.bands[1][0]
    near = replace(inner, bands=((-edge + 1e-4, edge - 1e-4),))
    with pytest.raises(InputError, match=r"leave 0\.1 mm between them"):
        build_ancf_wheel(replace(design, spring_sets=(outer, near)))


@pytest.mark.parametrize(
    ("design", "within"),
    [(WheelDesign(), 1e-3), (exomars_hoops(), 1e-3), (strips(), 2e-3)],
    ids=["leaves", "hoops", "strips"],
)
def test_mass_and_second_moments_are_the_solids(design: WheelDesign, within: float) -> None:
    """Half of the wheel against its solid mesh, within 0.1 %; what lies on the rigid hub, the hub's welds, is added.

    Mass, first moments, and moments of inertia about all three axes of the wheel's frame. Strips: masses move with the
    plate's middle surface, and welds as thick as the rim cover a quarter of it, 0.4 % of its radius further in.
    """
    wheel = build_ancf_wheel(design)
    mesh = build_mesh(design, element_size=12e-3, axial_size=40e-3, parts="flexible")
    parts = {"tire": design.tire.material}
    if design.grousers is not None:
        parts["grousers"] = design.grousers.material
    parts |= {springs.name: springs.material for springs in design.spring_sets}
    if design.sidewall_springs is not None:
        parts[design.sidewall_springs.name] = design.sidewall_springs.material
    density = np.zeros(len(mesh.cells))
    for part, material in parts.items():
        density[mesh.cell_tags == mesh.parts[part]] = material.density
    at, weights = gauss_points(4)
    at_nodes = [_quadratic(at[:, d][:, None], reference_nodes(27)[None, :, d]) for d in range(3)]
    places = np.einsum("qa,cai->cqi", at_nodes[0] * at_nodes[1] * at_nodes[2], mesh.points[mesh.cells])
    mass = np.linalg.det(jacobians(mesh.points, mesh.cells, at)) * weights * density[:, None]
    solid = _moments(places.reshape(-1, 3), mass.ravel())
    plates = wheel.plates
    matrix = plates.mass()
    fields = np.zeros((4, *plates.reference.shape))
    fields[0, :, 0, 0] = 1.0
    fields[1:, :, :, 0] = np.moveaxis(plates.reference, 2, 0)
    flat = fields.reshape(4, -1)
    found = flat @ (matrix @ flat.T)
    for springs in design.spring_sets:
        found += _hub_welds(design, springs)
    scale = np.sqrt(np.diag(solid))
    np.testing.assert_allclose(found / np.outer(scale, scale), solid / np.outer(scale, scale), atol=within)


def _quadratic(x: Array, node: Array) -> Array:
    """Lagrange functions of nodes -1, 0, 1 at x."""
    return np.where(node != 0.0, 0.5 * x * (x + node), 1.0 - x * x)


def _moments(places: Array, mass: Array) -> Array:
    """Matrix (4, 4) of the moments of 1, x, y, z by each other."""
    one = np.column_stack([np.ones(len(places)), places])
    return np.asarray(one.T @ (one * mass[:, None]))


def _hub_welds(design: WheelDesign, springs: SpringSet) -> Array:
    hub, half = design.outer_hub.outer_radius, 0.5 * weld_angle(springs, design.tire.inner_radius)
    angles = np.linspace(-half, half, 9)
    weights = np.full(9, 1.0 / 9.0)
    rows = []
    for low, high in springs.bands:
        if high > 0.0:
            y = np.linspace(max(low, 0.0), high, 41)
            for station in station_angles(springs):
                around = np.array([polar(hub + 0.5 * springs.thickness, station + a) for a in angles])
                volume = 2.0 * half * (hub + 0.5 * springs.thickness) * springs.thickness * (high - max(low, 0.0))
                share = np.outer(weights, np.full(41, 1.0 / 41.0)) * volume * springs.material.density
                grid = np.concatenate([np.column_stack([around[:, 0], np.full(9, v), around[:, 1]]) for v in y])
                rows.append(_moments(grid, share.T.ravel()))
    return np.asarray(np.sum(rows, axis=0))
