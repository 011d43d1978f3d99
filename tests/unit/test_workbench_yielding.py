"""Load at first yield, on curves whose answer is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.strength.yielding import (
    FirstYield,
    first_yield,
    judged_stress,
    largest_utilisation,
    peak_stresses,
    smallest_yield_load,
    utilisation,
)
from workbench.study.reading import built_in_study, read_study
from workbench.study.strengths import yield_strengths

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


def test_strips_are_judged_by_their_linearised_stress() -> None:
    """The notch at the weld, 1.5 times as high, decides nothing; a part without lines keeps its largest stress."""
    bare = curve(400e6, 1500e6)
    lines = {"max_linearised_springs_Pa": bare.load * 2.5e6, "max_linearised_tire_Pa": 0.0 * bare.load}
    judged = replace(bare, columns={**bare.columns, **lines})
    springs, tire = judged_stress(judged, "springs"), judged_stress(judged, "tire")
    assert springs is not None
    assert tire is not None
    assert (springs[-1], tire[-1]) == (pytest.approx(1000e6), pytest.approx(400e6))
    assert judged_stress(judged, "hub") is None
    assert first_yield(judged, STRENGTH).deflection == pytest.approx(0.04)
    assert first_yield(bare, STRENGTH).deflection == pytest.approx(0.04 / 1.5)


def test_the_stress_is_read_at_the_load_that_is_named() -> None:
    """At 225 N, between the points at 200 and 250 N: 22.5/40 of the end's; a peak before it counts."""
    ends = curve(400e6, 1600e6)
    assert largest_utilisation(ends, STRENGTH, 225.0) == pytest.approx(1.6 * 22.5 / 40.0)
    peak = ends.columns["max_von_mises_springs_Pa"].copy()
    peak[2] = 1200e6
    assert largest_utilisation(replace(ends, columns={"max_von_mises_springs_Pa": peak}), STRENGTH, 225.0) == 1.2
    with pytest.raises(InputError, match="lies outside the curve"):
        largest_utilisation(ends, STRENGTH, 401.0)
    with pytest.raises(InputError, match="has no stress"):
        largest_utilisation(replace(ends, columns={}), STRENGTH, 225.0)


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


def test_each_part_has_the_strength_of_its_material() -> None:
    study = read_study(built_in_study())
    steel = study.materials["Ti-6Al-4V"].model_copy(update={"yield_strength": 300e6})
    other = study.model_copy(update={"materials": study.materials | {"Ti-6Al-4V": steel}})
    parts = set(yield_strengths(study))
    assert {"tire", "grousers", "springs_outer", "springs_inner"} <= parts
    found = yield_strengths(other)
    assert set(found) == parts
    assert found["tire"] == 300e6


def flowing(strain_at_end: float) -> StiffnessCurve:
    """The springs flow from half the way on, their stress held at yield; the tire stays elastic."""
    base = curve(400e6, 1000e6)
    stress = np.minimum(2.0 * base.columns["max_von_mises_springs_Pa"], 1000e6)
    strain = strain_at_end * np.maximum(0.0, 2.0 * base.deflection / 0.04 - 1.0)
    springs = {"max_von_mises_springs_Pa": stress, "max_plastic_strain_springs": strain}
    return replace(base, columns=dict(base.columns) | springs | {"max_plastic_strain_tire": 0.0 * strain})


def test_a_part_without_lines_is_at_its_limit_where_it_flows() -> None:
    """Its stress stands still at yield, in round-off perhaps below."""
    judged = flowing(0.008)
    low = dict(judged.columns) | {"max_von_mises_springs_Pa": 0.999 * judged.columns["max_von_mises_springs_Pa"]}
    used = utilisation(replace(judged, columns=low), STRENGTH)
    assert used["springs"][-1] == 1.0
    assert used["tire"][-1] == pytest.approx(0.5)  # elastic, though it could flow
    found = first_yield(judged, STRENGTH)
    assert (found.part, found.deflection) == ("springs", pytest.approx(0.02))
    assert first_yield(judged, STRENGTH, 2.0).part is None


def test_a_strip_that_flows_is_judged_by_its_linearised_stress() -> None:
    """Which goes on to 1.5 times yield, while flow at the weld's end began at half of it."""
    base = flowing(0.008)
    lines = {"max_linearised_springs_Pa": 1500e6 * base.deflection / 0.04}
    judged = replace(base, columns=dict(base.columns) | lines)
    assert first_yield(judged, STRENGTH).deflection == pytest.approx(0.04 / 1.5)
    _, springs = peak_stresses(judged, STRENGTH, 400.0)
    assert (springs.stress, springs.used) == (pytest.approx(1500e6), pytest.approx(1.5))


@pytest.mark.parametrize("linearised", [False, True])
def test_more_load_never_uses_less_of_a_part(linearised: bool) -> None:
    judged = flowing(0.00001)
    if linearised:
        columns = dict(judged.columns) | {"max_linearised_springs_Pa": 1100e6 * judged.deflection / 0.04}
        judged = replace(judged, columns=columns)
    loads = np.linspace(10.0, 400.0, 79)
    used = [largest_utilisation(judged, STRENGTH, float(load)) for load in loads]
    assert np.all(np.diff(used) >= 0.0)
    assert used[-1] >= 1.0
