"""Contact of ANCF plates with terrain against closed forms (thesis eqs. 2.21, 2.22).

Claims: a rigid plate on a slope, a step's edge and a half-round carries k delta a point along the exact normal; it is
never pulled; sliding friction is mu N against the slip; the frictionless force has a potential, so that a closed path
costs no work; a height field gives the forces of the surface it samples, with third order. Source: theory notes,
section 6; geometry; Keys (1981) for the order. Tolerance: rounding (1e-10), except where an order or a smoothing is
stated. Negative controls: a plane one degree off, the vertical gap instead of the normal one, friction at the smoothing
velocity, the tire's own normal of the thesis on the closed path, heights 1 % too large.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from ancf_reduced.contact.grid import build_contact_grid
from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import ContactNormal, ContactPatch, PlateContact
from ancf_reduced.plates.mesh import PlateMesh, build_plate_mesh, flat_patch
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.height_field import HeightField, sampled_terrain
from contracts.terrain import Terrain, inclined_plane
from contracts.terrain_ridges import HalfRound, Sinusoid, Step

K = 1000.0
PENALTY = ContactLaw(stiffness=K)
SLOPE, HEADING = np.radians(25.0), 0.6
TIRE = build_tire(thesis_preset())


def _plate(position: np.ndarray, R: np.ndarray, length: float = 0.2) -> tuple[PlateMesh, np.ndarray]:
    """A plate 0.1 m wide, 0.02 m thick; its face zeta = +1/2, centred at ``position``, looks along R's third column."""
    middle = position - 0.01 * R[:, 2]
    mesh = build_plate_mesh(
        [flat_patch(middle - 0.5 * length * R[:, 0] - 0.05 * R[:, 1], length * R[:, 0], 0.1 * R[:, 1], 0.02, "plate")]
    )
    return mesh, mesh.reference_coordinates()


def _contact(mesh: PlateMesh, terrain: Terrain, law: ContactLaw = PENALTY) -> PlateContact:
    grid = build_contact_grid(mesh, mesh.plates_of("plate"), (10, 10))
    return PlateContact(grid=grid, terrain=terrain.pieces(), law=law)


def _tire(terrain: Terrain, law: ContactLaw = PENALTY, normal: ContactNormal = ContactNormal.TERRAIN) -> PlateContact:
    return PlateContact(grid=TIRE.grid, terrain=terrain.pieces(), law=law, normal=normal)


def _facing(n: np.ndarray) -> np.ndarray:
    """Rotation whose third column is -n: the face looks at the ground."""
    a = np.cross([0.0, 1.0, 0.0], -n)
    a /= np.linalg.norm(a)
    return np.column_stack([a, np.cross(-n, a), -n])


def _on_slope(terrain: Terrain, depth: float = 0.003) -> ContactPatch:
    """Patch of a plate laid parallel into the 25 degree slope, ``depth`` deep."""
    n = np.array([-np.sin(SLOPE) * np.cos(HEADING), -np.sin(SLOPE) * np.sin(HEADING), np.cos(SLOPE)])
    place = np.array([0.3, -0.2, float(inclined_plane(SLOPE, HEADING).height(np.array(0.3), np.array(-0.2)))])
    mesh, p = _plate(place - depth * n, _facing(n))
    return _contact(mesh, terrain).patch(p, np.zeros_like(p))


def _slope_error(terrain: Terrain) -> float:
    """Relative deviation of the resultant from 100 k delta along the slope's normal."""
    n = np.array([-np.sin(SLOPE) * np.cos(HEADING), -np.sin(SLOPE) * np.sin(HEADING), np.cos(SLOPE)])
    return float(np.linalg.norm(_on_slope(terrain).resultant / (100 * K * 0.003) - n))


def test_plate_on_a_slope() -> None:
    assert _slope_error(inclined_plane(SLOPE, HEADING)) < 1e-10
    assert _on_slope(inclined_plane(SLOPE, HEADING)).total_area == pytest.approx(0.02, rel=1e-12)


def test_plane_one_degree_off_is_noticed() -> None:
    """Negative control."""
    assert _slope_error(inclined_plane(SLOPE + np.radians(1.0), HEADING)) > 1e-2


