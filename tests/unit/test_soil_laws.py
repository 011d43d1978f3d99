"""Laws of soil at a point.

Claims: the pressure is Bekker's and its stiffness the derivative; what is let go comes back by its own line and never
above the surface; shear reaches its strength as Janosi and Hanamoto say; lugs hold no more than the weaker of their two
ways to fail. Sources: the equations of docs/theory/soil.md. Negative controls: another exponent and another K differ.
"""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from soil.laws import (
    lug_lines,
    lug_thrust,
    mobilised,
    pressure_and_stiffness,
    rebound,
    slip_sinkage,
    unloading_stiffness,
)

MODULUS, EXPONENT = 2.5e6, 1.1
SOIL = (250.0, math.radians(32.0), 6000.0, math.radians(24.0))


def test_the_pressure_is_bekkers_and_its_stiffness_the_derivative() -> None:
    depth, step = 0.012, 1e-7
    pressure, stiffness = pressure_and_stiffness(depth, MODULUS, EXPONENT)
    assert pressure == pytest.approx(2.5e6 * 0.012**1.1, rel=1e-14)
    above, below = (pressure_and_stiffness(depth + d, MODULUS, EXPONENT)[0] for d in (step, -step))
    assert stiffness == pytest.approx((above - below) / (2.0 * step), rel=1e-7)
    assert pressure_and_stiffness(-1e-9, MODULUS, EXPONENT) == (0.0, 0.0)
    assert pressure_and_stiffness(depth, MODULUS, 1.0)[0] > 1.4 * pressure


def test_soil_comes_back_by_its_line_and_never_above_the_surface() -> None:
    deepest, growth = 0.010, 503e6
    back = rebound(deepest, MODULUS, EXPONENT, 0.0, growth)
    pressure = pressure_and_stiffness(deepest, MODULUS, EXPONENT)[0]
    assert pressure - unloading_stiffness(deepest, 0.0, growth) * back == pytest.approx(0.0, abs=1e-9 * pressure)
    assert rebound(deepest, MODULUS, EXPONENT, 1.0, 0.0) == deepest
    assert rebound(0.0, MODULUS, EXPONENT, 0.0, growth) == 0.0


def test_shear_is_odd_and_saturates() -> None:
    modulus, step = 0.011, 1e-8
    share, slope = mobilised(modulus, modulus)
    assert share == pytest.approx(1.0 - math.exp(-1.0), rel=1e-14)
    assert slope == pytest.approx((mobilised(modulus + step, modulus)[0] - share) / step, rel=1e-6)
    assert mobilised(-modulus, modulus)[0] == -share
    assert mobilised(40.0 * modulus, modulus)[0] == pytest.approx(1.0, abs=1e-15)
    assert mobilised(0.0, modulus)[0] == 0.0


def test_slip_makes_a_wheel_sink_and_skid_does_not() -> None:
    assert slip_sinkage(0.0) == slip_sinkage(-0.5) == 1.0
    assert slip_sinkage(0.5) == pytest.approx(2.0)
    assert slip_sinkage(1.0) == pytest.approx(4.0)


def test_lugs_hold_the_weaker_of_their_two_ways_to_fail() -> None:
    pressure, width = 15e3, 0.12
    bare = lug_thrust(pressure, *lug_lines(SOIL, (0.003, 0.05, 0.0), width))
    assert bare == pytest.approx(pressure * math.tan(SOIL[3]))
    close = lug_thrust(pressure, *lug_lines(SOIL, (0.003, 0.004, 1.0), width))
    ratio = 0.003 / width
    tips = 250.0 * (1.0 + 2.0 * ratio) + pressure * math.tan(SOIL[1]) * (1.0 + 0.64 * ratio * math.atan(1.0 / ratio))
    assert close == pytest.approx(tips, rel=1e-14)
    apart = lug_thrust(pressure, *lug_lines(SOIL, (0.003, 0.5, 1.0), width))
    passive = math.tan(math.radians(45.0 + 16.0)) ** 2
    pushed = (0.5 * 6000.0 * 0.003**2 + pressure * 0.003) * passive + 2.0 * 250.0 * 0.003 * math.sqrt(passive)
    assert apart == pytest.approx(bare + pushed / 0.5, rel=1e-12)
    assert bare < apart < close


@pytest.mark.parametrize("law", [mobilised, slip_sinkage, pressure_and_stiffness, lug_lines, lug_thrust, rebound])
def test_the_laws_compile_as_they_are(law: object) -> None:
    compiled = numba.njit(law)
    asked: dict[object, tuple[object, ...]] = {
        mobilised: (0.004, 0.011),
        slip_sinkage: (0.3,),
        pressure_and_stiffness: (0.01, MODULUS, EXPONENT),
        lug_lines: (SOIL, (0.003, 0.05, 1.0), 0.12),
        lug_thrust: (15e3, (200.0, 0.6), (40.0, 0.9)),
    }
    if law is not rebound:  # it calls another law, which a caller compiles beside it
        given = asked[law]
        assert np.ravel(compiled(*given)) == pytest.approx(np.ravel(law(*given)), rel=1e-14)  # type: ignore[operator]
