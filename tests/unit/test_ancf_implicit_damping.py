"""Damping at the end of an explicit step: its equations, second order, no shorter step, hub's axes, several meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.motion import linearisation
from ancf_reduced.motion.explicit import MotionState, _Kick, integrate_explicit
from ancf_reduced.motion.implicit_damping import ImplicitDamping
from ancf_reduced.motion.mass_factor import MassFactor
from ancf_reduced.motion.plate_system import HubMass, PlateSystem, build_plate_system
from ancf_reduced.motion.reference_node import tie_reference_node
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.motion.triad_equations import TriadEquations
from ancf_reduced.motion.vector_coordinates import all_free, side_by_side, with_reference_node
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.wheel_rig import wheel_rig
from contracts.errors import ConvergenceError
from contracts.terrain import Plane
from tests.unit.test_ancf_rigid_hub import HUB, paddle, rigid_start

END = 0.02


def damped(system: PlateSystem, factor: float = 1.0) -> PlateSystem:
    """lambda_v, mu_v = 50, 80 Pa s times the factor: with 1 the highest mode is damped 4 times over the critical."""
    return replace(system, model=replace(system.model, viscosity=(50.0 * factor, 80.0 * factor)))


def made(monkeypatch: pytest.MonkeyPatch) -> list[ImplicitDamping]:
    """Collects what integrators make."""
    collected: list[ImplicitDamping] = []
    plain: Callable[[_Kick, PlateSystem], None] = _Kick.__init__

    def noted(self: _Kick, system: PlateSystem) -> None:
        plain(self, system)
        assert self.damping is not None
        collected.append(self.damping)

    monkeypatch.setattr(_Kick, "__init__", noted)
    return collected


def errors(system: PlateSystem, parts: tuple[int, ...]) -> np.ndarray:
    """Of z at the end with the stable step over each number, against 1/64 of it."""
    start, step = rigid_start(system), stable_step(system, system.reference())
    (exact,) = integrate_explicit(system, start, np.array([END]), step / 64)
    ends = [next(integrate_explicit(system, start, np.array([END]), step / n)) for n in parts]
    return np.array([np.abs(end.z - exact.z).max() for end in ends])


def test_error_is_of_second_order_up_to_the_longest_step() -> None:
    found = errors(damped(paddle()), (1, 2, 4, 8))
    np.testing.assert_allclose(found[:-1] / found[1:], 4.0, rtol=0.1)


def test_damping_of_half_a_step_before_is_of_first_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """Negative control: such a step has to be 25 times shorter, and is less accurate even then."""
    system = damped(paddle())
    start, step = rigid_start(system), stable_step(system, system.reference())
    exact, whole = (next(integrate_explicit(system, start, np.array([END]), step / n)) for n in (64, 1))
    factor = MassFactor(system.mass)

    def lagging(self: ImplicitDamping, half: np.ndarray, z: np.ndarray, time: float, h: float) -> np.ndarray:
        v = half + 0.5 * h * factor.solve(system.force(z, half, time))
        return np.asarray(v + self._triads.stop(v, z))

    monkeypatch.setattr(ImplicitDamping, "rates", lagging)
    with pytest.raises(ConvergenceError, match="step"):
        list(integrate_explicit(system, start, np.array([END]), step / 8))
    found = [
        np.abs(next(integrate_explicit(system, start, np.array([END]), step / n)).z - exact.z).max() for n in (32, 64)
    ]
    assert found[0] / found[1] == pytest.approx(2.0, rel=0.2)
    assert found[1] > np.abs(whole.z - exact.z).max()


@pytest.mark.parametrize("factor", [0.1, 1.0, 100.0])
def test_the_stable_step_does_not_know_the_damping(factor: float) -> None:
    system, plain = damped(paddle(), factor), paddle()
    start, step = rigid_start(system), stable_step(plain, plain.reference())
    assert stable_step(system, system.reference()) == step
    (end,) = integrate_explicit(system, start, np.array([END]), step)
    (exact,) = integrate_explicit(system, start, np.array([END]), step / 16)
    assert np.abs(end.z - exact.z).max() < 1e-5


@pytest.mark.parametrize("small", [True, False], ids=["full", "sparse"])
def test_rates_obey_the_equations(small: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Residual and rates of the constraints, with an inverse for another state and the exact one."""
    monkeypatch.setattr(linearisation, "_SMALL", 250 if small else 0)
    system = damped(paddle())
    start = rigid_start(system)
    (state,) = integrate_explicit(system, start, np.array([END]), 5e-5)
    kick, h, rng = _Kick(system), 6e-5, np.random.default_rng(5)
    assert kick.damping is not None
    half = state.v + rng.normal(size=state.v.shape)
    kick.damping.rates(half, start.z, 0.0, h)
    v = kick.damping.rates(half, state.z, END, h)
    G = TriadEquations(system.coordinates).jacobian(state.z)
    assert np.abs(G @ v.ravel()).max() < 1e-12 * np.abs(v).max()
    force = system.force(state.z, v, END) - (2.0 / h) * (system.mass @ (v - half))
    multipliers = np.linalg.lstsq(G.T, force.ravel(), rcond=None)[0]
    assert np.abs(force.ravel() - G.T @ multipliers).max() < 2e-3 * np.abs((2.0 / h) * system.mass @ (v - half)).max()