def test_vertical_gap_would_be_noticed() -> None:
    """Negative control: k times the height difference is 10 % too much on this slope."""
    assert 1.0 / np.cos(SLOPE) - 1.0 > 0.1
    patch = _on_slope(inclined_plane(SLOPE, HEADING))
    vertical = inclined_plane(SLOPE, HEADING).height(*patch.position[:, :2].T) - patch.position[:, 2]
    assert np.min(K * vertical / patch.normal_force) > 1.1


@pytest.mark.parametrize("angle", [0.5, 0.8, 1.1])
@pytest.mark.parametrize(
    ("terrain", "centre", "radius"),
    [
        (Step(rise=0.1, edge_radius=0.03, position=0.2, yaw=0.4), (0.23, 0.07), 0.03),
        (HalfRound(radius=0.05, position=0.2, yaw=0.4), (0.2, 0.0), 0.05),
    ],
    ids=["step", "half-round"],
)
def test_plate_on_an_edge(terrain: Terrain, centre: tuple[float, float], radius: float, angle: float) -> None:
    """A short plate tangent to the rounded edge, 4 mm deep: N = k (r - rho) on each point along its own radius."""
    s, y, z = (
        np.array([np.cos(0.4), np.sin(0.4), 0.0]),
        np.array([-np.sin(0.4), np.cos(0.4), 0.0]),
        np.array([0, 0, 1.0]),
    )
    outwards = -np.cos(angle) * s + np.sin(angle) * z
    axis = centre[0] * s + centre[1] * z
    along = np.cross(y, outwards)
    mesh, p = _plate(axis + (radius - 0.004) * outwards, np.column_stack([along, -y, -outwards]), 0.02)
    patch = _contact(mesh, terrain).patch(p, np.zeros_like(p))
    radial = (patch.position - axis) - ((patch.position - axis) @ y)[:, None] * y
    rho = np.linalg.norm(radial, axis=1)
    assert len(patch.points) == 100
    np.testing.assert_allclose(patch.force, (K * (radius - rho) / rho)[:, None] * radial, atol=1e-10)


@pytest.mark.parametrize(("speed", "pulled"), [(0.1, False), (2.0, True)])
def test_separation_never_pulls(speed: float, pulled: bool) -> None:
    """A plate that leaves 3 mm deep ground at 2 m/s with c = 5 N s/m would be pulled with 7 N a point; it is not."""
    mesh, p = _plate(np.array([0.0, 0.0, -0.003]), np.diag([1.0, -1.0, -1.0]))
    v = np.zeros_like(p)
    v[:, 0, 2] = speed
    contact = _contact(mesh, inclined_plane(0.0), ContactLaw(stiffness=K, damping=5.0, friction=0.5))
    linear = 100 * (K * 0.003 - 5.0 * speed)
    assert (linear < 0.0) == pulled
    force = contact.force(p, v)
    assert force[:, 0, 2].sum() == pytest.approx(max(linear, 0.0), abs=1e-10)
    assert bool(np.any(force)) != pulled


def _friction_error(slip: float, v_0: float = 1e-3) -> float:
    """Relative deviation of a sliding plate's friction from mu N against its velocity."""
    mesh, p = _plate(np.array([0.0, 0.0, -0.003]), np.diag([1.0, -1.0, -1.0]))
    direction = np.array([0.6, 0.8, 0.0])
    v = np.zeros_like(p)
    v[:, 0] = slip * direction
    contact = _contact(mesh, inclined_plane(0.0), ContactLaw(stiffness=K, friction=0.5, slip_velocity=v_0))
    resultant = contact.force(p, v)[:, 0].sum(axis=0)
    return float(np.linalg.norm(resultant[:2] / (0.5 * resultant[2]) + direction[:2]))


def test_sliding_friction_is_mu_n() -> None:
    """Smoothing takes (v_0 / v)^2 / 2 away: 5e-5 at 0.1 m/s with v_0 = 1 mm/s."""
    assert _friction_error(0.1) == pytest.approx(5e-5, rel=1e-2)
    assert _friction_error(1.0) < 1e-6


def test_slow_slip_is_noticed() -> None:
    """Negative control: at the smoothing velocity friction is 71 % of mu N, so the check must fail."""
    assert _friction_error(1e-3) == pytest.approx(1.0 - np.sqrt(0.5), abs=1e-12)


