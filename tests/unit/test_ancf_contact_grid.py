"""Contact points: where they lie, what share of the face they stand for, and the hull that encloses them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.grid import build_contact_grid, contact_grid
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.surfaces import surface_grid
from contracts.errors import InputError

TIRE = build_tire(thesis_preset())
P0 = TIRE.mesh.reference_coordinates()
RIM = TIRE.mesh.plates_of("rim")


def _deformed() -> np.ndarray:
    noise = np.random.default_rng(10).normal(size=P0.shape)
    return np.asarray(P0 + noise * np.array([0.003, 0.05, 0.05, 0.05])[:, None])


def test_edge_points_lie_on_the_outer_face() -> None:
    p = _deformed()
    face = surface_grid(TIRE.mesh, p, n=10, zeta=0.5)[RIM]
    np.testing.assert_allclose(TIRE.grid.positions(p), face.reshape(-1, 100, 3), atol=1e-15)


def test_layouts_place_their_points() -> None:
    assert sorted({round(float(x), 12) for x in TIRE.grid.xi[:, 0]})[:2] == [0.0, round(1 / 9, 12)]
    centres = build_tire(replace(thesis_preset(), contact_layout="centres")).grid
    assert sorted({round(float(x), 12) for x in centres.xi[:, 1]})[:2] == [0.05, 0.15]


@pytest.mark.parametrize("layout", ["edges", "centres"])
def test_shares_add_up_to_the_outer_cylinder(layout: str) -> None:
    """2 pi R w less what the shortened directors of 24 plates take away."""
    tire = build_tire(replace(thesis_preset(), circumferential_plates=24, contact_layout=layout))
    assert tire.grid.share.sum() == pytest.approx(1.0)
    carrier, point = np.indices(tire.grid.tables.interpolation.shape[:2]).reshape(2, -1)
    area = tire.grid.areas(tire.mesh.reference_coordinates(), carrier, point).sum()
    assert area == pytest.approx(2 * np.pi * 0.1425 * 0.12, rel=2e-3)


def test_areas_are_those_of_the_points_asked_for() -> None:
    """On a deformed tire, where no two are alike: by pairs and one at a time, and as a small parallelogram says."""
    q, step = _deformed(), 1e-6
    carrier, point = np.array([0, 3, 1, 3, 2]), np.array([7, 0, 99, 58, 44])
    found = TIRE.grid.areas(q, carrier, point)
    alone = [TIRE.grid.areas(q, np.array([c]), np.array([k]))[0] for c, k in zip(carrier, point, strict=True)]
    np.testing.assert_array_equal(found, alone)
    assert len(set(np.round(found / TIRE.grid.share[point], 9))) == 5
    inner = TIRE.grid.xi[44]
    xi = inner + step * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    corner, one, two = contact_grid(TIRE.mesh, RIM, xi, np.ones(3)).positions(q)[2]
    area = np.linalg.norm(np.cross(one - corner, two - corner)) / step**2
    assert found[4] == pytest.approx(TIRE.grid.share[44] * area, rel=1e-4)
    assert TIRE.grid.areas(q, carrier[:0], point[:0]).shape == (0,)


def test_points_lie_in_the_hull_of_their_face() -> None:
    e = TIRE.mesh.normalised(_deformed(), TIRE.model.frame)[RIM]
    hull = np.einsum("sq,jsi->jqi", TIRE.grid.tables.hull, e)
    positions = TIRE.grid.positions(_deformed())
    for direction in np.random.default_rng(11).normal(size=(200, 3)):
        assert np.all((hull @ direction).max(axis=1) > (positions @ direction).max(axis=1) - 1e-12)
    corners = TIRE.grid.positions(_deformed())[:, [0, 9, 90, 99]]  # a Bezier patch passes through its corners
    np.testing.assert_allclose(hull[:, [0, 3, 12, 15]], corners, atol=1e-12)


def test_slopes_point_out_of_either_face() -> None:
    for zeta in (-0.5, 0.5):
        xi = np.array([[0.3, 0.6, zeta]])
        grid = contact_grid(TIRE.mesh, RIM, xi, np.ones(1))
        a = grid.tables.slopes @ P0[grid.tables.nodes].reshape(-1, 1, 16, 3)
        outwards = np.cross(a[:, 0, 0], a[:, 0, 1])
        radial = grid.positions(P0)[:, 0] * [1.0, 0.0, 1.0]
        assert np.all(np.sign(np.einsum("ji,ji->j", outwards, radial)) == np.sign(zeta))


def test_points_off_the_faces_are_refused() -> None:
    with pytest.raises(InputError, match="zeta"):
        contact_grid(TIRE.mesh, RIM, np.array([[0.5, 0.5, 0.0]]), np.ones(1))
    with pytest.raises(InputError, match="contact points"):
        build_contact_grid(TIRE.mesh, RIM, (1, 10))
