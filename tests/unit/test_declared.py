"""Numbers are held against what is declared of them where their attribute stands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

import pytest

from contracts.declared import Angle, Count, In, PositiveLength, Whole, declared_types, require_declared
from contracts.errors import InputError
from geometry.parts import SpringSet, Tire
from workbench.study.declared import meanings
from workbench.study.wheel import SpringsSection


@dataclass(frozen=True, slots=True, kw_only=True)
class _Part:
    """A part.

    Attributes
    ----------
    width, height : outer sizes, along the axle
        and across [m]
    ratio : of something [-]

    Raises
    ------
    InputError
        Always so.
    """

    width: PositiveLength = 0.1
    height: PositiveLength | None = None
    ratio: Annotated[float, In("", above=-1.0, below=0.5)] = 0.3
    damping: Annotated[float, In("N*s/m", least=0.0)] = 0.0
    count: Count = 3
    phase: Angle = 0.0
    bands: tuple[tuple[PositiveLength, Angle], ...] = ()
    points: tuple[Annotated[int, Whole(2, 9)], Annotated[int, Whole(2, 9)]] = (2, 2)


def test_what_is_as_declared_passes() -> None:
    require_declared(_Part(height=0.2, damping=1.0, bands=((0.1, -1.0), (0.2, 0.0))))


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("width", 0.0, "part width = 0 mm: must be finite and greater than zero"),
        ("width", math.nan, "part width = nan mm: must be finite"),
        ("height", -0.1, "part height = -100 mm"),
        ("ratio", 0.5, "part ratio = 0.5: must lie in (-1, 0.5)"),
        ("ratio", -1.0, "part ratio = -1: must lie in (-1, 0.5)"),
        ("damping", -1.0, "part damping = -1 N*s/m: must be finite and at least 0"),
        ("count", 0, "part count = 0: must be a whole number >= 1"),
        ("count", 2.0, "must be a whole number"),
        ("count", True, "must be a whole number"),
        ("phase", math.inf, "part phase = inf rad: must be finite"),
        ("bands", ((0.1, 0.0), (-0.1, 0.0)), "part bands = -100 mm"),
        ("points", (2, 1), "part points = 1: must be a whole number >= 2"),
    ],
)
def test_what_is_not_is_named_with_value_unit_rule_and_key(name: str, value: Any, said: str) -> None:
    with pytest.raises(InputError) as caught:
        require_declared(_Part(**{name: value}), "part")
    assert said in str(caught.value)
    assert caught.value.key == name


def test_meanings_come_from_the_attributes_of_the_class_alone() -> None:
    size = "outer sizes, along the axle and across [m]"
    assert meanings(_Part) == {"width": size, "height": size, "ratio": "of something [-]"}


def test_a_section_has_unit_limits_default_and_meaning_of_the_library() -> None:
    fields = SpringsSection.model_fields
    assert set(declared_types(SpringSet)) == set(fields)
    assert fields["phase"].default == 0.0
    assert fields["thickness"].description.startswith("strip thickness")
    read = SpringsSection(
        name="a", count=3, bands=[["-1 mm", "1 mm"]], thickness="0.6 mm", shape="arc", weld_length="8 mm", material="Ti"
    )
    assert (read.bands, read.thickness) == (((-0.001, 0.001),), 0.0006)  # type: ignore[attr-defined]


def test_a_dataclass_without_declarations_is_not_judged() -> None:
    """Negative control: nothing is asked of what is not declared."""

    @dataclass
    class Plain:
        width: float = -1.0

    require_declared(Plain())
    assert declared_types(Tire)["width"] is PositiveLength
