"""Inner contact: search, force and stiffness on bodies whose distance is known; gradients by finite differences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact.facet_kernels import closest_point, surface_frames
from reference_fe.contact.inner import ContactPair, InnerContact, InnerContactTerm
from reference_fe.contact.inner_kernels import contact_blocks, nearest_contacts
from reference_fe.contact.inner_pairs import wheel_contact_pairs
from reference_fe.contact.surface import contact_surface, node_positions
from reference_fe.contact.surface_term import WildIterateError
from reference_fe.dolfinx_api import fem
from reference_fe.problem.domain import Domain
from reference_fe.verification.structured_hexahedra import block_mesh, stacked

Array = NDArray[np.float64]
GAP = 0.02
LAW = InnerContact(
    pairs=(ContactPair(slave="lid_z0", master="z1"),),
    stiffness=100.0,
    ramp=1e-3,
    least_gap=2e-3,
    depth=0.05,
    reach=0.03,
)


def plates(bulge: float = 0.0, order: int = 2, counts: tuple[int, int, int] = (3, 2, 1)) -> TaggedMesh:
    """A plate (part body) and a smaller one (part lid) ``GAP`` above it on other elements; both bulge upwards."""

    def arch(X: Array) -> Array:
        return X - np.outer(bulge * ((X[:, 0] - 0.5) ** 2 + 0.5 * X[:, 0] * X[:, 1]), [0.0, 0.0, 1.0])

    low = block_mesh((2, 2, 1), lambda X: arch(X * [1.0, 1.0, 0.1]), order)
    high = block_mesh(counts, lambda X: arch(X * [0.6, 0.7, 0.1] + [0.2, 0.1, 0.1 + GAP]), order)
    return stacked(low, high, "lid")


def term_on(mesh: TaggedMesh, law: InnerContact = LAW) -> InnerContactTerm:
    domain = Domain.from_tagged(mesh)
    return law.build(domain, fem.functionspace(domain.mesh, ("Lagrange", mesh.order, (3,))))


def sunk(term: InnerContactTerm, sink: float, noise: float = 0.0) -> Array:
    """Displacement that sinks the lid (everything above z = 0.11), with noise on all nodes."""
    X = term.reference_positions
    u = noise * np.random.default_rng(3).standard_normal(X.shape)
    u[X[:, 2] > 0.1 + 0.5 * GAP, 2] -= sink
    return u.ravel()


def total_force(term: InnerContactTerm, u: Array) -> Array:
    forces = term.evaluate(u, 0.0)
    out = np.zeros((len(u) // 3, 3))
    np.add.at(out, forces.nodes, forces.force)
    return out


@pytest.mark.parametrize(("bulge", "order"), [(0.0, 1), (0.0, 2), (0.1, 2)])
def test_stiffness_is_the_derivative_of_the_force(bulge: float, order: int) -> None:
    """Curved, tilted and noisy facets in deep and light contact: the turning normal and the sliding point included."""
    term = term_on(plates(bulge, order))
    u = sunk(term, GAP + 2e-3, noise=1e-3)
    direction = np.random.default_rng(4).standard_normal(len(u))
    step = 1e-8
    slope = (total_force(term, u + step * direction) - total_force(term, u - step * direction)) / (2.0 * step)
    forces = term.evaluate(u, 0.0)
    moved = direction.reshape(-1, 3)[forces.nodes]
    product = np.zeros((len(u) // 3, 3))
    np.add.at(product, forces.nodes, -np.einsum("maibj,mbj->mai", forces.stiffness, moved))
    assert np.abs(slope).max() > 1.0
    np.testing.assert_allclose(product, slope, atol=1e-5 * np.abs(slope).max())
    flat = forces.stiffness.reshape(len(forces.nodes), forces.nodes.shape[1] * 3, -1)
    np.testing.assert_allclose(flat, np.swapaxes(flat, 1, 2), atol=1e-12 * np.abs(flat).max())


def test_action_is_reaction_in_force_and_moment() -> None:
    term = term_on(plates(0.1))
    u = sunk(term, GAP + 2e-3, noise=1e-3)
    force, x = total_force(term, u), term.reference_positions + u.reshape(-1, 3)
    size = np.abs(force).sum()
    assert size > 0.05
    assert np.abs(force.sum(axis=0)).max() < 1e-13 * size
    assert np.abs(np.cross(x, force).sum(axis=0)).max() < 1e-13 * size
    assert np.abs(np.cross(term.reference_positions, force).sum(axis=0)).max() > 1e-6 * size  # negative control


@pytest.mark.parametrize(("sink", "pressure"), [(GAP - 2e-3, 0.0), (GAP, 0.025), (GAP + 5e-3, 0.5)])
def test_force_is_pressure_times_area(sink: float, pressure: float) -> None:
    """Open; at touch k d/4; at 5 mm depth k times depth; on the lid's 0.6 x 0.7 face."""
    term = term_on(plates())
    force = total_force(term, sunk(term, sink))
    up = force[term.reference_positions[:, 2] > 0.1 + 0.5 * GAP].sum(axis=0)
    np.testing.assert_allclose(up, [0.0, 0.0, pressure * 0.42], atol=1e-12)
    assert term.largest_penetration == pytest.approx(max(0.0, sink - GAP), abs=1e-12)


