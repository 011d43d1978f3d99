"""The page of what is chosen and inferred: every number is read from the place that uses it, and says why."""

from __future__ import annotations

from pathlib import Path

import pytest

from contracts.errors import InputError
from rover_dynamics.tires.brush_settings import BrushSettings
from workbench.report.chosen import chosen_groups
from workbench.study.key_units import nameless
from workbench.study.magnitudes import warnings_of
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())
NUMBERS = {one.name: one for group in chosen_groups(STUDY) for one in group.numbers}


def test_every_number_resolves_and_says_why() -> None:
    assert len(NUMBERS) == sum(len(group.numbers) for group in chosen_groups(STUDY))
    assert len(NUMBERS) > 35
    for one in NUMBERS.values():
        assert one.kind in ("inferred", "chosen")
        assert min(len(text) for text in (one.value, one.why, one.changes, one.source)) > 0
        assert one.why.endswith(".")
        assert one.changes.endswith(".")


def test_values_are_those_of_the_study_the_rover_file_and_the_code() -> None:
    thinner = STUDY.model_copy(update={"wheel": STUDY.wheel.model_copy(update={"tire": _thin(0.0005)})})
    changed = {one.name: one for group in chosen_groups(thinner) for one in group.numbers}
    assert changed["Thickness of the rim"].value == "0.5 mm"
    assert NUMBERS["Thickness of the rim"].value == f"{1e3 * STUDY.wheel.tire.thickness:g} mm"
    assert NUMBERS["Relaxation length"].value == f"{1e3 * BrushSettings().relaxation_length:g} mm"
    assert NUMBERS["Centre of mass of the principal body (x, y, z)"].value == "(-20.2, 0, 430) mm"
    assert NUMBERS["Lean allowed over obstacles"].value == "30 deg"


def test_a_reason_for_no_key_of_the_study_is_told() -> None:
    given = {"wheel.tire.thicknes": "a", "whee.*": "b", "wheel.*.material": "c", "": "d", "fe.orientations": "e"}
    given |= {"...": "f", "[]": "g", "fe.friction.banana": "h", "name[3].foo": "i", f"wheel.springs[{'9' * 5000}]": "j"}
    told = [
        warning for warning in warnings_of(STUDY.model_copy(update={"inferred": given})) if "names no key" in warning
    ]
    wrong = ["wheel.tire.thicknes", "whee.*", "", "...", "[]", "fe.friction.banana", "name[3].foo"]
    assert [warning.split("'")[1] for warning in told][:7] == wrong
    assert len(told) == 8


def test_every_reason_in_the_study_files_is_for_a_key() -> None:
    for file in built_in_study().parent.glob("*.toml"):
        assert nameless(read_study(file)) == ()


def _thin(thickness: float) -> object:
    return STUDY.wheel.tire.model_copy(update={"thickness": thickness})


def test_what_belongs_to_the_shipped_wheel_is_left_out_elsewhere() -> None:
    other = STUDY.model_copy(update={"reference": None, "name": "other"})
    titles = [group.title for group in chosen_groups(other)]
    assert "The wheel" not in titles
    assert "Continuum model" in titles


@pytest.mark.parametrize(
    ("row", "says"),
    [
        ("", "must have one of study, rover, code"),
        ('study = "wheel.tyre.thickness"', "is not there"),
        ('study = "fe.hub"\ncode = "a:b"', "must have one"),
    ],
)
def test_a_number_without_a_place_is_refused(tmp_path: Path, row: str, says: str) -> None:
    texts = 'name = "n"\nkind = "chosen"\nwhy = "w"\nchanges = "c"\nsource = "s"'
    (tmp_path / "chosen.toml").write_text(f'[[group]]\ntitle = "t"\n[[group.number]]\n{texts}\n{row}\n', "utf-8")
    with pytest.raises(InputError, match=says):
        chosen_groups(STUDY, tmp_path / "chosen.toml")