def test_one_inverse_serves_a_whole_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """In the hub's axes; in the world's (negative control) it keeps the hub from turning freely."""
    collected = made(monkeypatch)
    plain = paddle()
    system = damped(replace(plain, dead_load=0.0 * plain.dead_load))
    v = np.cross(np.array([0.0, 20.0, 0.0]), system.reference())
    start, end = MotionState(time=0.0, z=system.reference(), v=v), np.array([0.3])
    (one,) = integrate_explicit(system, start, end, 6e-5)
    assert np.arctan2(-one.z[-3, 2], one.z[-3, 0]) % (2.0 * np.pi) == pytest.approx(6.0, abs=0.03)
    assert collected[0].inverses == 1
    monkeypatch.setattr(ImplicitDamping, "_axes", lambda self, z: np.eye(3))
    (other,) = integrate_explicit(system, start, end, 6e-5)
    assert np.abs(one.z - other.z).max() > 0.1


def test_a_plate_without_a_hub_may_tumble(monkeypatch: pytest.MonkeyPatch) -> None:
    """No axes to turn with: the inverse is made anew, the motion stays that of a rigid body."""
    collected = made(monkeypatch)
    mesh = build_plate_mesh([flat_patch(np.zeros(3), np.array([0.1, 0, 0]), np.array([0, 0.06, 0]), 0.02, "plate")])
    model = build_plate_model(mesh, young_modulus=2e6, poisson_ratio=0.0, density=1500.0, quadrature=(4, 4, 2))
    system = damped(build_plate_system(model, all_free(mesh)))
    z = system.reference()
    middle = np.where(np.arange(16)[:, None] % 4 == 0, [0.05, 0.03, 0.0], 0.0)
    start = MotionState(time=0.0, z=z, v=np.cross(np.array([0.0, 0.0, 20.0]), z - middle))
    step = stable_step(system, z)
    (end,) = integrate_explicit(system, start, np.array([0.1]), step)
    assert collected[0].inverses > 1
    np.testing.assert_allclose(end.z[::4].mean(axis=0), [0.05, 0.03, 0.0], atol=1e-9)
    direction = end.z[4] - end.z[0]
    assert np.arctan2(direction[1], direction[0]) == pytest.approx(2.0, abs=0.02)  # a little less: it is stretched


def test_wheels_side_by_side_move_as_alone() -> None:
    """Two meshes in one system, each in the axes of its own hub."""
    single, apart = damped(paddle()), np.array([0.0, 1.0, 0.0])
    patches = [
        flat_patch(
            np.array([0.05, -0.03, 0.0]) + n * apart, np.array([0.1, 0, 0]), np.array([0, 0.06, 0]), 0.02, "plate"
        )
        for n in range(2)
    ]
    ties = []
    for n, patch in enumerate(patches):
        alone = build_plate_mesh([patch])
        ties.append(tie_reference_node(alone, np.flatnonzero(alone.points[:, 0] < 0.06), n * apart))
    model = build_plate_model(
        build_plate_mesh(patches), young_modulus=2e5, poisson_ratio=0.0, density=1500.0, quadrature=(3, 3, 2)
    )
    coordinates = side_by_side([with_reference_node(tie) for tie in ties])
    gravity = np.array([0.0, 0.0, -3.711])
    pair = damped(build_plate_system(model, coordinates, gravity=gravity, hubs=(HUB, HUB)))
    start = rigid_start(single)
    slow = replace(start, v=0.5 * start.v)
    step, times = 6e-5, np.array([END])
    one, other = (next(integrate_explicit(single, s, times, step)) for s in (start, slow))
    beside = np.where(np.arange(len(start.z))[:, None] % 4 == 0, apart, 0.0)
    together = MotionState(time=0.0, z=np.vstack([start.z, start.z + beside]), v=np.vstack([start.v, slow.v]))
    (end,) = integrate_explicit(pair, together, times, step)
    np.testing.assert_allclose(end.z, np.vstack([one.z, other.z + beside]), rtol=0.0, atol=1e-7)


def test_friction_too_stiff_for_the_step_says_so() -> None:
    """The thesis' contact (c = 100 N s/m, mu = 0.6) runs with the longest step; almost set-valued friction does not."""
    preset = replace(thesis_preset(), quadrature=(4, 4, 2))
    ends = {}
    for slip_velocity in (0.05, 1e-3):
        law = ContactLaw(stiffness=preset.contact_stiffness, damping=100.0, friction=0.6, slip_velocity=slip_velocity)
        hub = HubMass(mass=25.0, inertia=0.1 * np.eye(3))
        rig = wheel_rig(build_tire(preset), Plane(), hub=hub, law=law, damping_ratio=0.05)
        start = rig.start(np.array([0.0, 0.0, preset.outer_radius]), np.array([0.0, 0.0, -0.272]))
        ends[slip_velocity] = integrate_explicit(rig.system, start, np.array([0.05]), stable_step(rig.system, start.z))
    assert np.isfinite(next(ends[0.05]).z).all()
    with pytest.raises(ConvergenceError, match="slip velocity"):
        next(ends[1e-3])
