"""The tire protocol: motions are checked, and the brush tire is a tire."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.terrain import Plane
from contracts.tire import HubMotion, Tire
from rover_dynamics.tires.brush_wheel import BrushTire

AT_REST = {
    "position": np.array([0.0, 0.0, 0.12]),
    "rotation": np.eye(3),
    "velocity": np.zeros(3),
    "angular_velocity": np.zeros(3),
}


def test_brush_tire_is_a_tire() -> None:
    tire: Tire = BrushTire(Plane())
    response = tire.respond(HubMotion(**AT_REST), tire.initial_state(), 0.0)
    np.testing.assert_allclose(response.wrench.force, [0.0, 0.0, 8250.0 * 0.0225], rtol=1e-12)
    np.testing.assert_allclose(response.wrench.moment, 0.0, atol=1e-12)
    np.testing.assert_allclose(response.output.patch_point, 0.0, atol=1e-12)
    assert response.output.penetration == pytest.approx(0.0225)
    assert response.output.normal_load == pytest.approx(185.625)
    assert response.state_rate.shape == tire.initial_state().shape == (2,)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("position", np.zeros(2), "hub position"),
        ("velocity", np.array([np.nan, 0.0, 0.0]), "hub velocity"),
        ("rotation", 2.0 * np.eye(3), "orthonormal"),
        ("rotation", np.diag([1.0, -1.0, 1.0]), "right-handed"),
        ("angular_velocity", np.zeros((3, 1)), "hub angular velocity"),
    ],
)
def test_bad_motions_are_refused(name: str, value: np.ndarray, message: str) -> None:
    with pytest.raises(InputError, match=message):
        HubMotion(**{**AT_REST, name: value})
