"""Contact of a mesh with every kind of terrain: tangents, energy account, contact patch, coarse search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import ContactNormal, PlateContact
from ancf_reduced.plates.assembly import dense_matrix
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError
from contracts.height_field import sampled_terrain
from contracts.terrain import Plane, Terrain, inclined_plane
from contracts.terrain_ridges import HalfRound, Sinusoid, Step

TIRE = build_tire(thesis_preset())
LEVEL = -0.1335
LINE = np.linspace(-0.4, 0.4, 41)
WAVES = Sinusoid(amplitude=0.01, wavelength=0.2, yaw=0.3, base=LEVEL)
SHAPES: dict[str, Terrain] = {
    "plane": Plane(offset=LEVEL),
    "slope": inclined_plane(0.3, 0.7, LEVEL),
    "step": Step(rise=0.02, edge_radius=0.015, position=0.02, yaw=0.5, base=LEVEL),
    "half-round": HalfRound(radius=0.02, yaw=0.1, position=0.01, base=LEVEL),
    "sinusoid": WAVES,
    "field": sampled_terrain(WAVES, LINE, LINE),
}
LAW = ContactLaw(stiffness=1000.0, damping=5.0, damping_depth=0.003, friction=0.6, slip_velocity=0.02)
CASES = [(name, normal) for name in SHAPES for normal in ContactNormal]
PENALTY = ContactLaw(stiffness=1000.0)


def _state() -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and rates of a deformed tire in motion."""
    p, rng = TIRE.mesh.reference_coordinates(), np.random.default_rng(1)
    noise, rates = rng.normal(size=(2, *p.shape))
    return p + noise * np.array([0.002, 0.03, 0.03, 0.03])[:, None], rates * np.array([0.05, 0.3, 0.3, 0.3])[:, None]


P, V = _state()


def _contact(terrain: Terrain, law: ContactLaw, normal: ContactNormal = ContactNormal.TERRAIN) -> PlateContact:
    return PlateContact(grid=TIRE.grid, terrain=terrain.pieces(), law=law, normal=normal)