def _work_of_a_loop(normal: ContactNormal, steps: int = 2000) -> float:
    """Work of the frictionless ground on a rigid tire led once round a loop over waves, over the largest energy."""
    contact = _tire(Sinusoid(amplitude=0.02, wavelength=0.4, yaw=0.2, base=-0.15), normal=normal)
    p0, work, energy = TIRE.mesh.reference_coordinates(), 0.0, []
    for t in np.linspace(0.0, 2 * np.pi, steps, endpoint=False):  # trapezoidal rule on a period
        shift = np.array([0.05 * np.cos(t), 0.03 * np.sin(t), 0.004 * np.sin(t + 1.0)])
        rate = np.array([-0.05 * np.sin(t), 0.03 * np.cos(t), 0.004 * np.cos(t + 1.0)])
        p, v = p0.copy(), np.zeros_like(p0)
        p[:, 0] += shift
        v[:, 0] = rate
        account = contact.power(p, v)
        work, energy = work + account.power * 2 * np.pi / steps, [*energy, account.energy]
    assert min(energy) >= 0.0
    assert max(energy) > 0.05
    return abs(work) / max(energy)


def test_closed_path_costs_no_work() -> None:
    """Tolerance 1e-6 of the stored energy: the rule's error where points begin to touch (measured 3e-7)."""
    assert _work_of_a_loop(ContactNormal.TERRAIN) < 1e-6


def test_tires_own_normal_costs_work() -> None:
    """Negative control: the normal of thesis eq. 2.22 has no potential."""
    assert _work_of_a_loop(ContactNormal.SURFACE) > 1e-2


def _field_errors(damage: Callable[[HeightField], HeightField] = lambda field: field) -> np.ndarray:
    """Relative error of the tire's contact force on sampled waves, spacing 40, 20 and 10 mm."""
    waves = Sinusoid(amplitude=0.02, wavelength=0.3, yaw=0.3, base=-0.1425)
    p = TIRE.mesh.reference_coordinates()
    rest, errors = np.zeros_like(p), []
    places = [np.array([x, y, 0.01]) for x in (0.0, 0.07, 0.13) for y in (0.0, 0.09)]
    for n in (21, 41, 81):
        line, error, size = np.linspace(-0.4, 0.4, n), 0.0, 0.0
        sampled = _tire(damage(sampled_terrain(waves, line, line)))
        for place in places:
            q = p + np.eye(4)[0][:, None] * place
            exact = _tire(waves).force(q, rest)
            error, size = error + np.linalg.norm(sampled.force(q, rest) - exact), size + np.linalg.norm(exact)
        errors.append(error / size)
    return np.array(errors)


def test_height_field_converges_to_the_surface_it_samples() -> None:
    errors = _field_errors()
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 2.5), errors
    assert errors[-1] < 5e-3


def test_wrong_heights_do_not_converge() -> None:
    """Negative control: heights 1 % too large about the mean level."""

    def taller(field: HeightField) -> HeightField:
        heights = -0.1425 + 1.01 * (field.heights + 0.1425)
        return HeightField(heights=heights, spacing=field.spacing, origin=field.origin)

    errors = _field_errors(taller)
    assert np.log2(errors[1] / errors[2]) < 1.0


def test_turned_tire_on_turned_ground() -> None:
    """Objectivity: tire and slope turned together by any rotation turn the generalised forces with them."""
    p = TIRE.mesh.reference_coordinates() + 0.002 * np.random.default_rng(4).normal(size=(len(TIRE.mesh.points), 4, 3))
    v = np.random.default_rng(5).normal(size=p.shape)
    law = ContactLaw(stiffness=K, damping=1.0, friction=0.7, slip_velocity=0.1)
    level = _tire(inclined_plane(0.0, height=-0.135), law).force(p, v)
    c, s = np.cos(0.3), np.sin(0.3)
    R = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])  # the plane's normal becomes (-sin, 0, cos)
    turned = _tire(inclined_plane(0.3, height=-0.135 / c), law).force(p @ R.T, v @ R.T)
    assert np.abs(level).max() > 1.0
    np.testing.assert_allclose(turned, level @ R.T, atol=1e-9)
    assert np.abs(turned - level).max() > 1e-2 * np.abs(level).max()
