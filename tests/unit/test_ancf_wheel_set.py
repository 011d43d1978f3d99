"""Equal tires as one system: what a vehicle is told of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ancf_reduced.motion import linearisation
from ancf_reduced.motion.plate_system import PlateSystem, build_plate_system
from ancf_reduced.motion.vector_coordinates import with_reference_node
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_rig import damped_model
from ancf_reduced.tire.wheel_set import THESIS_LAW, WheelSet, wheel_set
from contracts.errors import InputError
from contracts.terrain import Plane

FloatArray = NDArray[np.float64]
TIRE = build_tire(replace(thesis_preset(), quadrature=(3, 3, 2)))
SET = wheel_set(TIRE, Plane(), 2, law=replace(THESIS_LAW, slip_velocity=0.1))


def pressed(wheels: WheelSet = SET) -> tuple[FloatArray, FloatArray]:
    """Two tires, differently deep in the ground, turned, deformed a little and in motion."""
    rng, z = np.random.default_rng(1), np.repeat(wheels.reference()[None], 2, axis=0)
    z = z @ Rotation.from_rotvec([0.02, 0.3, -0.01]).as_matrix().T
    z[:, wheels.position_rows] += np.array([[0.0, 0.4, 0.134], [0.5, -0.4, 0.130]])[:, None]
    z += 1e-3 * rng.normal(size=z.shape) * np.where(np.isin(np.arange(z.shape[1]), wheels.position_rows), 1, 5)[:, None]
    return z, 0.05 * rng.normal(size=z.shape)


def along(pattern: NDArray[np.int64], blocks: FloatArray, d: FloatArray) -> FloatArray:
    """Product of the matrices with directions (n_w, n, 3)."""
    out = np.zeros_like(d)
    for (row, column), block in zip(pattern, np.moveaxis(blocks, 1, 0), strict=True):
        out[:, row] += np.einsum("wij,wj->wi", block, d[:, column])
    return out


def test_tangents_are_derivatives_of_the_force() -> None:
    z, v = pressed()
    stiffness, damping = SET.tangents(z, v)
    d, h = np.random.default_rng(2).normal(size=z.shape), 1e-7
    by_position = -(SET.force(z + h * d, v) - SET.force(z - h * d, v)) / (2.0 * h)
    by_rate = -(SET.force(z, v + h * d) - SET.force(z, v - h * d)) / (2.0 * h)
    for expected, blocks in ((by_position, stiffness), (by_rate, damping)):
        np.testing.assert_allclose(along(SET.pattern, blocks, d), expected, atol=1e-6 * np.abs(expected).max())


def test_each_tire_is_a_tire_of_its_own() -> None:
    z, v = pressed()
    one = wheel_set(TIRE, Plane(), 1, law=SET.contact.law)
    for k in range(2):
        np.testing.assert_allclose(SET.force(z, v)[k], one.force(z[k : k + 1], v[k : k + 1])[0], rtol=1e-11, atol=1e-9)
    system: PlateSystem = build_plate_system(TIRE.model, with_reference_node(TIRE.tie), gravity=np.array([0, 0, -3.0]))
    np.testing.assert_allclose(SET.mass, system.mass.toarray(), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(SET.weight[:, None] * [0.0, 0.0, -3.0], system.dead_load, rtol=1e-12, atol=1e-15)


def test_contacts_sum_up_to_the_force_on_the_tire() -> None:
    """Elastic and damping forces have no resultant: what is left on all positions is the ground's."""
    z, v = pressed()
    found, force = SET.contacts(z, v), SET.force(z, v)
    np.testing.assert_allclose(force[:, SET.position_rows].sum(axis=1), found.force, rtol=1e-9, atol=1e-9)
    assert np.all(found.load > 10.0)
    assert np.all(found.penetration > 1e-3)
    assert np.all(found.largest_pressure * 0.12 * 0.1425 > 1.0)
    np.testing.assert_allclose(found.patch_point[:, :2], z[:, -4, :2], atol=0.05)


def test_a_tire_in_the_air_feels_nothing() -> None:
    z, v = pressed()
    z[:, SET.position_rows, 2] += 0.1
    found = SET.contacts(z, v)
    assert found.load.max() == 0.0
    np.testing.assert_array_equal(found.patch_point, z[:, -4])


def test_the_account_is_that_of_the_power() -> None:
    """d(strain + contact)/dt and what is dissipated make up the power of the forces."""
    z, v = pressed()
    h, power = 1e-7, float(np.sum(SET.force(z, v) * v))
    now, before, after = (SET.energies(z + s * h * v, v) for s in (0.0, -1.0, 1.0))
    stored = (after.strain + after.contact - before.strain - before.contact) / (2.0 * h)
    assert -stored - now.damping - now.contact_damping - now.friction == pytest.approx(power, rel=1e-5)
    assert now.kinetic == pytest.approx(0.5 * float(np.sum(v * (SET.mass @ v))), rel=1e-12)


def test_no_wheels_are_refused() -> None:
    with pytest.raises(InputError, match=r"wheels = 0: must be 1 or more"):
        wheel_set(TIRE, Plane(), 0)


def test_viscosity_from_sparse_matrices_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tires of many plates have sparse matrices; the first mode's damping must not depend on that."""
    full = damped_model(TIRE, 0.05).viscosity
    monkeypatch.setattr(linearisation, "_SMALL", 0)
    assert damped_model(TIRE, 0.05).viscosity == pytest.approx(full, rel=1e-8)
    assert damped_model(TIRE, 0.06).viscosity != pytest.approx(full, rel=1e-8)
