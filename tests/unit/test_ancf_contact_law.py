"""The force of one contact point: limits, signs, derivatives, and what its damping takes."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.contact.law import ContactLaw, normal_force, point_force, point_tangents, slip
from contracts.errors import InputError

LAW = ContactLaw(stiffness=1000.0, damping=20.0, damping_depth=0.004, friction=0.6, slip_velocity=0.02)
UP = (0.0, 0.0, 1.0)
SOFT = ContactLaw(stiffness=1000.0, dissipation=0.5, friction=0.6, slip_velocity=0.02)
"""Hunt and Crossley's damping."""
PRINTED = ContactLaw(stiffness=1000.0, damping=100.0)


def test_damping_never_pulls() -> None:
    law = ContactLaw(stiffness=1000.0, damping=20.0).numbers
    assert normal_force(law, 0.002, 0.01) == pytest.approx(2.2)
    assert normal_force(law, 0.002, -0.09) == pytest.approx(0.2)
    assert normal_force(law, 0.002, -0.11) == 0.0


def test_damping_depth_lets_the_force_begin_at_zero() -> None:
    assert normal_force(LAW.numbers, 1e-9, 1.0) < 1e-5
    assert normal_force(LAW.numbers, 0.004, 1.0) == pytest.approx(24.0)
    assert normal_force(ContactLaw(stiffness=1000.0, damping=20.0).numbers, 1e-9, 1.0) == pytest.approx(20.0)


def test_hunt_and_crossleys_force_begins_at_zero_and_never_pulls() -> None:
    law = SOFT.numbers
    assert normal_force(law, 0.004, 0.3) == pytest.approx(4.0 * 1.15)
    assert normal_force(law, 0.004, -0.3) == pytest.approx(4.0 * 0.85)
    assert normal_force(law, 1e-9, 5.0) < 1e-5
    assert normal_force(law, 0.004, -2.5) == 0.0
    assert SOFT.is_damped
    assert not SOFT.undamped().is_damped


@pytest.mark.parametrize("law", [SOFT, LAW, PRINTED])
def test_a_damper_takes_energy_and_gives_none(law: ContactLaw) -> None:
    """(N - k delta) delta' >= 0 at every penetration and rate; negative control: a damper of the wrong sign gives."""
    for depth in np.geomspace(1e-7, 0.05, 20):
        for rate in (*-np.geomspace(1e-4, 10.0, 12), *np.geomspace(1e-4, 10.0, 12)):
            N = normal_force(law.numbers, float(depth), float(rate))
            assert N >= 0.0
            assert (N - law.stiffness * depth) * rate >= 0.0
    wrong = law.numbers._replace(damping=-law.damping, dissipation=-law.dissipation)
    assert (normal_force(wrong, 0.004, 0.3) - 4.0) * 0.3 < 0.0


def _rebound(law: ContactLaw, speed: float, mass: float = 0.1) -> float:
    """Speed after a mass has struck the ground, over that before; symplectic steps of 1e-5 of its period."""
    depth, rate, dt = 0.0, speed, 2e-5 * np.pi * np.sqrt(mass / law.stiffness)
    while rate > 0.0 or depth > 0.0:
        rate -= dt * normal_force(law.numbers, depth, rate) / mass if depth > 0.0 else 0.0
        depth += dt * rate
    return -rate / speed


def test_a_point_rebounds_as_hunt_and_crossley_say() -> None:
    """1 - 2/3 chi v up to the square, whatever the mass; negative control: c as printed follows no such line."""
    for mass in (0.1, 0.02):
        assert _rebound(SOFT, 0.27, mass) == pytest.approx(1.0 - 0.27 / 3.0, abs=0.009)
    assert 1.0 - _rebound(SOFT, 0.27) == pytest.approx(3.0 * (1.0 - _rebound(SOFT, 0.09)), rel=0.06)
    printed = ContactLaw(stiffness=1000.0, damping=5.0)
    assert 1.0 - _rebound(printed, 0.27) == pytest.approx(1.0 - _rebound(printed, 0.09), rel=0.01)


def test_friction_opposes_slip_and_is_smooth_at_rest() -> None:
    for speed, share in ((0.0, 0.0), (0.02, np.sqrt(0.5)), (0.2, 1.0 / np.sqrt(1.01))):
        f = point_force(LAW.numbers, 10.0, UP, (0.6 * speed, -0.8 * speed, -0.3))
        np.testing.assert_allclose(f, [-6.0 * 0.6 * share, 6.0 * 0.8 * share, 10.0], atol=1e-14)


@pytest.mark.parametrize("law", [LAW, SOFT, ContactLaw(stiffness=1000.0, damping=20.0, dissipation=0.5)])
def test_tangents_are_derivatives(law: ContactLaw) -> None:
    """By position (through gap and terrain's normal), velocity and the normal itself, each with finite differences."""
    rng = np.random.default_rng(9)
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    m, n, v = Q[:, 0], Q @ [0.8, 0.6, 0.0], rng.normal(size=3) * 0.05
    H = 8.0 * np.outer(Q[:, 1], Q[:, 1]) + 3.0 * np.outer(Q[:, 2], Q[:, 2])
    r = np.zeros(3)

    def force(r: np.ndarray, v: np.ndarray, n: np.ndarray) -> np.ndarray:
        gap, normal = -0.003 + m @ r, m + H @ r
        return np.array(point_force(law.numbers, normal_force(law.numbers, -gap, -normal @ v), tuple(n), tuple(v)))

    A, h = np.empty((3, 3, 3)), 1e-7
    curvature = tuple(H[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]])
    assert point_tangents(law.numbers, (-0.003, tuple(m), curvature), tuple(n), tuple(v), A)
    for which, expected in enumerate(A):
        for j in range(3):
            steps = [h * np.eye(3)[j] if which == k else 0.0 for k in range(3)]
            ahead, behind = (
                force(r + steps[0], v + steps[1], n + steps[2]),
                force(r - steps[0], v - steps[1], n - steps[2]),
            )
            np.testing.assert_allclose((ahead - behind) / (2 * h), expected[:, j], atol=1e-6 * np.abs(expected).max())


def test_no_force_has_no_tangent() -> None:
    flat = (0.0,) * 6
    assert not point_tangents(LAW.numbers, (-0.004, UP, flat), UP, (0.0, 0.0, 1.0), np.empty((3, 3, 3)))


def test_slip_lies_in_the_tangent_plane() -> None:
    n = (0.6, 0.0, 0.8)
    t, tau, size = slip(LAW.numbers, n, (1.0, 2.0, 3.0))
    assert np.dot(t, n) == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(np.array(t) / size, tau, atol=1e-15)


@pytest.mark.parametrize("name", ["stiffness", "slip_velocity", "damping", "friction", "damping_depth", "dissipation"])
def test_bad_numbers_are_refused(name: str) -> None:
    numbers = {"stiffness": 1.0, name: -1.0}
    with pytest.raises(InputError, match=f"contact {name.replace('_', ' ')}"):
        ContactLaw(**numbers)
