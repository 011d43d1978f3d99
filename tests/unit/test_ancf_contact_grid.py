"""Contact points: where they lie, the sign of the gap, force and exact tangent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact_grid import contact_tangent, plane_contact
from ancf_reduced.tire_mesh import build_tire
from ancf_reduced.tire_preset import thesis_preset
from ancf_reduced.tire_surfaces import surface_grid
from contracts.frames import ground_direction_h

TIRE = build_tire(thesis_preset())
P0 = TIRE.mesh.reference_coordinates()
DOWN = ground_direction_h(0.3)


def _deformed() -> np.ndarray:
    noise = np.random.default_rng(10).normal(size=P0.shape)
    return np.asarray(P0 + noise * np.array([0.003, 0.05, 0.05, 0.05])[:, None])


def test_edge_points_lie_on_the_outer_face() -> None:
    face = surface_grid(TIRE.mesh, P0, n=10, zeta=0.5)[TIRE.mesh.plates_of("rim")]
    np.testing.assert_allclose(TIRE.grid.positions(P0), face.reshape(-1, 3), atol=1e-15)


def test_layouts_place_their_points() -> None:
    assert sorted({round(float(x), 12) for x in TIRE.grid.xi[:, 0]})[:2] == [0.0, round(1 / 9, 12)]
    centres = build_tire(replace(thesis_preset(), contact_layout="centres")).grid
    assert sorted({round(float(x), 12) for x in centres.xi[:, 1]})[:2] == [0.05, 0.15]


def test_gap_is_open_positive_and_force_never_tensile() -> None:
    away = plane_contact(TIRE.grid, P0, DOWN, 0.2, 1000.0)
    assert away.gap.min() > 0.0
    assert (away.load, away.penetration_max, away.penetration_mean) == (0.0, 0.0, 0.0)
    assert not np.any(away.force)
    touching = plane_contact(TIRE.grid, P0, DOWN, 0.135, 1000.0)
    positions = TIRE.grid.positions(P0)
    np.testing.assert_allclose(touching.gap, 0.135 - positions @ DOWN, atol=1e-15)
    assert touching.pressure_force.min() == 0.0
    assert 0.0 < touching.penetration_mean < touching.penetration_max


def test_resultant_is_the_load_along_the_planes_normal() -> None:
    contact = plane_contact(TIRE.grid, _deformed(), DOWN, 0.135, 1000.0)
    np.testing.assert_allclose(contact.force[:, 0].sum(axis=0), -contact.load * DOWN, atol=1e-10)


def test_force_is_minus_the_derivative_of_the_penalty_energy() -> None:
    p, step = _deformed(), 1e-6 * np.random.default_rng(11).normal(size=P0.shape)

    def energy(q: np.ndarray) -> float:
        gap = plane_contact(TIRE.grid, q, DOWN, 0.135, 1000.0).gap
        return float(0.5 * 1000.0 * np.sum(np.minimum(gap, 0.0) ** 2))

    force = plane_contact(TIRE.grid, p, DOWN, 0.135, 1000.0).force
    assert (energy(p - step) - energy(p + step)) / 2 == pytest.approx(float((force * step).sum()), rel=1e-6)


def test_tangent_is_minus_the_derivative_of_the_force() -> None:
    p, step = _deformed(), 1e-7 * np.random.default_rng(12).normal(size=P0.shape)
    contact = plane_contact(TIRE.grid, p, DOWN, 0.135, 1000.0)
    assert np.abs(contact.gap).min() > 1e-6  # no point switches within the step
    expected = (contact_tangent(TIRE.grid, contact, DOWN, 1000.0) @ step.ravel()).reshape(step.shape)
    ahead = plane_contact(TIRE.grid, p + step, DOWN, 0.135, 1000.0).force
    behind = plane_contact(TIRE.grid, p - step, DOWN, 0.135, 1000.0).force
    np.testing.assert_allclose((behind - ahead) / 2, expected, rtol=0, atol=1e-6 * np.abs(expected).max())