def test_a_point_deeper_than_the_depth_is_not_caught() -> None:
    """Negative control of the search, and the reason for a generous depth."""
    term = term_on(plates())
    assert np.abs(total_force(term, sunk(term, GAP + 0.049))).max() > 0.0
    assert np.abs(total_force(term, sunk(term, GAP + 0.051))).max() == 0.0


def test_a_face_that_looks_away_is_not_touched() -> None:
    """The lid's upper face comes as near to the plate as its lower one, but faces the same way."""
    term = term_on(plates(), replace(LAW, pairs=(ContactPair(slave="lid_z1", master="z1"),), depth=0.2))
    assert np.abs(total_force(term, sunk(term, GAP + 0.101))).max() == 0.0


def test_points_that_start_too_near_are_left_out() -> None:
    """Two plates that touch at the start, like strip and ring beside a weld, do not press on each other ever."""
    term = term_on(plates(), replace(LAW, least_gap=0.025))
    assert np.abs(total_force(term, sunk(term, GAP + 5e-3))).max() == 0.0


def test_the_pattern_grows_once_and_holds_every_block() -> None:
    term = term_on(plates(), replace(LAW, reach=0.01))
    assert len(term.couplings()) == 0
    forces = term.evaluate(sunk(term, GAP + 2e-3), 0.0)
    assert term.pattern_version == 1
    room = {tuple(sorted(row)) for row in term.couplings().tolist()}
    assert {tuple(sorted(row)) for row in forces.nodes.tolist()} <= room
    term.evaluate(sunk(term, GAP + 3e-3), 0.0)
    assert term.pattern_version == 1


def test_a_face_does_not_touch_itself_across_its_own_edges() -> None:
    """Self-contact of a bulging plate: facets that share nodes are no candidates, and none other is near."""
    term = term_on(plates(0.2), replace(LAW, pairs=(ContactPair(slave="z1", master="z1"),), least_gap=1e-3))
    assert len(term.couplings()) == 0


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_of_two_masters_the_nearer_counts_though_the_other_is_deeper(order: tuple[int, int]) -> None:
    """A point 20 mm above one straight edge and 30 mm behind another, whose gap is the more negative one."""
    x = np.array([[0.0, 0, 0], [1.0, 0, 0], [0.0, 0.05, 0], [1.0, 0.05, 0], [0.4, 0.02, 0]])
    master = (np.array([[0, 1], [2, 3]]), np.array([-1.0, -1.0]), (2, 1))
    balls = (np.array([[0.5, 0.0, 0.0], [0.5, 0.05, 0.0]]), np.ones(2), np.array([[0.0, 1.0, 0.0]] * 2))
    downward, candidates = np.array([[[0.0, -1.0, 0.0]]]), (np.array([0, 2]), np.array(order))
    facet, _, gap = nearest_contacts(x, x[None, 4:], downward, candidates, master, balls, (1.0, 1.0), np.zeros((2, 4)))
    assert facet[0, 0] == 0
    assert gap[0, 0] == pytest.approx(0.02)


