"""Work of the ground against stored energy, on made-up curves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from workbench.questions.numerics.energy import energy_check, energy_error, quadrature_error


def _curve(points: int = 21, energy: float = 1.0, start: float = 0.0) -> StiffnessCurve:
    """F = k d + c d^2, whose energy is known; ``energy`` is a factor on it, ``start`` what was stored before [J]."""
    d = np.linspace(0.0, 0.04, points)
    stored = start + energy * (0.5 * 8000.0 * d**2 + 1e5 / 3.0 * d**3)
    return StiffnessCurve(
        model="fe", orientation_deg=0.0, deflection=d, load=8000.0 * d + 1e5 * d**2, columns={"stored_energy_J": stored}
    )


def test_the_error_of_a_sound_curve_is_that_of_the_trapezoid_rule() -> None:
    for points in (11, 12, 21):
        curve = _curve(points)
        assert energy_error(curve) == pytest.approx(quadrature_error(curve), rel=0.15)
    assert energy_error(_curve(21)) == pytest.approx(0.25 * energy_error(_curve(11)), rel=0.01)


def test_energy_stored_before_the_first_touch_does_not_count() -> None:
    assert energy_error(_curve(start=3.0)) == pytest.approx(energy_error(_curve()))


def test_lost_energy_fails() -> None:
    sound = energy_check([_curve(), _curve(31)], 0.01)
    assert (sound.id, sound.role, sound.status) == ("fe.energy", "gate", "pass")
    assert energy_check([_curve(), _curve(energy=0.98)], 0.01).status == "fail"
    bare = StiffnessCurve(model="fe", orientation_deg=0.0, deflection=np.array([0.0, 1e-3]), load=np.array([0.0, 8.0]))
    assert energy_check([bare], 0.01).status == "error"


def test_what_friction_and_flow_take_is_part_of_the_account() -> None:
    """A curve whose stored energy lacks 2 % passes if sliding, slip and flow have them, and fails without any of it."""
    curve = _curve(energy=0.98)
    lacking = _curve().columns["stored_energy_J"] - curve.columns["stored_energy_J"]
    taken = {"friction_dissipation_J": 0.5, "slip_energy_J": 0.25, "plastic_dissipation_J": 0.25}
    taken_up = {name: share * lacking for name, share in taken.items()}
    whole = replace(curve, columns={**curve.columns, **taken_up})
    assert energy_error(whole) == pytest.approx(energy_error(_curve()))
    for name in taken:
        without = {key: values for key, values in whole.columns.items() if key != name}
        assert energy_error(replace(whole, columns=without)) > 0.004
