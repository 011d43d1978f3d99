"""Claim: half a wheel has the modes of the whole one, standing under a load too; a free one moves with its own mass.

Source: the mirror plane of the design (even and odd motions do not mix), its three-fold rotation (modes in pairs), the
mass and inertia of the parts by geometry's own quadrature. Tolerances: equal up to round-off and the load at which it
stands (1e-4 of it): 1e-5; thin plates, which share no code with the solid, within 2 % on this mesh. Negative control:
four times the density halves every frequency.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.wheel import vibration
from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from contracts.mesh import TaggedMesh
from contracts.modes import Modes
from geometry.build import build_mesh
from geometry.inertia import rigid_mass
from geometry.wheel import exomars_hoops
from reference_fe.vibration.wheel import WheelModes, WheelState, wheel_modes
from reference_fe.wheel.case import WheelLoadCase

CASE = WheelLoadCase(orientation_deg=15.0, deflections=(0.002,))


def wheel_mesh(*, half_width: bool, every_part: bool = False) -> TaggedMesh:
    parts = "all" if every_part else "flexible"
    return build_mesh(exomars_hoops(), element_size=24e-3, axial_size=60e-3, parts=parts, half_width=half_width)


@functools.cache
def standing(*, half_width: bool) -> WheelModes:
    mesh = wheel_mesh(half_width=half_width)
    return wheel_modes(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), CASE, WheelState.STANDING, 8, load=30.0)


@pytest.mark.long
def test_half_a_standing_wheel_has_the_modes_of_the_whole() -> None:
    half, full = standing(half_width=True), standing(half_width=False)
    assert half.load == pytest.approx(30.0, rel=1e-4)
    np.testing.assert_allclose(half.modes.frequency, full.modes.frequency, rtol=1e-5)
    assert set(half.modes.parity.tolist()) == {-1, 1}
    for name in ("moving", "whole"):
        np.testing.assert_allclose(getattr(half.modes, name), getattr(full.modes, name), rtol=1e-5)
    effective = (one.modes.effective_mass.sum(axis=0) / one.modes.moving for one in (half, full))
    np.testing.assert_allclose(*effective, atol=1e-4)
    assert half.modes.unstable == half.negative_pivots == 0
    assert pairs_of(half.modes) < 3  # the ground ends the wheel's symmetry
    mesh = wheel_mesh(half_width=True)
    materials = dict.fromkeys(mesh.parts, TI_6AL_4V)
    grips = wheel_modes(mesh, materials, CASE, WheelState.STANDING, 4, load=30.0, grip=True).modes
    assert grips.frequency[0] > 1.2 * half.modes.frequency[0]  # the rim turns about the axle: along the ground


def test_a_held_wheel_has_pairs_and_the_modes_of_its_plates() -> None:
    mesh = wheel_mesh(half_width=True)
    materials = dict.fromkeys(mesh.parts, TI_6AL_4V)
    held = wheel_modes(mesh, materials, CASE, WheelState.HELD, 8).modes
    assert pairs_of(held) >= 3
    assert (held.effective_mass.sum(axis=0) < held.moving).all()
    assert (held.moving < held.whole).all()
    wheel = build_ancf_wheel(exomars_hoops(), element_size=24e-3, axial_size=60e-3, half_width=False)
    plates, _ = vibration.wheel_modes(WheelOnGround(wheel, 0.0), 8)
    np.testing.assert_allclose(plates.frequency, held.frequency, rtol=0.02)
    np.testing.assert_allclose(plates.moving, held.moving, rtol=0.02)
    heavy = {part: replace(one, density=4.0 * one.density) for part, one in materials.items()}
    halved = wheel_modes(mesh, heavy, CASE, WheelState.HELD, 2).modes
    np.testing.assert_allclose(halved.frequency, 0.5 * held.frequency[:2], rtol=1e-6)


def pairs_of(modes: Modes) -> int:
    """Groups of two modes that share their frequency."""
    return [len(group) for group in modes.clusters()].count(2)


@pytest.mark.long
def test_a_free_wheel_moves_with_the_mass_of_its_parts() -> None:
    mesh, whole = (wheel_mesh(half_width=half, every_part=True) for half in (True, False))
    materials = dict.fromkeys(mesh.parts, TI_6AL_4V)
    free = wheel_modes(mesh, materials, CASE, WheelState.FREE, 4).modes
    expected = rigid_mass(whole, dict.fromkeys(whole.parts, TI_6AL_4V.density))
    np.testing.assert_allclose(free.whole, np.diag(expected), rtol=1e-6)
    np.testing.assert_allclose(free.moving, free.whole, rtol=1e-6)
    assert free.rigid.tolist() == [True] * 6 + [False] * 4
    np.testing.assert_allclose(free.effective_mass[:6] / free.whole, np.eye(6), atol=1e-6)
    np.testing.assert_allclose(free.effective_mass[6:] / free.whole, 0.0, atol=1e-9)


def test_what_has_no_modes_is_refused() -> None:
    mesh = wheel_mesh(half_width=True)
    materials = dict.fromkeys(mesh.parts, TI_6AL_4V)
    with pytest.raises(InputError, match="load"):
        wheel_modes(mesh, materials, CASE, WheelState.STANDING, 4, load=0.0)
    with pytest.raises(InputError, match="every part has a mass"):
        wheel_modes(mesh, {"tire": TI_6AL_4V}, CASE, WheelState.HELD, 4)
