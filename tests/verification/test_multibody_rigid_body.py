"""Claim: a free asymmetric body turns as Jacobi's elliptic functions say; order 8, energy, momentum, events.

Source: Landau and Lifshitz, Mechanics, section 37, equations 37.8 to 37.10 (w1 = A cn, w2 = B sn, w3 = C dn).
Tolerances: 1e-8 of the spin over 8 s at 1e-11 a step; energy and momentum to 1e-9; order of fixed steps 8 within 0.7
(DOP853); touch-down to 1e-9 s. Negative control: a moment of inertia changed by 1 % is seen.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ellipj

from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.formulation import AbsoluteCoordinates
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.motion import Event, Motion, StepControl, integrate
from rover_dynamics.multibody.state import State, rotations
from rover_dynamics.multibody.tree_coordinates import TreeCoordinates
from rover_dynamics.multibody.verification.mechanisms import mechanical_energy

J = np.array([1.0, 2.0, 2.5])
W = np.array([0.3, 0.0, 2.0])
TIMES = np.linspace(0.0, 8.0, 9)
Make = type[AbsoluteCoordinates] | type[TreeCoordinates]


def free_body(J: np.ndarray = J) -> MultibodyModel:
    spinning = body("body", 2.0, J, velocity=(0.1, 0.2, 0.3), angular_velocity=W)
    return MultibodyModel(bodies=(spinning,), gravity=(0.0, 0.0, 0.0))


def elliptic_spin(t: np.ndarray) -> np.ndarray:
    """Angular velocity in body axes, (n, 3); J1 < J2 < J3 and M^2 > 2 E J2."""
    E2, M2 = J @ W**2, (J * W) @ (J * W)
    assert E2 * J[1] < M2
    tau = t * np.sqrt((J[2] - J[1]) * (M2 - E2 * J[0]) / np.prod(J))
    k2 = (J[1] - J[0]) * (E2 * J[2] - M2) / ((J[2] - J[1]) * (M2 - E2 * J[0]))
    sn, cn, dn, _ = ellipj(tau, k2)
    a = np.sqrt((E2 * J[2] - M2) / (J[0] * (J[2] - J[0])))
    b = np.sqrt((E2 * J[2] - M2) / (J[1] * (J[2] - J[1])))
    c = np.sqrt((M2 - E2 * J[0]) / (J[2] * (J[2] - J[0])))
    return np.stack([a * cn, b * sn, c * dn], axis=1)


def spin(motion: Motion) -> np.ndarray:
    return np.array([rotations(s.orientations)[0].T @ s.velocities[0, 3:] for s in motion.states])


def run(make: Make, model: MultibodyModel) -> Motion:
    return integrate(make(model), TIMES, StepControl(relative=1e-11, absolute=1e-12, largest=0.25))


@pytest.mark.parametrize("make", [AbsoluteCoordinates, TreeCoordinates])
def test_spin_is_that_of_elliptic_functions_and_energy_and_momentum_stay(make: Make) -> None:
    model = free_body()
    motion = run(make, model)
    np.testing.assert_allclose(spin(motion), elliptic_spin(TIMES), atol=1e-8)
    energies = [mechanical_energy(model, state) for state in motion.states]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-9)
    momenta = [rotations(s.orientations)[0] @ (J * w) for s, w in zip(motion.states, spin(motion), strict=True)]
    np.testing.assert_allclose(momenta, np.tile(J * W, (len(TIMES), 1)), atol=1e-9 * np.linalg.norm(J * W))
    np.testing.assert_allclose(motion.states[-1].positions[0], 8.0 * np.array([0.1, 0.2, 0.3]), atol=1e-10)


def test_another_moment_of_inertia_is_seen() -> None:
    """Negative control."""
    found = spin(run(TreeCoordinates, free_body(J * np.array([1.0, 1.01, 1.0]))))
    assert np.max(np.abs(found - elliptic_spin(TIMES))) > 1e-3


@pytest.mark.parametrize("make", [AbsoluteCoordinates, TreeCoordinates])
def test_fixed_steps_are_of_order_eight(make: Make) -> None:
    errors = []
    for step in (0.5, 0.25, 0.125):
        motion = integrate(make(free_body()), np.array([0.0, 4.0]), StepControl(fixed=step))
        assert motion.steps == round(4.0 / step)
        errors.append(float(np.max(np.abs(spin(motion)[-1] - elliptic_spin(np.array([4.0]))[0]))))
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders[-1] == pytest.approx(8.0, abs=0.7)


def test_touch_down_is_located_and_ends_the_motion() -> None:
    """A body falls 1 m: t = sqrt(2 h / g); a height passed on the way is noted in order."""
    stone = MultibodyModel(bodies=(body("stone", 1.0, (1, 1, 1), (0, 0, 1.0)),))

    def above(height: float) -> Event:
        def function(_t: float, state: State) -> float:
            return float(state.positions[0, 2] - height)

        return Event(name=f"{height:g} m", function=function, terminal=height == 0.0)

    motion = integrate(TreeCoordinates(stone), np.linspace(0.0, 1.0, 11), StepControl(), [above(0.0), above(0.5)])
    assert [event.name for event in motion.events] == ["0.5 m", "0 m"]
    found = [event.time for event in motion.events]
    np.testing.assert_allclose(found, np.sqrt(2.0 * np.array([0.5, 1.0]) / 9.81), atol=1e-9)
    assert motion.events[-1].sign == -1
    assert motion.times[-1] == pytest.approx(0.4)
    assert abs(motion.events[-1].state.positions[0, 2]) < 1e-9
