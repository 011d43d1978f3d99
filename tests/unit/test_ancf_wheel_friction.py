"""Friction of a rolling wheel: its derivative, the pull between Newton steps, what a unit of pressure does."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ancf_reduced.wheel_motion.friction import Friction, Pressed, Rubbing

Array = NDArray[np.float64]
FRICTION = Friction(coefficient=0.6, slip_velocity=1e-3)
FREE = 7


def pressed(count: int = 4) -> Pressed:
    random = np.random.default_rng(3)
    normals = random.standard_normal((count, 3))
    return Pressed(
        force=random.uniform(1.0, 5.0, count),
        normals=normals / np.linalg.norm(normals, axis=1)[:, None],
        slopes=csr_array(random.standard_normal((3 * count, FREE))),
        ways=random.standard_normal((count, 3, 3)),
    )


def on_coordinates(points: Pressed, v: Array) -> Array:
    """The forces on all coordinates, pressure by pressure as `Rubbing.leaning` has them."""
    rubbing = Rubbing.of(FRICTION, points, v)
    return np.asarray(rubbing.leaning(np.arange(len(points.force)), len(points.force)).T @ points.force)


def test_what_a_unit_of_pressure_does_is_the_force_of_the_points() -> None:
    points, v = pressed(), 1e-3 * np.random.default_rng(1).standard_normal(FREE + 3)
    force = Rubbing.of(FRICTION, points, v).force
    own = points.slopes.T @ force.ravel()
    np.testing.assert_allclose(on_coordinates(points, v)[:FREE], own, rtol=1e-12)
    np.testing.assert_allclose(on_coordinates(points, v)[FREE:], np.einsum("pi,pik->k", force, points.ways), rtol=1e-12)
    assert (np.linalg.norm(force, axis=1) <= 0.6 * points.force).all()


def test_viscosity_is_the_derivative_where_the_pull_is_that_of_the_rates() -> None:
    """Central differences; with another pull it is not, which is the control."""
    points, v = pressed(), 1e-3 * np.random.default_rng(1).standard_normal(FREE + 3)
    step = 1e-8
    units = np.eye(FREE + 3)
    rows = [(on_coordinates(points, v + step * e) - on_coordinates(points, v - step * e)) / (2.0 * step) for e in units]
    exact = -np.stack(rows, axis=1)

    def full(pull: Array | None) -> Array:
        inner, border = Rubbing.of(FRICTION, points, v, pull).by_rate()
        return np.concatenate([np.concatenate([inner.toarray(), border[:FREE]], axis=1), border.T], axis=0)

    size = np.abs(exact).max()
    np.testing.assert_allclose(full(None), exact, atol=1e-5 * size)
    assert np.abs(full(np.zeros((4, 3))) - exact).max() > 0.1 * size
    assert np.linalg.eigvalsh(full(None)).min() > -1e-9 * size


@pytest.mark.parametrize("reverses", [1.0, -3.0])
def test_the_pull_after_a_step_is_no_longer_than_one_and_lies_along_the_ground(reverses: float) -> None:
    points, v = pressed(), 1e-2 * np.random.default_rng(1).standard_normal(FREE + 3)
    rubbing = Rubbing.of(FRICTION, points, v)
    after = rubbing.after((reverses - 1.0) * v)
    assert (np.linalg.norm(after, axis=1) <= 1.0 + 1e-12).all()
    np.testing.assert_allclose((after * points.normals).sum(axis=1), 0.0, atol=1e-12)
    if reverses == 1.0:
        np.testing.assert_allclose(after, rubbing.lean / -0.6, rtol=1e-9, atol=1e-12)