@pytest.mark.parametrize("bulge", [0.0, 0.3])
def test_planar_edges_have_the_same_law(bulge: float) -> None:
    """An edge is a facet extruded along the third axis: its potential is k A g^2/2, k A = 2 here."""
    x = np.array([[0.0, 0, 0], [0.5, bulge, 0], [1.0, 0.1, 0], [0.3, 0.8 * bulge - 0.1, 0]])
    master = (np.array([[0, 1, 2]]), np.array([-1.0]), (3, 1))
    touch = np.array([[[0.0, -1.0, 0.0]]])

    def contact(x: Array) -> tuple[Array, float]:
        candidates = (np.array([0, 1]), np.array([0]))
        balls = (np.array([[0.5, 0.0, 0.0]]), np.ones(1), np.array([[0.0, 1.0, 0.0]]))
        limits, margins = (1.0, 1.0), np.zeros((1, 4))
        facet, xi, gap = nearest_contacts(x, x[None, 3:], touch, candidates, master, balls, limits, margins)
        assert facet[0, 0] == 0
        return xi[0], float(gap[0, 0])

    def blocks(x: Array) -> tuple[Array, Array]:
        xi, gap = contact(x)
        force, stiffness = np.empty((1, 4, 2)), np.empty((1, 4, 2, 4, 2))
        touch, law = np.array([[gap, 2.0]]), (1.0, 1e-6)
        contact_blocks(x, (np.array([[3]]), np.ones((1, 1))), master, xi, touch, law, (force, stiffness))
        return force[0], stiffness[0]

    force, stiffness = blocks(x)
    order = [3, 0, 1, 2]
    for a, node in enumerate(order):
        for i in range(2):
            step = np.zeros_like(x)
            step[node, i] = 1e-6
            energy = [contact(x + sign * step)[1] ** 2 for sign in (1.0, -1.0)]
            assert force[a, i] == pytest.approx(-(energy[0] - energy[1]) / 2e-6, abs=1e-8)
            slope = (blocks(x + step)[0] - blocks(x - step)[0]) / 2e-6
            np.testing.assert_allclose(-stiffness[:, :, a, i], slope, atol=1e-7)


def test_a_planar_body_presses_with_its_width() -> None:
    """Two bars in the plane, the upper one 0.3 m wide and 0.6 m long: force k times depth times 0.18 m^2."""
    low, high = planar_bar(1.0, 0.0), planar_bar(0.6, 0.1 + GAP)
    mesh = TaggedMesh(
        points=np.vstack([low[0], high[0] + [0.2, 0.0]]),
        cells=np.vstack([low[1], high[1] + len(low[0])]),
        cell_tags=np.array([1, 2], dtype=np.int32),
        facets=np.vstack([low[2], high[2] + len(low[0])]),
        facet_tags=np.array([1, 2, 3, 4], dtype=np.int32),
        parts={"body": 1, "lid": 2},
        faces={"z0": 1, "z1": 2, "lid_z0": 3, "lid_z1": 4},
        widths={"body": 1.0, "lid": 0.3},
    )
    domain = Domain.from_tagged(mesh)
    term = LAW.build(domain, fem.functionspace(domain.mesh, ("Lagrange", 2, (2,))))
    above = term.reference_positions[:, 1] > 0.1 + 0.5 * GAP
    u = np.zeros((len(above), 2))
    u[above, 1] = -GAP - 5e-3
    forces, total = term.evaluate(u.ravel(), 0.0), np.zeros((len(above), 2))
    np.add.at(total, forces.nodes, forces.force)
    np.testing.assert_allclose(total[above].sum(axis=0), [0.0, 0.5 * 0.18], atol=1e-12)
    np.testing.assert_allclose(total.sum(axis=0), 0.0, atol=1e-12)


