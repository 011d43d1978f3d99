"""Places of an obstacle: rising alone, along the ground, turned; and the contact's forces about them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.hub_travel import HubTravel, Way
from reference_fe import dolfinx_api as api
from reference_fe.contact.obstacle import ObstacleContact, ObstacleTerm
from reference_fe.contact.obstacle_path import ObstaclePath
from reference_fe.contact.obstacles import StepEdge
from reference_fe.problem.domain import Domain
from reference_fe.verification.structured_hexahedra import block_mesh

UP, FORWARD, LEFT = np.eye(3)[[2, 0, 1]]


def travel(way: Way) -> HubTravel:
    return HubTravel.along(way=way, start=0.1, steps=(0.05,))


def path(way: Way) -> ObstaclePath:
    return ObstaclePath(normal=UP, along=FORWARD, rise=UP, travel=travel(way))


@pytest.mark.parametrize("way", list(Way))
def test_points_go_there_and_back(way: Way) -> None:
    points = np.random.default_rng(5).standard_normal((7, 3))
    place = path(way).place(travel(way).controls[0])
    np.testing.assert_allclose(place.back(place.of(points)), points, atol=1e-14)
    np.testing.assert_allclose(place.turned_back(place.turned(points)), points, atol=1e-14)


def test_the_ground_under_a_hub_that_moves() -> None:
    """By hand: 0.1 up, 0.05 against the way; a point ahead of a turn to the left comes to lie on the right."""
    ends = {way: path(way).place(travel(way).controls[0]) for way in Way}
    np.testing.assert_allclose(ends[Way.FORE_AFT].of(np.zeros(3)), 0.1 * UP - 0.05 * FORWARD, atol=1e-15)
    np.testing.assert_allclose(ends[Way.LATERAL].of(np.zeros(3)), 0.1 * UP - 0.05 * LEFT, atol=1e-15)
    turned = 0.1 * UP + np.cos(0.05) * FORWARD - np.sin(0.05) * LEFT
    np.testing.assert_allclose(ends[Way.TURNING].of(FORWARD), turned, atol=1e-15)
    wound = np.cos(0.05) * 0.1 * UP - np.sin(0.05) * 0.1 * FORWARD
    np.testing.assert_allclose(ends[Way.WIND_UP].of(np.zeros(3)), wound, atol=1e-15)
    leant = np.cos(0.05) * 0.1 * UP + np.sin(0.05) * 0.1 * LEFT
    np.testing.assert_allclose(ends[Way.LEANING].of(np.zeros(3)), leant, atol=1e-15)
    np.testing.assert_allclose(ends[Way.RADIAL].of(np.zeros(3)), 0.15 * UP, atol=1e-15)


def pressed(way: Way) -> tuple[ObstacleTerm, NDArray[np.float64]]:
    """A rigid block of 1 m on rough ground that has pressed 0.1 m into it; displacement zero."""
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X - [0.5, 0.5, 0.0]))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    contact = ObstacleContact(
        faces=("z0",),
        normal=(0.0, 0.0, 1.0),
        along=(1.0, 0.0, 0.0),
        distance_at_touch=0.0,
        stiffness=30.0,
        ramp=1e-9,
        friction=0.5,
        travel=travel(way),
    )
    term = contact.build(domain, V)
    u = np.zeros(V.dofmap.index_map.size_local * 3)
    term.set_control(0.1)
    term.evaluate(u, 0.0)
    term.accept()
    return term, u


@pytest.mark.parametrize(("way", "row"), [(Way.FORE_AFT, 0), (Way.LATERAL, 1)])
def test_what_sticks_is_pulled_along_and_then_slides(way: Way, row: int) -> None:
    """Stick stiffness 30 N/m over 1 m^2: 0.03 m pull with 0.9 N; 0.2 m with mu N = 1.5 N, against the hub's way."""
    term, u = pressed(way)
    for gone, force in ((0.03, 0.9), (0.2, 1.5)):
        term.set_control(0.1 + gone)
        term.evaluate(u, 0.0)
        expected = np.array([0.0, 0.0, 3.0])
        expected[row] = -force
        np.testing.assert_allclose(term.resultant(), expected, rtol=1e-6, atol=1e-9)


def test_a_turn_is_resisted_by_the_polar_moment() -> None:
    """Square of 1 m: k (a^4 / 6) psi = 5 psi by the right hand; carried on in two steps it is the same."""
    term, u = pressed(Way.TURNING)
    for angle in (0.004, 0.008):
        term.set_control(0.1 + 0.05 * angle)
        term.evaluate(u, 0.0)
        assert term.moment()[2] == pytest.approx(-5.0 * angle, rel=1e-4)
        term.accept()
    np.testing.assert_allclose(term.resultant()[:2], 0.0, atol=1e-9)


def test_ground_that_is_wound_up_presses_harder_in_front() -> None:
    """Square of 1 m on k = 30: k (a^4 / 12) psi = 2.5 psi against the hub, whose axle lies in the face."""
    term, u = pressed(Way.WIND_UP)
    term.set_control(0.1 + 0.05 * 0.004)
    term.evaluate(u, 0.0)
    np.testing.assert_allclose(term.moment(), [0.0, -2.5 * 0.004, 0.0], rtol=1e-4, atol=1e-9)
    assert term.resultant()[2] == pytest.approx(3.0, rel=1e-4)


@pytest.mark.parametrize("way", [Way.TURNING, Way.WIND_UP, Way.LEANING])
def test_what_is_accepted_on_turned_ground_stays_as_it_is(way: Way) -> None:
    """Its traction turns with the ground: kept in the ground's axes, 0.4 rad from the wheel's."""
    term, u = pressed(way)
    term.set_control(0.1 + 0.05 * 0.4)
    before = term.evaluate(u, 0.0).force.copy()
    term.accept()
    after = term.evaluate(u, 0.0).force
    assert np.abs(before[..., :2]).max() > 0.01
    np.testing.assert_allclose(after, before, atol=1e-12)


@pytest.mark.parametrize("way", [Way.TURNING, Way.WIND_UP, Way.LEANING])
def test_with_a_lag_it_is_the_tangent_line(way: Way) -> None:
    term, u = pressed(way)
    term.set_control(0.1 + 0.05 * 1e-4)
    exact = term.evaluate(u, 0.0).force
    lagged = term.evaluate(u, 0.05 * 1e-4).force
    np.testing.assert_allclose(lagged, exact, rtol=1e-3, atol=1e-7)


def test_only_a_plane_may_be_moved_over() -> None:
    with pytest.raises(InputError, match="must be a plane"):
        ObstacleContact(
            faces=("z0",),
            normal=(0.0, 0.0, 1.0),
            distance_at_touch=0.0,
            obstacle=StepEdge(height=0.5, edge_radius=0.2),
            travel=travel(Way.LATERAL),
        )
