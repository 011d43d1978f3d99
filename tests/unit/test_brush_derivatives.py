"""Derivatives of wrench and state rate against differences of the forces, taken with other steps and real rotations."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contracts.height_field import sampled_terrain
from contracts.terrain import Plane, Terrain
from contracts.terrain_ridges import Crevasse, Sinusoid, Step
from rover_dynamics.tires.brush_force import HubMotions
from rover_dynamics.tires.brush_settings import BrushSettings, SlipLaw
from rover_dynamics.tires.brush_wheel import BrushWheels
from tests.brush_rig import RADIUS, motion, turned

FloatArray = NDArray[np.float64]
WAVES = Sinusoid(amplitude=0.01, wavelength=0.8, yaw=0.2)
CASES: dict[str, tuple[Terrain, HubMotions]] = {
    "plane": (Plane(), motion((0.1, 0.2, 0.12), turned(0.1, 0.3), (0.1, 0.02, -0.01), (0.05, 0.9, 0.1))),
    "standing": (Plane(), motion((0.0, 0.0, 0.12), None, (1e-4, 2e-4, 0.0), (0.0, 1e-4, 0.0))),
    "corner": (
        Step(rise=0.25, edge_radius=0.02, position=0.3),
        motion((0.3 - RADIUS + 0.01, 0.0, 0.125), None, (0.01, 0.005, 0.0), (0.0, 0.2, 0.0)),
    ),
    "crevasse": (
        Crevasse(width=0.15, depth=0.5, edge_radius=0.01, position=-0.07),
        motion((0.0, 0.0, RADIUS - 0.04), turned(0.05, 0.1), (0.02, 0.0, 0.0), (0.0, 0.2, 0.0)),
    ),
    "waves": (WAVES, motion((0.1, 0.0, 0.13), turned(0.1, 0.2), (0.1, 0.0, 0.0), (0.0, 0.8, 0.0))),
    "field": (
        sampled_terrain(WAVES, np.linspace(-0.5, 0.5, 52), np.linspace(-0.5, 0.5, 51)),
        motion((0.1, 0.003, 0.13), turned(0.1, 0.2), (0.1, 0.0, 0.0), (0.0, 0.8, 0.0)),
    ),
}


def differences(wheels: BrushWheels, at: HubMotions, state: FloatArray) -> FloatArray:
    """(6 + s, 12 + s) float: central differences, extrapolated from two steps, of the whole call."""
    n = 12 + wheels.n_state
    scales = np.concatenate([[1e-6] * 3, [1e-6] * 3, [2e-6] * 3, [1e-5] * 3, [1e-8] * wheels.n_state])

    def answer(change: FloatArray) -> FloatArray:
        R = Rotation.from_rotvec(change[3:6]).as_matrix() @ at.rotation[0]
        omega = at.angular_velocity[0] + change[9:12]
        moved = motion(at.position[0] + change[:3], R, at.velocity[0] + change[6:9], omega)
        found = wheels.forces(moved, state + change[None, 12:])
        return np.concatenate([found.wrench[0], found.rate[0]])

    columns = []
    for unit, step in zip(np.eye(n), scales, strict=True):
        near, far = ((answer(h * unit) - answer(-h * unit)) / (2 * h) for h in (step, 2 * step))
        columns.append((4 * near - far) / 3)
    return np.array(columns).T


@pytest.mark.parametrize("law", list(SlipLaw))
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("stretch", [1e-4, 2e-3], ids=["sticking", "sliding"])
def test_derivatives_are_those_of_the_forces(case: str, law: SlipLaw, stretch: float) -> None:
    terrain, at = CASES[case]
    wheels = BrushWheels(terrain, 1, settings=BrushSettings(slip_law=law))
    state = stretch * np.resize([0.8, 0.5], (1, wheels.n_state))
    kept = state.copy()
    found, wanted = wheels.derivatives(at, state)[0], differences(wheels, at, state)
    np.testing.assert_array_equal(state, kept)
    scale = np.maximum(np.abs(wanted).max(axis=0, keepdims=True), 1.0)
    assert np.abs((found - wanted) / scale).max() < 2e-5


def test_negative_control_a_sign_in_one_column_is_seen() -> None:
    terrain, at = CASES["plane"]
    wheels = BrushWheels(terrain, 1)
    state = np.full((1, 2), 1e-4)
    found, wanted = wheels.derivatives(at, state)[0], differences(wheels, at, state)
    found[:, 4] *= -1.0
    assert np.abs((found - wanted) / np.maximum(np.abs(wanted).max(axis=0), 1.0)).max() > 0.1


def test_every_wheel_has_its_own() -> None:
    one, other = CASES["plane"][1], CASES["standing"][1]
    both = HubMotions(*(np.concatenate(pair) for pair in zip(one, other, strict=True)))
    state = np.array([[1e-4, 0.0], [0.0, 2e-4]])
    found = BrushWheels(Plane(), 2).derivatives(both, state)
    for k, at in enumerate((one, other)):
        np.testing.assert_array_equal(found[k], BrushWheels(Plane(), 1).derivatives(at, state[k : k + 1])[0])
