"""The surface term of obstacles: its stiffness is the derivative of its forces, also with friction and multipliers."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.contact.obstacle import ContactMethod, ObstacleContact, ObstacleTerm
from reference_fe.contact.obstacles import HalfRoundRock, Obstacle, Plane, StepEdge
from reference_fe.problem.domain import Domain
from reference_fe.verification.structured_hexahedra import block_mesh

OBSTACLES = [Plane(), StepEdge(height=0.5, edge_radius=0.2), HalfRoundRock(radius=0.7, position=0.1)]
TILT = (np.sin(0.2), 0.0, np.cos(0.2))


def term_on_a_block(obstacle: Obstacle, friction: float = 0.0, method: str = "penalty") -> tuple[ObstacleTerm, int]:
    """Block of 1 m about x = 0, its lower face at z = 0; the obstacle's ground is tilted about y."""
    domain = Domain.from_tagged(block_mesh((2, 1, 1), lambda X: X - [0.5, 0.5, 0.0]))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    contact = ObstacleContact(
        faces=("z0",),
        normal=TILT,
        along=(TILT[2], 0.0, -TILT[0]),
        distance_at_touch=0.05,
        obstacle=obstacle,
        stiffness=30.0,
        ramp=0.02,
        friction=friction,
        method=ContactMethod(method),
        penetration_tolerance=1e-9,
    )
    term = contact.build(domain, V)
    term.set_control(0.12)
    return term, int(V.dofmap.index_map.size_global * 3)


