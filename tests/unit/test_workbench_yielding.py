"""Load at first yield, on curves whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.strength.yielding import (
    FirstYield,
    first_yield,
    peak_stresses,
    smallest_yield_load,
    utilisation,
)

STRENGTH = {"tire": 800e6, "springs": 1000e6, "hub": 500e6}


def curve(tire: float, springs: float) -> StiffnessCurve:
    """10 N/mm to 40 mm in steps of 5 mm; stresses rise linearly to those given [Pa]; the hub has no stress column."""
    d = np.linspace(0.0, 0.04, 9)
    columns = {"max_von_mises_tire_Pa": tire * d / 0.04, "max_von_mises_springs_Pa": springs * d / 0.04}
    return StiffnessCurve(model="fe", orientation_deg=0.0, deflection=d, load=1e4 * d, columns=columns)


def test_utilisation_is_stress_over_yield_of_parts_with_stress() -> None:
    found = utilisation(curve(400e6, 2000e6), STRENGTH)
    assert set(found) == {"tire", "springs"}
    assert (found["tire"][-1], found["springs"][-1]) == (pytest.approx(0.5), pytest.approx(2.0))


def test_the_first_part_to_yield_decides_between_increments() -> None:
    """Springs reach 1000 MPa at 0.04/1.6 = 25 mm, the tire 800 MPa at 0.04/1.5 = 26.7 mm."""
    found = first_yield(curve(1200e6, 1600e6), STRENGTH)
    assert (found.part, found.load) == ("springs", pytest.approx(250.0))
    found = first_yield(curve(1500e6, 1600e6), STRENGTH)
    assert (found.part, found.load) == ("tire", pytest.approx(1e4 * 0.04 / 1.875))
    assert found.deflection == pytest.approx(0.04 / 1.875)


def test_without_yield_it_is_the_end() -> None:
    found = first_yield(curve(100e6, 100e6), STRENGTH)
    assert found == FirstYield(load=400.0, deflection=0.04, part=None)


def yields(load: float, part: str | None) -> FirstYield:
    return FirstYield(load=load, deflection=0.02, part=part)


def test_the_weakest_orientation_counts() -> None:
    assert smallest_yield_load([yields(230.0, "tire"), yields(200.0, None)], 250.0) == 230.0 - 30.0
    assert smallest_yield_load([yields(260.0, "tire"), yields(300.0, None)], 250.0) == 260.0
    assert smallest_yield_load([yields(310.0, None), yields(300.0, None)], 250.0) == 300.0


def test_a_curve_too_short_to_tell_is_not_evaluated() -> None:
    with pytest.raises(InputError, match="ends before 250 N without yielding"):
        smallest_yield_load([yields(260.0, "tire"), yields(60.0, None)], 250.0)


def test_peak_stress_at_a_load_lies_between_increments() -> None:
    """At 125 N, 12.5 mm: 12.5/40 of the stress at the end; the hub, without stress, is left out."""
    tire, springs = peak_stresses(curve(400e6, 2000e6), STRENGTH, 125.0)
    assert (tire.part, tire.deflection, tire.stress) == ("tire", pytest.approx(0.0125), pytest.approx(125e6))
    assert (springs.part, springs.used, springs.strength) == ("springs", pytest.approx(0.625), 1000e6)
    with pytest.raises(InputError, match="lies outside the curve"):
        peak_stresses(curve(400e6, 2000e6), STRENGTH, 401.0)
