"""Forces of all wheels: radial law, outputs, power, many wheels as one, no memory, bad input."""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np
import pytest
from numba.core.runtime import _nrt_python, rtsys
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.height_field import HeightField
from contracts.terrain import Plane, TerrainPieces, inclined_plane
from contracts.terrain_ridges import Sinusoid, Step
from rover_dynamics.tires.brush_derivatives import brush_derivatives, derivative_result
from rover_dynamics.tires.brush_force import (
    BrushResult,
    BrushScratch,
    HubMotions,
    brush_forces,
    brush_result,
    brush_scratch,
)
from rover_dynamics.tires.brush_settings import BrushSettings, DamperLaw, WheelNumbers
from rover_dynamics.tires.brush_wheel import BrushWheels
from tests.brush_rig import RADIUS, STIFFNESS, motion, turned

FloatArray = NDArray[np.float64]
DAMPING = 8140.0
PRINTED = BrushSettings(damper_law=DamperLaw.AS_PRINTED)


@numba.njit
def _repeated(
    times: int,
    hub: HubMotions,
    state: FloatArray,
    numbers: WheelNumbers,
    pieces: TerrainPieces,
    written: tuple[BrushResult, BrushScratch, BrushResult, FloatArray],
) -> None:
    result, scratch, pair, jacobian = written
    for _ in range(times):
        brush_forces(hub, state, numbers, pieces, result, scratch)
        brush_derivatives(hub, state, numbers, pieces, jacobian, (scratch, pair))


@numba.njit
def _allocating(times: int) -> float:
    total = 0.0
    for k in range(times):
        total += np.full(5, float(k)).sum()
    return total


def _allocations(call: Callable[[int], object], times: int) -> int:
    """Pieces of memory that numba's runtime takes in a call, those for its arguments included."""
    call(times)
    _nrt_python.memsys_enable_stats()
    try:
        before = rtsys.get_allocation_stats().alloc
        call(times)
        return int(rtsys.get_allocation_stats().alloc - before)
    finally:
        _nrt_python.memsys_disable_stats()


def load(deflection: float, rate: float, settings: BrushSettings | None = None) -> float:
    wheels = BrushWheels(Plane(), 1, settings=settings)
    hub = motion((0.0, 0.0, RADIUS - deflection), None, (0.0, 0.0, -rate))
    return float(wheels.forces(hub, np.zeros((1, 2))).wrench[0, 2])


def test_damper_as_printed_is_spring_and_damper_never_tensile() -> None:
    assert load(0.01, 0.005, PRINTED) == pytest.approx(STIFFNESS * 0.01 + DAMPING * 0.005, rel=1e-9)
    assert load(1e-9, 0.272, PRINTED) == pytest.approx(DAMPING * 0.272, rel=1e-4)
    assert load(0.01, -0.02, PRINTED) == 0.0
    assert load(-1e-9, 0.272, PRINTED) == 0.0


def test_damper_that_builds_up_starts_from_nothing_and_ends_as_printed() -> None:
    assert load(1e-9, 0.272) == pytest.approx(0.0, abs=1e-4)
    assert load(0.0025, 0.1) == pytest.approx(STIFFNESS * 0.0025 + 0.5 * DAMPING * 0.1, rel=1e-9)
    assert load(0.005, 0.1) == pytest.approx(load(0.005, 0.1, PRINTED), rel=1e-12)
    assert load(0.01, -0.02) == 0.0


def test_load_grows_little_by_little_from_the_first_touch() -> None:
    depths = np.linspace(-1e-4, 5e-3, 2001)
    found = np.array([load(d, 0.272) for d in depths])
    assert np.abs(np.diff(found)).max() < 3.0
    assert found[-1] > 2000.0


def test_power_of_the_wrench_is_that_of_normal_and_slip_forces() -> None:
    draw = np.random.default_rng(4)
    for _ in range(20):
        v, omega = draw.normal(size=3) * 0.05, draw.normal(size=3) * 0.3
        wheels = BrushWheels(inclined_plane(0.1, 0.5), 1)
        hub = motion((0.0, 0.0, 0.13), turned(0.1, 0.2), v, omega)
        found = wheels.forces(hub, draw.normal(size=(1, 2)) * 5e-4)
        r = found.output[0, 4:7] - hub.position[0]
        F, M = found.wrench[0, :3], found.wrench[0, 3:]
        n, e = np.array(wheels.pieces.rows[0, 1:4]), hub.rotation[0, :, 1]
        t = np.cross(e, n) / np.linalg.norm(np.cross(e, n))
        u = np.cross(t, e)
        on_rim = r - (RADIUS + r @ u) * u
        forward = (F @ t) * t
        own = M - np.cross(r, F - forward) - np.cross(on_rim, forward)
        slip_power = (F - forward) @ (v + np.cross(omega, r)) + forward @ (v + np.cross(omega, on_rim))
        assert F @ v + M @ omega == pytest.approx(slip_power + own @ omega, abs=1e-12)
        resistance, aligning = np.linalg.lstsq(np.column_stack([e, n]), own, rcond=None)[0]
        np.testing.assert_allclose(resistance * e + aligning * n, own, atol=1e-12)
        assert abs(resistance) <= 0.015 * found.output[0, 1] * RADIUS
        assert F @ n == pytest.approx(found.output[0, 1], rel=1e-12)
        friction = F - (F @ n) * n
        assert np.hypot(*found.output[0, 7:9]) == pytest.approx(np.linalg.norm(friction), rel=1e-12)
        assert np.linalg.norm(friction) <= 0.757 * found.output[0, 1] * (1 + 1e-12)