def assembled(
    term: ObstacleTerm, u: NDArray[np.float64], lag: float = 0.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Force vector and dense stiffness."""
    batch = term.evaluate(u, lag)
    force, stiffness = np.zeros_like(u), np.zeros((len(u), len(u)))
    for nodes, f, k in zip(batch.nodes, batch.force, batch.stiffness, strict=True):
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        force[rows] += f.ravel()
        stiffness[np.ix_(rows, rows)] += k.reshape(len(rows), -1)
    return force, stiffness


def start(n: int) -> NDArray[np.float64]:
    return 0.01 * np.random.default_rng(3).standard_normal(n)


@pytest.mark.parametrize("obstacle", OBSTACLES, ids=["plane", "step", "rock"])
@pytest.mark.parametrize("method", ["penalty", "augmented_lagrangian"])
def test_stiffness_is_minus_the_derivative_of_the_force(obstacle: Obstacle, method: str) -> None:
    term, n = term_on_a_block(obstacle, method=method)
    u, direction = start(n), np.random.default_rng(4).standard_normal(n)
    assembled(term, u)
    assert term.augment() == (method != "penalty")
    h = 1e-6
    ahead, behind = (assembled(term, u + k * h * direction)[0] for k in (1, -1))
    _, stiffness = assembled(term, u)
    assert np.abs(stiffness).max() > 0.1
    np.testing.assert_allclose(stiffness @ direction, -(ahead - behind) / (2 * h), atol=2e-6)
    np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-12)


@pytest.mark.parametrize(("slip", "friction"), [(1e-5, 1e3), (0.05, 0.4)], ids=["sticking", "sliding"])
def test_friction_has_a_consistent_tangent_on_a_plane(slip: float, friction: float) -> None:
    term, n = term_on_a_block(Plane(), friction=friction)
    u = start(n)
    assembled(term, u)
    term.accept()
    u = u + slip * np.tile([0.6, 0.8, 0.0], n // 3) + 0.1 * slip * start(n)
    direction = np.random.default_rng(4).standard_normal(n)
    h = 1e-7
    ahead, behind = (assembled(term, u + k * h * direction)[0] for k in (1, -1))
    _, stiffness = assembled(term, u)
    np.testing.assert_allclose(stiffness @ direction, -(ahead - behind) / (2 * h), atol=1e-5)
    assert (np.abs(stiffness - stiffness.T).max() > 1e-3) == (slip > 0.01)


@pytest.mark.parametrize("obstacle", OBSTACLES, ids=["plane", "step", "rock"])
def test_a_lag_is_the_tangent_line_of_the_obstacles_motion(obstacle: Obstacle) -> None:
    """f(control - lag) + lag df/dcontrol, by finite differences."""
    term, n = term_on_a_block(obstacle)
    u, lag, h = start(n), 0.03, 1e-6
    at = {}
    for control in (0.12 - lag, 0.12 - lag + h, 0.12 - lag - h):
        term.set_control(control)
        at[control] = assembled(term, u)[0]
    before, ahead, behind = at.values()
    term.set_control(0.12)
    np.testing.assert_allclose(assembled(term, u, lag)[0], before + lag * (ahead - behind) / (2 * h), atol=1e-7)


def test_history_changes_on_accept_only() -> None:
    term, n = term_on_a_block(Plane(), friction=0.4, method="augmented_lagrangian")
    u = start(n)
    before = term.state()
    assembled(term, u)
    term.augment()
    assembled(term, u + 0.01)
    for name, values in term.state().items():
        np.testing.assert_array_equal(values, before[name])
    term.accept()
    assert term.state()["multiplier"].max() > 0.0
    term.restore(before)
    np.testing.assert_array_equal(term.state()["traction"], 0.0)


def test_force_of_a_step_on_a_flat_block_has_a_closed_form() -> None:
    """Undeformed block of 1 m over a step's edge of radius r, sunk by d: k per area times the integrals of the depth.

    On the flat k d (1/2 - r); on the edge k (r - d) (r asinh(x / (r - d)) - x) up, x^2 = r^2 - (r - d)^2, and k d^2 / 2
    back. The moment about y turns the block off the step: force on the flat times its arm, plus the edge's small share.
    """
    k, r, d, n = 1e4, 0.1, 0.04, 120
    domain = Domain.from_tagged(block_mesh((n, 1, 1), lambda X: X - [0.5, 0.5, 0.0]))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    step = StepEdge(height=0.3, edge_radius=r)
    vectors = {"normal": (0.0, 0.0, 1.0), "along": (1.0, 0.0, 0.0)}
    term = ObstacleContact(
        faces=("z0",), distance_at_touch=0.0, obstacle=step, stiffness=k, ramp=1e-9, **vectors
    ).build(domain, V)
    term.set_control(d)
    term.evaluate(np.zeros(V.dofmap.index_map.size_global * 3), 0.0)
    x = np.sqrt(r**2 - (r - d) ** 2)
    flat, edge = d * (0.5 - r), (r - d) * (r * np.arcsinh(x / (r - d)) - x)
    np.testing.assert_allclose(term.resultant(), [-k * d**2 / 2, 0.0, k * (flat + edge)], rtol=2e-4, atol=1e-9)
    moment = term.moment()
    np.testing.assert_allclose(moment[[0, 2]], 0.0, atol=1e-9)
    assert -moment[1] == pytest.approx(k * (flat * 0.5 * (0.5 + r) + edge * (r - x / 3.0)), rel=0.01)
    assert term.penetration() == pytest.approx(d)


def test_impossible_contacts_are_refused() -> None:
    plane = {"faces": ("z0",), "distance_at_touch": 0.0}
    with pytest.raises(InputError, match="normal"):
        ObstacleContact(normal=(0.0, 0.0, 2.0), **plane)
    with pytest.raises(InputError, match="right angles"):
        ObstacleContact(normal=(0.0, 0.0, 1.0), along=(0.0, 0.0, 1.0), **plane)
    with pytest.raises(InputError, match="friction"):
        ObstacleContact(normal=(0.0, 0.0, 1.0), friction=-0.1, **plane)
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 1, (3,)))
    unknown = ObstacleContact(normal=(0.0, 0.0, 1.0), **plane)
    with pytest.raises(InputError, match="Young"):
        unknown.build(domain, V)