def planar_bar(length: float, base: float) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
    """One 9-node cell, 0.1 m high: points, cell, and its lower and upper edge."""
    places = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    points = np.array(places) * [0.5 * length, 0.05] + [0.0, base]
    return points, np.arange(9)[None], np.array([[0, 1, 4], [2, 3, 6]])


def test_a_long_way_finds_what_a_fresh_search_finds() -> None:
    """The list of near facets is kept while nodes move little: 40 steps of 1 mm, down, along and up again."""
    term = term_on(plates(0.1))
    for k in range(40):
        u = sunk(term, GAP - 5e-3 + min(k, 40 - k) * 0.7e-3, noise=1e-3)
        fresh = term_on(plates(0.1)).evaluate(u, 0.0)
        kept = term.evaluate(u, 0.0)
        np.testing.assert_array_equal(kept.nodes, fresh.nodes)
        np.testing.assert_array_equal(kept.force, fresh.force)


def wedge() -> TaggedMesh:
    """Two bars in the plane that share the corner (1, 0.1): the upper one's lower edge rises from it to the left."""
    low, high = planar_bar(1.0, 0.0), planar_bar(0.6, 0.0)
    tilted = high[0] @ np.array([[1.0, -0.1], [0.0, 1.0]]) + [0.4, 0.16]
    number = np.concatenate([[9], [2], 10 + np.arange(7)])  # its second corner is the lower bar's third
    return TaggedMesh(
        points=np.vstack([low[0], np.delete(tilted, 1, axis=0)]),
        cells=np.vstack([low[1], number[high[1]]]),
        cell_tags=np.array([1, 2], dtype=np.int32),
        facets=np.vstack([low[2], number[high[2]]]),
        facet_tags=np.array([1, 2, 3, 4], dtype=np.int32),
        parts={"body": 1, "lid": 2},
        faces={"z0": 1, "z1": 2, "lid_z0": 3, "lid_z1": 4},
        widths={"body": 1.0, "lid": 1.0},
    )


@pytest.mark.parametrize(("overhang", "touching"), [(0.05, 3), (0.001, 2)])
def test_no_point_slips_off_where_a_strip_is_welded(overhang: float, touching: int) -> None:
    """The strip's points at x = 0.82, 0.95 and 1.008 m are pushed 10 to 20 mm down; the master ends at 1 m."""
    domain = Domain.from_tagged(wedge())
    law = replace(LAW, least_gap=1.5e-3, overhang=overhang)
    term = law.build(domain, fem.functionspace(domain.mesh, ("Lagrange", 2, (2,))))
    X = term.reference_positions
    u = np.zeros((len(X), 2))
    lid = X[:, 1] > 0.1 + 1e-9
    assert lid.sum() == 8
    u[lid] = [0.25, -0.05]
    assert len(term.evaluate(u.ravel(), 0.0).nodes) == touching


@pytest.mark.parametrize("thickness_elements", [1, 2, 3])
def test_faces_of_thin_rings_look_away_from_them(thickness_elements: int) -> None:
    """The middle of a curved facet bulges beyond the middle of its own thin cell: corners tell the side."""
    mesh = build_planar_mesh(exomars_hoops(), element_size=16e-3, thickness_elements=thickness_elements)
    domain = Domain.from_tagged(mesh)
    V = fem.functionspace(domain.mesh, ("Lagrange", 2, (2,)))
    for face, outward in (("tire_inner", -1.0), ("outer_hub_outer", 1.0)):
        surface = contact_surface(domain, V, face, 3)
        x, n, _ = surface.frames(node_positions(domain, V))
        assert np.all(outward * np.einsum("fqi,fqi->fq", n, x) > 0.9 * np.linalg.norm(x, axis=-1))


