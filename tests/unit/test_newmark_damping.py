"""What the settling steps are: Newmark's method with beta = gamma = 1, and no implicit Euler method.

Claim: on q'' = -w^2 q a step of very large w dt scales motions by 1 / sqrt 2, one of small w dt loses amplitude in
proportion to dt. Source: roots of Newmark's amplification matrix (Hughes 1987, section 9.1, from memory). Negative
control: the implicit Euler method's one step differs.
"""

from __future__ import annotations

import numpy as np
import pytest

from rover_dynamics.multibody.generalised_alpha import Method, damped_newmark


def _amplification(method: Method, z: float) -> np.ndarray:
    """(q, dt v, dt^2 a) of the next step from those of this one, for q'' = -w^2 q and z = w dt; alphas are 0."""
    b, g = method.beta, method.gamma
    unknown = np.array([[1.0, 0.0, -b], [0.0, 1.0, -g], [z * z, 0.0, 1.0]])
    known = np.array([[1.0, 1.0, 0.5 - b], [0.0, 1.0, 1.0 - g], [0.0, 0.0, 0.0]])
    return np.linalg.solve(unknown, known)


def _radius(z: float) -> float:
    return float(np.abs(np.linalg.eigvals(_amplification(damped_newmark(1e-9, 5), z))).max())


def test_high_frequencies_lose_a_factor_of_sqrt_two_a_step() -> None:
    assert (damped_newmark(1e-9, 5).alpha_m, damped_newmark(1e-9, 5).alpha_f) == (0.0, 0.0)
    assert _radius(1e6) == pytest.approx(np.sqrt(0.5), rel=1e-6)


def test_low_frequencies_are_damped_in_proportion_to_the_step() -> None:
    losses = [1.0 - _radius(z) for z in (0.01, 0.02)]
    assert losses[0] > 0.0
    assert losses[1] / losses[0] == pytest.approx(4.0, rel=0.05)  # per step; per time half of that


def test_negative_control_it_is_not_the_implicit_euler_method() -> None:
    z = 0.3
    euler = np.linalg.solve(np.array([[1.0, -1.0], [z * z, 1.0]]), np.eye(2))  # (q, dt v)
    state, rough = np.array([1.0, 0.0, -z * z]), np.array([1.0, 0.0])
    for _ in range(3):
        state, rough = _amplification(damped_newmark(1e-9, 5), z) @ state, euler @ rough
    assert abs(state[0] - rough[0]) > 0.05