@pytest.mark.parametrize(("name", "normal"), CASES)
def test_tangents_are_minus_the_derivatives_of_the_force(name: str, normal: ContactNormal) -> None:
    contact = _contact(SHAPES[name], LAW, normal)
    by_position, by_rate = (dense_matrix(TIRE.mesh, K) for K in contact.tangents(P, V))
    step = 1e-7 * np.random.default_rng(2).normal(size=P.shape)
    sides = [contact.patch(P + sign * step, V) for sign in (-1, 1)]
    assert np.array_equal(sides[0].points, sides[1].points)  # no point switches
    assert len(sides[0].points) > 15
    for matrix, behind, ahead in (
        (by_position, contact.force(P - step, V), contact.force(P + step, V)),
        (by_rate, contact.force(P, V - step), contact.force(P, V + step)),
    ):
        expected = (matrix @ step.ravel()).reshape(step.shape)
        np.testing.assert_allclose((behind - ahead) / 2, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


def test_damaged_tangents_fail_the_same_check() -> None:
    """Negative control: without the terrain's curvature, or without friction, the check must fail."""
    step = 1e-7 * np.random.default_rng(2).normal(size=P.shape)
    contact = _contact(WAVES, LAW)
    for damaged in (_contact(SHAPES["plane"], LAW), _contact(WAVES, replace(LAW, friction=0.0))):
        expected = (dense_matrix(TIRE.mesh, damaged.tangents(P, V)[0]) @ step.ravel()).reshape(step.shape)
        difference = (contact.force(P - step, V) - contact.force(P + step, V)) / 2
        assert np.abs(difference - expected).max() > 1e-2 * np.abs(expected).max()


@pytest.mark.parametrize("name", SHAPES)
def test_frictionless_tangent_is_symmetric(name: str) -> None:
    tangent = dense_matrix(TIRE.mesh, _contact(SHAPES[name], PENALTY).tangents(P, V)[0])
    np.testing.assert_allclose(tangent, tangent.T, rtol=0, atol=1e-12 * np.abs(tangent).max())


@pytest.mark.parametrize("name", SHAPES)
def test_force_is_minus_the_derivative_of_the_stored_energy(name: str) -> None:
    contact = _contact(SHAPES[name], PENALTY)
    step = 1e-7 * np.random.default_rng(3).normal(size=P.shape)
    fall = (contact.power(P - step, V).energy - contact.power(P + step, V).energy) / 2
    assert fall == pytest.approx(float((contact.force(P, V) * step).sum()), rel=1e-6)


@pytest.mark.parametrize(("name", "normal"), CASES)
def test_power_is_what_is_stored_and_dissipated(name: str, normal: ContactNormal) -> None:
    """f . v = -dE/dt - damping - friction; with the tire's own normal only the first side is an identity."""
    contact, h = _contact(SHAPES[name], LAW, normal), 1e-7
    account = contact.power(P, V)
    assert account.power == pytest.approx(float((contact.force(P, V) * V).sum()), rel=1e-12)
    assert min(account.damping, account.friction, account.energy) > 0.0
    stored = (contact.power(P + h * V, V).energy - contact.power(P - h * V, V).energy) / (2 * h)
    balance = account.power + stored + account.damping + account.friction
    if normal is ContactNormal.TERRAIN:
        assert abs(balance) < 1e-7 * abs(account.power)
    else:
        assert abs(balance) > 1e-4 * abs(account.power)


@pytest.mark.parametrize(("name", "normal"), CASES)
def test_coarse_search_changes_nothing(name: str, normal: ContactNormal) -> None:
    contact = _contact(SHAPES[name], LAW, normal)
    thorough = replace(contact, coarse_search=False)
    for shift in ([0.0, 0.0, 0.0], [0.05, -0.1, 0.002], [-0.05, 0.1, 0.0], [0.0, 0.0, 0.1]):
        p = P.copy()
        p[:, 0] += shift
        force = contact.force(p, V)
        assert np.array_equal(force, thorough.force(p, V))
        assert bool(np.any(force)) == (shift[2] < 0.1)


def test_patch_adds_up_to_the_generalised_force() -> None:
    """Resultant and moment; the moment of generalised forces is sum over the vectors c of p_c x Q_c."""
    contact, about = _contact(WAVES, LAW), np.array([0.1, -0.2, 0.3])
    patch, Q = contact.patch(P, V), contact.force(P, V)
    np.testing.assert_allclose(Q[:, 0].sum(axis=0), patch.resultant, rtol=1e-12)
    moment = np.cross(P, Q).sum(axis=(0, 1)) - np.cross(about, patch.resultant)
    np.testing.assert_allclose(patch.moment(about), moment, atol=1e-12 * np.abs(moment).max())
    np.testing.assert_allclose(np.einsum("qi,qi->q", patch.force, patch.normal), patch.normal_force, rtol=1e-12)
    assert np.all(np.einsum("qi,qi->q", patch.force, patch.slip) <= 0.0)
    carried = TIRE.grid.positions(P)[patch.plates, patch.points]  # the rim's plates come first
    np.testing.assert_allclose(patch.position, carried, atol=1e-15)


def test_patch_without_contact_is_empty() -> None:
    patch = _contact(Plane(offset=-1.0), LAW).patch(P, V)
    assert (len(patch.points), patch.load, patch.total_area) == (0, 0.0, 0.0)
    assert (patch.length(np.array([1.0, 0.0, 0.0])), patch.penetration_max, patch.penetration_mean) == (0.0, 0.0, 0.0)


def test_patch_measures_length_area_and_pressure() -> None:
    """Undeformed tire on a plane, with the spoke down: rows at a node count for both plates, half an area each."""
    p = TIRE.mesh.reference_coordinates()
    patch = _contact(SHAPES["plane"], PENALTY).patch(p, np.zeros_like(p))
    assert len(patch.points) == 40  # two rows of ten on each of two plates
    spacing = TIRE.grid.positions(p)[0, [0, 10], 0]
    assert patch.length(np.array([1.0, 0.0, 0.0])) == pytest.approx(2 * abs(spacing[1] - spacing[0]))
    assert patch.length(np.array([0.0, 1.0, 0.0])) == pytest.approx(0.12)
    assert patch.pressure @ patch.area == pytest.approx(patch.load)
    assert patch.load == pytest.approx(1000.0 * patch.penetration.sum())
    assert 0.0 < patch.penetration_mean < patch.penetration_max == pytest.approx(0.1425 + LEVEL)


def test_face_turned_away_is_not_pressed_by_its_own_normal() -> None:
    """A tire wholly below the ground: with the surface's normal only its lower half is pressed."""
    p = TIRE.mesh.reference_coordinates()
    p[:, 0, 2] -= 0.5
    contact = _contact(Plane(), PENALTY, ContactNormal.SURFACE)
    patch = contact.patch(p, np.zeros_like(p))
    pressed = patch.normal_force > 0.0
    assert np.array_equal(pressed, patch.normal[:, 2] > 0.0)
    assert 0.4 < pressed.mean() < 0.6


def test_ground_beside_a_height_field_is_refused() -> None:
    p = P.copy()
    p[:, 0, 0] += 0.4
    contact = _contact(SHAPES["field"], LAW)
    for method in (contact.force, contact.power, contact.tangents, contact.patch):
        with pytest.raises(InputError, match="beside the height field"):
            method(p, V)
    p[:, 0, 2] += 0.1  # in the air nothing is asked of the field
    assert not np.any(contact.force(p, V))