def test_a_planar_rim_has_no_hole_under_another_bands_weld() -> None:
    """Rim's inside less the welds of the slave's own set: 2 pi R - 3 x 8 mm; less both sets' without the joints."""
    design = exomars_hoops()
    mesh = build_planar_mesh(design, element_size=16e-3)
    domain = Domain.from_tagged(mesh)
    V = fem.functionspace(domain.mesh, ("Lagrange", 2, (2,)))
    (pair,) = (p for p in wheel_contact_pairs(mesh) if (p.slave, p.master) == ("springs_outer_front", "tire_inner"))
    around = 2.0 * np.pi * design.tire.inner_radius
    for across, welds in ((pair.across, 1), ((), 2)):
        surface = contact_surface(domain, V, "tire_inner", 3, across)
        x, n, lengths = surface.frames(node_positions(domain, V))
        assert np.all(np.einsum("fqi,fqi->fq", n, x) < 0.0)
        length = float((lengths @ surface.weights).sum())
        assert length == pytest.approx(around - welds * 3 * 8e-3, abs=2e-5)


def test_restored_history_gives_the_pattern_back() -> None:
    """A cut-back, or a run that is taken up again, has the couplings of the committed state."""
    term = term_on(plates(), replace(LAW, reach=0.01))
    before = term.state()
    term.evaluate(sunk(term, GAP + 2e-3), 0.0)
    after, version = term.state(), term.pattern_version
    term.restore(before)
    assert len(term.couplings()) == 0
    assert term.pattern_version > version
    term.restore(after)
    assert len(term.couplings()) > 0


def broken(change: Callable[[], InnerContact]) -> None:
    with pytest.raises(InputError, match=r"inner contact|ramp"):
        change()


def test_bad_settings_are_refused() -> None:
    broken(lambda: replace(LAW, stiffness=0.0))
    broken(lambda: replace(LAW, ramp=3e-3))
    domain = Domain.from_tagged(plates())
    with pytest.raises(InputError, match="Lagrange of the mesh's order"):
        LAW.build(domain, fem.functionspace(domain.mesh, ("Lagrange", 1, (3,))))


def test_spring_sets_of_a_planar_wheel_pass_each_other() -> None:
    pairs = wheel_contact_pairs(build_planar_mesh(exomars_hoops(), element_size=14e-3))
    names = {(pair.slave, pair.master) for pair in pairs}
    assert {("springs_outer_front", "tire_inner"), ("springs_outer_front", "springs_outer_front")} <= names
    assert ("springs_outer_front", "springs_inner_front") not in names


def test_pairs_of_a_wheel() -> None:
    design = exomars_hoops()
    flexible = wheel_contact_pairs(build_mesh(design, element_size=14e-3, parts="flexible"))
    names = {(pair.slave, pair.master) for pair in flexible}
    assert {("springs_outer_front", "tire_inner"), ("springs_inner_back", "springs_inner_back")} <= names
    assert ("tire_inner", "outer_hub_outer") in names
    assert not any("impact" in name for pair in names for name in pair)
    whole = {(pair.slave, pair.master) for pair in wheel_contact_pairs(build_mesh(design, element_size=14e-3))}
    assert names < whole
    assert {("impact_springs_front", "outer_hub_bore"), ("outer_hub_bore", "inner_hub_outer")} <= whole - names


@pytest.mark.parametrize("margin", [0.0, 0.2])
def test_the_quick_refusals_refuse_nothing_that_touches(margin: float) -> None:
    """1000 points around a bowed facet, 1 m wide: what is found is what the closest point of each says by itself.

    The gap goes from 0.1 m behind to 0.3 m above; bows up to 0.25 m make the facet reach far above its middle's plane.
    """
    random, found = np.random.default_rng(3), 0
    for _ in range(10):
        a, b = np.meshgrid([-0.5, 0.0, 0.5], [-0.5, 0.0, 0.5], indexing="ij")
        x = np.stack([a, b, random.uniform(-0.5, 0.5) * a**2 + random.uniform(-0.5, 0.5) * a * b], axis=-1).reshape(
            -1, 3
        )
        facet, lattice, above, below = np.arange(9)[None], (3, 3), 0.3, 0.1
        points = np.column_stack([random.uniform(-0.7, 0.7, (100, 2)), random.uniform(-0.4, 0.6, 100)])
        towards = np.broadcast_to([0.0, 0.0, -1.0], (1, 100, 3)).copy()
        outward = surface_frames(x, facet, np.ones(1), lattice, np.zeros((1, 2)))[1][:, 0]
        middle = x.mean(axis=0)[None]
        balls = middle, np.linalg.norm(x - middle, axis=-1).max(keepdims=True), outward
        one = np.array([0, 1]), np.array([0])
        master, margins = (facet, np.ones(1), lattice), np.full((1, 4), margin)
        touches = nearest_contacts(x, points[None], towards, one, master, balls, (above, below), margins)[0][0] == 0
        for point, touching in zip(points, touches, strict=True):
            xi, shapes, place = np.empty(2), np.empty((6, 9)), np.empty((6, 3))
            closest_point(x, point, facet[0], lattice, 1.5, xi, shapes, place)
            normal = np.cross(place[1], place[2])
            normal /= np.linalg.norm(normal)
            within = np.abs(xi).max() <= 1.0 + margin
            assert touching == (within and -below < (point - place[0]) @ normal < above and normal[2] > 0.0)
        found += touches.sum()
    assert 100 < found < 900


