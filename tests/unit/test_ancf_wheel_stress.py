"""Stress on the faces of an ANCF wheel's springs: strips bent to an arc, pulled, and turned as rigid bodies."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.wheel.faces import Strips
from ancf_reduced.wheel.mesh import AncfWheel
from ancf_reduced.wheel.stress import largest_spring_stress
from geometry.parts import TI_6AL_4V

Array = NDArray[np.float64]
LENGTH, WIDTH, THICKNESS, COUNT = 40e-3, 26e-3, 1e-3, 6
E, NU = TI_6AL_4V.young_modulus, TI_6AL_4V.poisson_ratio
S = np.linspace(0.0, LENGTH, COUNT + 1)


def arc(radius: float, stretch: float = 0.0) -> Array:
    """Nodes of two edges of a strip along an arc [m], its middle line stretched; slopes by the flat strip's length."""
    turned = S * (1.0 + stretch) / radius
    q = np.zeros((COUNT + 1, 2, 4, 3))
    q[:, :, 0, 0], q[:, :, 0, 2] = (radius * np.sin(turned))[:, None], (radius * (1.0 - np.cos(turned)))[:, None]
    q[:, 1, 0, 1] = WIDTH
    slope = np.stack([np.cos(turned), 0.0 * turned, np.sin(turned)], axis=-1)
    q[:, :, 1], q[:, :, 2] = ((1.0 + stretch) * slope)[:, None], [0.0, 1.0, 0.0]
    return q.reshape(-1, 4, 3)


@pytest.fixture(scope="module")
def strip() -> AncfWheel:
    """All that the stress asks of a wheel: one flat spring."""
    first = 2 * np.arange(COUNT)[:, None] + np.arange(4)
    sizes = np.tile([LENGTH / COUNT, WIDTH], (COUNT, 1))
    plates = ThinPlates(arc(1e9), first, sizes, [[Layer(material=TI_6AL_4V, thickness=THICKNESS)]])
    one = np.ones(COUNT)
    strips = Strips(strip=one.astype(int), facing=one, bare=one > 0.0)
    return cast("AncfWheel", SimpleNamespace(plates=plates, strips=strips, parts=np.array(["leaf"] * COUNT), sides=1.0))


def expected(strain: float) -> float:
    """Von Mises stress of a wide strip with this Green strain along it and none across, free faces."""
    along = E / (1.0 - NU**2) * strain
    thicker = math.sqrt(1.0 - 2.0 * NU / (1.0 - NU) * strain)
    stretch = math.sqrt(1.0 + 2.0 * strain)
    cauchy = along * stretch / thicker, NU * along / (stretch * thicker)
    return math.sqrt(cauchy[0] ** 2 - cauchy[0] * cauchy[1] + cauchy[1] ** 2)


@pytest.mark.parametrize("radius", [60e-3, 200e-3])
def test_a_strip_bent_to_an_arc(strip: AncfWheel, radius: float) -> None:
    """The outer face is stretched by t / 2R, the inner one shortened: the larger stress counts."""
    faces = [0.5 * ((1.0 + side * 0.5 * THICKNESS / radius) ** 2 - 1.0) for side in (1.0, -1.0)]
    found = largest_spring_stress(strip, arc(radius))
    assert found == {"leaf": pytest.approx(max(map(expected, faces)), rel=2e-3)}


def test_a_strip_pulled(strip: AncfWheel) -> None:
    found = largest_spring_stress(strip, arc(1e9, 3e-3))
    assert found["leaf"] == pytest.approx(expected(0.5 * (1.003**2 - 1.0)), rel=1e-6)


def test_a_strip_turned_has_none(strip: AncfWheel) -> None:
    turn = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))[0]
    assert largest_spring_stress(strip, strip.plates.reference @ turn.T)["leaf"] < 1e-3
