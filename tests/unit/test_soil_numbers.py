"""Soils as numbers: the table, what it lacks, ranges, and what is refused.

Claim: every soil of the table has a source and lies within the limits of its class; impossible numbers are told by
name. Source of the numbers: soil/soils.toml.
"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from contracts.errors import InputError
from soil.soil import known_soils, soil_named, usual_numbers, with_ends_of_ranges


def test_the_table_is_that_of_its_sources() -> None:
    ding = soil_named("ding2011")
    assert ding.modulus(0.165) == pytest.approx(15.6e3 / 0.165 + 2407.4e3)
    assert math.degrees(ding.friction_angle) == pytest.approx(31.9, abs=1e-4)
    assert ding.shear_modulus == pytest.approx(0.5 * (0.0097 + 0.0131))
    assert ding.peak_rolling == usual_numbers()["peak_rolling"] == 0.18
    assert "unloading growth" in ding.source
    assert "Table 2" in ding.source
    for soil in known_soils().values():
        assert soil.source
        assert 100.0 < soil.density < 3000.0


def test_the_ends_of_ranges_are_computed_beside_the_middle() -> None:
    found = [one.shear_modulus for one in with_ends_of_ranges(soil_named("ding2011"))]
    assert found == pytest.approx([0.0114, 0.0097, 0.0131])
    assert list(with_ends_of_ranges(soil_named("grc1"))) == [soil_named("grc1")]


def test_the_rim_is_held_less_than_soil() -> None:
    soil = soil_named("ding2011")
    assert soil.rim_angle == pytest.approx(0.76 * soil.friction_angle)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"exponent": 0.0}, "exponent"),
        ({"cohesion": -1.0}, "cohesion"),
        ({"friction_angle": 31.9}, "friction angle"),
        ({"cohesive_modulus": 0.0, "frictional_modulus": 0.0}, "carry"),
        ({"unloading_growth": 0.0}, "unloading"),
        ({"peak_slipping": 0.9}, "peak"),
        ({"rim_friction": 1.2}, "rim friction"),
        ({"slip_sinkage": 1e300}, "slip sinkage"),
        ({"ranges": {"shear_modulus": (0.02, 0.03)}}, "range of shear_modulus"),
    ],
)
def test_what_cannot_be_is_refused_by_name(change: dict[str, object], word: str) -> None:
    with pytest.raises(InputError, match=word):
        replace(soil_named("ding2011"), **change)  # type: ignore[arg-type]


def test_an_unknown_soil_is_told_with_the_known_ones() -> None:
    with pytest.raises(InputError, match="ding2011, fjs1"):
        soil_named("sahara")
