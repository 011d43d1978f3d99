"""Ranges as data: which row holds for a number, what is refused, what is told, ratios of two numbers."""

from __future__ import annotations

import math

import pytest

from contracts.ranges import Range, RangeTable, Ratio, dotted, oddities

LENGTH = Range(
    keys=("wheel.*.thickness", "wheel.at"), what="a strip", unit="mm", possible=(0.2, 100), usual=(1, 10), hint="hint"
)
SIGNED = Range(
    keys=("phase",), what="an angle", unit="deg", possible=(0.01, 720), usual=(1, 360), hint="hint", zero=True
)
TABLE = RangeTable(
    ranges=(LENGTH, SIGNED),
    ratios=(Ratio(key="m.*.y", beside="m.*.e", possible=(1e-6, 1), usual=(1e-4, 0.1)),),
)


@pytest.mark.parametrize(
    ("number", "impossible"),
    [(0.2e-3, False), (0.19e-3, True), (1e-3, None), (10e-3, None), (0.1, False), (0.101, True), (0.0, True),
     (math.inf, True), (-5e-3, None)],
)  # fmt: skip
def test_magnitudes_are_possible_unusual_or_usual(number: float, impossible: bool | None) -> None:
    found = list(oddities({("wheel", 3, "thickness"): number}, TABLE))
    assert [odd.impossible for odd in found] == ([] if impossible is None else [impossible])


def test_messages_are_in_the_row_s_unit() -> None:
    (refused,) = oddities({("wheel", "at"): 20.0}, TABLE)
    assert (refused.value, refused.rule) == ("20000 mm", "must lie between 0.2 mm and 100 mm")
    (told,) = oddities({("wheel", "at"): 0.02}, TABLE)
    assert (told.value, told.rule) == ("20 mm", "is unusual for a strip (1 mm to 10 mm)")


def test_zero_passes_where_it_means_something() -> None:
    assert not list(oddities({("phase",): 0.0}, TABLE))
    (told,) = oddities({("phase",): -1e-9}, TABLE)  # as good as zero, such as round-off
    assert (told.impossible, told.rule) == (False, "is unusual for an angle (1 deg to 360 deg)")
    (odd,) = oddities({("phase",): -1e9}, TABLE)
    assert (odd.impossible, odd.rule) == (True, "must not exceed 720 deg in magnitude")


def test_a_ratio_joins_numbers_of_the_same_part() -> None:
    numbers = {("m", "a", "y"): 5.0, ("m", "a", "e"): 10.0, ("m", "b", "y"): 50.0, ("m", "b", "e"): 10.0}
    unusual, refused = oddities(numbers, TABLE)
    assert (unusual.key, unusual.impossible) == (("m", "a", "y"), False)
    assert unusual.rule == "is unusual beside (0.0001 to 0.1 times) m.a.e, and is 0.5 times"
    assert (refused.key, refused.impossible) == (("m", "b", "y"), True)
    assert not list(oddities({("m", "a", "y"): 5.0}, TABLE))
    assert not list(oddities({("m", "a", "y"): 5.0, ("m", "a", "e"): 0.0}, TABLE))


def test_keys_are_written_as_a_user_reads_them() -> None:
    assert dotted(("wheel", "springs", 0, "count")) == "wheel.springs[0].count"
    assert TABLE.row(("wheel", "tire", "inner", "thickness")) is None
    assert TABLE.row(("wheel", "x", "thickness")) is LENGTH