def test_rolling_resistance_opposes_the_spin_and_passes_smoothly_through_zero() -> None:
    wheels, deflection = BrushWheels(Plane(), 1), 0.02
    arm = RADIUS - deflection

    def moment(spin: float) -> float:
        hub = motion((0.0, 0.0, arm), None, (spin * RADIUS, 0.0, 0.0), (0.0, spin, 0.0))
        return float(wheels.forces(hub, np.zeros((1, 2))).wrench[0, 4])

    assert moment(1.0) == pytest.approx(-0.015 * STIFFNESS * deflection * arm, rel=1e-9)
    assert moment(-1.0) == -moment(1.0)
    assert moment(0.0) == 0.0
    assert abs(moment(1e-4)) < 0.02 * abs(moment(1.0))


def test_force_is_continuous_in_speed_and_slip_at_standstill() -> None:
    wheels, state = BrushWheels(Plane(), 1), np.array([[4e-4, -2e-4]])
    for direction in np.eye(6):
        sizes = np.linspace(-2e-3, 2e-3, 401)
        answers = [
            wheels.forces(motion((0.0, 0.0, 0.12), None, s * direction[:3], 8.0 * s * direction[3:]), state)
            for s in sizes
        ]
        wrench = np.array([answer.wrench[0] for answer in answers])
        rate = np.array([answer.rate[0] for answer in answers])
        # a step of 1e-5 m/s: the damper makes 0.08 N of it, the bristles 0.1 N, the rate at most two steps
        assert np.abs(np.diff(wrench, axis=0)).max() < 0.3
        assert np.abs(np.diff(rate, axis=0)).max() < 4e-5


def test_many_wheels_are_as_many_single_ones() -> None:
    step, draw = Step(rise=0.05, edge_radius=0.02, position=0.1), np.random.default_rng(8)
    hubs = [motion((x, 0.0, 0.16), turned(0.05, 0.1), draw.normal(size=3), draw.normal(size=3)) for x in (-1, 0, 0.2)]
    together = HubMotions(*(np.concatenate(parts) for parts in zip(*hubs, strict=True)))
    state = draw.normal(size=(3, 4)) * 1e-4
    found = BrushWheels(step, 3).forces(together, state)
    for k, hub in enumerate(hubs):
        single = BrushWheels(step, 1).forces(hub, state[k : k + 1])
        for all_of_them, alone in zip(found, single, strict=True):
            np.testing.assert_array_equal(all_of_them[k], alone[0])


def test_bristles_of_a_lifted_wheel_spring_back() -> None:
    found = BrushWheels(Plane(), 1).forces(motion((0.0, 0.0, 0.2), None, (1.0, 0.0, 0.0)), np.array([[1e-3, -2e-3]]))
    np.testing.assert_allclose(found.rate[0], [-1e-3 / 0.005, 2e-3 / 0.005], rtol=1e-12)
    np.testing.assert_array_equal(found.wrench[0], 0.0)
    np.testing.assert_allclose(found.output[0, 4:7], [0.0, 0.0, 0.2])


def test_the_calls_allocate_nothing() -> None:
    wheels = BrushWheels(Sinusoid(amplitude=0.01, wavelength=0.5), 1)
    hub, state, pieces = motion((0.0, 0.0, 0.12)), np.zeros((1, 2)), wheels.pieces
    written = brush_result(1, pieces), brush_scratch(pieces), derivative_result(pieces), np.zeros((1, 8, 14))

    def call(times: int) -> None:
        _repeated(times, hub, state, wheels.numbers, pieces, written)

    assert _allocations(call, 100) == _allocations(call, 1)
    assert _allocations(_allocating, 3) == 3  # negative control: the counter counts


def test_bad_input_is_refused() -> None:
    with pytest.raises(InputError, match="wheels = 0"):
        BrushWheels(Plane(), 0)
    wheels = BrushWheels(Plane(), 1)
    with pytest.raises(InputError, match="shapes of motions and state"):
        wheels.forces(motion((0.0, 0.0, 0.12)), np.zeros((1, 4)))
    with pytest.raises(InputError, match="shapes of motions and state"):
        wheels.derivatives(motion((0.0, 0.0, 0.12)), np.zeros(2))
    with pytest.raises(InputError, match=r"motions and state = positions .* must be finite"):
        wheels.forces(motion((0.0, 0.0, np.nan)), np.zeros((1, 2)))
    field = HeightField(heights=np.zeros((5, 5)), spacing=(0.5, 0.5))
    with pytest.raises(InputError, match=r"hub of wheel 0 = x, y = 2\.5, 1 m"):
        BrushWheels(field, 1).forces(motion((2.5, 1.0, 0.12)), np.zeros((1, 2)))
