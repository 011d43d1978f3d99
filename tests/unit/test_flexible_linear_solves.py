"""Condensation of the tires onto their hubs by full and by sparse matrices is the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import refined_preset, thesis_preset
from ancf_reduced.tire.wheel_set import WheelSet, wheel_set
from contracts.terrain import Plane
from rover_dynamics.flexible import linear_solves
from rover_dynamics.flexible.linear_solves import CondensedTires, condense

FloatArray = NDArray[np.float64]
SAME, WEIGHTS = 1e-10, (1.3, 0.008, 4e-5)


@pytest.fixture(scope="module")
def tires() -> WheelSet:
    """Two tires of 16 plates, 96 free vectors each, damped and in contact."""
    preset = replace(refined_preset(thesis_preset(), 8, 2), quadrature=(3, 3, 2))
    return wheel_set(build_tire(preset), Plane(), 2)


def condensed(tires: WheelSet, weights: tuple[float, float, float] = WEIGHTS) -> CondensedTires:
    """Of deformed tires, 20 mm deep in the ground, that slide, with their hubs turned."""
    random, reference = np.random.default_rng(3), tires.reference()
    z = np.tile(reference, (2, 1, 1)) + 1e-3 * random.normal(size=(2, *reference.shape))
    z[:, tires.position_rows, 2] += tires.tire.preset.outer_radius - 0.02
    v = 0.1 * random.normal(size=z.shape)
    axes = np.linalg.qr(random.normal(size=(2, 3, 3)))[0]
    axes *= np.sign(np.linalg.det(axes))[:, None, None]
    assert (tires.contacts(z, v).load > 10.0).all()
    c, w_v, w_q = weights
    return condense(tires, tires.step_matrix(z, v, (w_q, w_v)), axes, c)


def apart(one: CondensedTires, other: CondensedTires) -> float:
    """Largest relative difference of all parts."""
    rho = np.random.default_rng(5).normal(size=one.carry[:, 0].shape)
    pairs = [(getattr(one, name), getattr(other, name)) for name in ("follow", "carry", "stiffness")]
    pairs.append((one.solve(rho), other.solve(rho)))
    return max(float(np.abs(a - b).max() / np.abs(a).max()) for a, b in pairs)


def test_full_and_sparse_agree(tires: WheelSet, monkeypatch: pytest.MonkeyPatch) -> None:
    full = condensed(tires)
    monkeypatch.setattr(linear_solves, "_DENSE", 0)
    sparse = condensed(tires)
    print(f"\n{apart(full, sparse):.1e}")
    assert apart(full, sparse) < SAME


def test_other_weights_are_noticed(tires: WheelSet, monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: one weight off by a millionth."""
    full = condensed(tires)
    monkeypatch.setattr(linear_solves, "_DENSE", 0)
    assert apart(full, condensed(tires, (WEIGHTS[0], WEIGHTS[1], WEIGHTS[2] * (1.0 + 1e-6)))) > SAME