@pytest.mark.parametrize("half", [0.5e-3, 2e-3, 8e-3])
def test_an_overhang_ends_where_it_should_on_facets_of_any_size(half: float) -> None:
    """An edge 2 ``half`` long goes on by 1 mm: points 0.1 mm behind it are caught up to there, and no farther."""
    x = np.zeros((3, 3))
    x[:, 0] = [-half, 0.0, half]
    beyond = np.array([0.5e-3, 0.95e-3, 1.05e-3, 3e-3, 4.9e-3])
    points = np.column_stack([half + beyond, np.full(5, -1e-4), np.zeros(5)])[None]
    master = (np.array([[0, 1, 2]]), np.array([-1.0]), (3, 1))
    balls = (np.zeros((1, 3)), np.array([half]), np.array([[0.0, 1.0, 0.0]]))
    downward, one = np.broadcast_to([0.0, -1.0, 0.0], (1, 5, 3)).copy(), (np.array([0, 1]), np.array([0]))
    margins = np.array([[0.0, 1e-3 / half, 0.0, 0.0]])
    facet, _, gap = nearest_contacts(x, points, downward, one, master, balls, (5e-6, 5e-3), margins)
    assert facet[0].tolist() == [0, 0, -1, -1, -1]
    np.testing.assert_allclose(gap[0, :2], -1e-4, rtol=1e-9)


def test_a_corner_within_the_margin_is_not_refused_for_its_distance() -> None:
    """A flat facet 16 by 26 mm and points within a fifth beyond its edges, 0.06 mm behind; found no deeper than 0.1."""
    a, b = np.meshgrid([-8e-3, 0.0, 8e-3], [-13e-3, 0.0, 13e-3], indexing="ij")
    x = np.stack([a, b, 0.0 * a], axis=-1).reshape(-1, 3)
    xi = np.stack(np.meshgrid([-1.19, 0.0, 1.19], [-1.19, 0.0, 1.19], indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.column_stack([8e-3 * xi[:, 0], 13e-3 * xi[:, 1], np.full(9, -6e-5)])[None]
    balls = np.zeros((1, 3)), np.linalg.norm(x, axis=-1).max(keepdims=True), np.array([[0.0, 0.0, 1.0]])
    down, one = np.broadcast_to([0.0, 0.0, -1.0], (1, 9, 3)).copy(), (np.array([0, 1]), np.array([0]))
    master = (np.arange(9)[None], np.ones(1), (3, 3))
    facet = nearest_contacts(x, points, down, one, master, balls, (5e-6, 1e-4), np.full((1, 4), 0.2))[0]
    assert (facet == 0).all()


def test_an_iterate_that_is_no_state_of_any_body_is_refused() -> None:
    """A facet of more than five times its size would make all facets its neighbours; one of four is looked up."""
    term = term_on(plates())
    X = term.reference_positions
    four, six = (((share - 1.0) * X).ravel() for share in (4.0, 6.0))
    term.evaluate(four, 0.0)
    with pytest.raises(WildIterateError, match="more than five times its size"):
        term.evaluate(six, 0.0)
