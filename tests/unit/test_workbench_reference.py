"""``[reference]``: what it accepts, what it refuses and in which words, and what earlier keys are called now."""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contracts.errors import InputError, StudyError
from workbench.commands.studies import run_new
from workbench.questions.words.graph import asked
from workbench.study.magnitudes import warnings_of
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study, study_of
from workbench.study.reference import kind_of
from workbench.study.reference_file import read_band, stated_uncertainty

FIRST = tomllib.loads(built_in_study().with_name("first.toml").read_text(encoding="utf-8"))
SAID = {"kind": "measured", "source": "test rig, June", "uncertainty": "3 %"}
SLOPE = SAID | {"value": "8.25 N/mm", "up_to": "4 mm"}
POINTS = [{"load": "160 N", "low": "19 mm", "high": "21 mm"}]
CURVE = SAID | {"file": "mine.csv", "label": "rig"}
BAND_FILE = "# source: a rig\ndeflection_m,load_N,load_low_N,load_high_N\n0,0,0,0\n0.01,80,78,82\n0.02,155,150,160\n"


def _study(folder: Path, **reference: Any) -> Study:
    (folder / "mine.csv").write_text("deflection_mm,load_N\n0,0\n10,80\n", encoding="utf-8")
    (folder / "band.csv").write_text(BAND_FILE, encoding="utf-8")
    return study_of(folder / "study.toml", copy.deepcopy(FIRST) | {"reference": reference})


def test_slope_band_and_curves_each_say_kind_source_and_uncertainty(tmp_path: Path) -> None:
    study = _study(tmp_path, slope=SLOPE, band=SAID | {"points": POINTS}, curves=[CURVE | {"kind": "published"}])
    reference = study.reference
    assert reference is not None
    assert reference.slope is not None
    assert (reference.slope.value, reference.slope.uncertainty, study.tangent_up_to) == (8250.0, 0.03, 0.004)
    kinds = [
        kind_of(reference, check) for check in ("fe.initial_tangent", "fe.deflection_at_160N", "user_0.relative_l2")
    ]
    assert kinds == ["measured", "measured", "published"]
    assert kind_of(reference, "fe.reach") is None
    np.testing.assert_allclose(stated_uncertainty(reference.curves[0]), [0.0, 2.4])
    assert Path(reference.curves[0].file) == tmp_path / "mine.csv"
    told = "Reference: Slope measured, test rig, June. Band measured, test rig, June. Rig published, test rig, June."
    assert study.reference_told == told


def test_a_band_may_lie_in_a_file(tmp_path: Path) -> None:
    study = _study(tmp_path, band=SAID | {"file": "band.csv"})
    assert study.reference is not None
    assert study.reference.band is not None
    band = read_band(Path(str(study.reference.band.file)))
    np.testing.assert_allclose(band.high, [0.0, 82.0, 160.0])


def test_without_it_nothing_is_judged(tmp_path: Path) -> None:
    study = study_of(tmp_path / "study.toml", FIRST)
    assert study.reference_told == "No reference: nothing of its stiffness is judged."
    assert (study.of_the_thesis, study.tangent_up_to) == (False, 0.005)


def test_the_uncertainty_of_a_curve_may_stand_in_its_file(tmp_path: Path) -> None:
    own = {key: value for key, value in CURVE.items() if key != "uncertainty"} | {"file": "own.csv"}
    (tmp_path / "own.csv").write_text("# uncertainty: 5 N\ndeflection_mm,load_N\n0,0\n10,80\n", encoding="utf-8")
    study = _study(tmp_path, curves=[own])
    np.testing.assert_allclose(stated_uncertainty(study.reference_curves[0]), [5.0, 5.0])
    study = _study(tmp_path, curves=[own | {"uncertainty": "10 %"}])  # goes before the file's
    np.testing.assert_allclose(stated_uncertainty(study.reference_curves[0]), [0.0, 8.0])


NO_UNCERTAINTY = {key: value for key, value in CURVE.items() if key != "uncertainty"}
BAD: dict[str, tuple[dict[str, Any], str]] = {
    "empty": ({}, "reference = a table: holds nothing to judge by; add slope, band or curves"),
    "words alone, and false": ({"thesis_words": False}, "reference.*holds nothing to judge by"),
    "no kind": ({"slope": {"value": 8250, "source": "s", "uncertainty": 0}}, r"reference\.slope\.kind.*is missing"),
    "no source": ({"slope": {"value": 8250, "kind": "measured", "uncertainty": 0}}, r"slope\.source.*is missing"),
    "no uncertainty": (
        {"slope": {"value": 8250, "kind": "measured", "source": "s"}},
        r"slope\.uncertainty.*is missing",
    ),
    "another kind": ({"slope": SLOPE | {"kind": "guessed"}}, r"slope\.kind = 'guessed'.*'measured', 'published' or"),
    "above all": ({"slope": SLOPE | {"uncertainty": 3}}, r"slope\.uncertainty = 3: must be less than or equal to 1"),
    "another unit": ({"slope": SLOPE | {"value": "8 mm"}}, r"slope\.value = '8 mm': .*a stiffness"),
    "both forms": ({"band": SAID | {"points": POINTS, "file": "band.csv"}}, r"band\.file = band.csv: is one way"),
    "no form": ({"band": SAID}, r"band\.file.*: is one way to give a band, points the other; give one of them"),
    "turned round": (
        {"band": SAID | {"points": [{"load": "160 N", "low": "21 mm", "high": "19 mm"}]}},
        r"reference\.band\.points\[0\]\.low = 21 mm: must not exceed high = 19 mm",
    ),
    "slope beyond the curves": (
        {"slope": SLOPE | {"up_to": "70 mm"}},
        r"slope\.up_to = 70 mm: must not exceed fe.max_deflection = 34 mm",
    ),
    "a load beyond the curves": (
        {"band": SAID | {"points": [{"load": "900 N", "low": "19 mm", "high": "21 mm"}]}},
        r"points\[0\]\.load = 900 N: lies beyond fe.max_load = 300 N",
    ),
    "a deflection beyond the curves": (
        {"band": SAID | {"points": [{"load": "160 N", "low": "50 mm", "high": "60 mm"}]}},
        r"points\[0\]\.low = 50 mm: lies beyond fe.max_deflection = 34 mm",
    ),
    "a band that turns back": (
        {
            "band": SAID
            | {
                "points": [
                    {"load": "250 N", "low": "10 mm", "high": "12 mm"},
                    {"load": "160 N", "low": "19 mm", "high": "21 mm"},
                ]
            }
        },
        r"points\[0\] = 10 to 12 mm: contradicts 19 to 21 mm at 160 N",
    ),
    "a band that turns back behind a wide point": (
        {
            "band": SAID
            | {
                "points": [
                    {"load": f"{load} N", "low": f"{low} mm", "high": f"{high} mm"}
                    for load, low, high in ((160, 19, 21), (200, 5, 33), (250, 10, 12))
                ]
            }
        },
        r"points\[2\] = 10 to 12 mm: contradicts 19 to 21 mm at 160 N",
    ),
    "one load twice, as it is shown": (
        {
            "band": SAID | {"points": [{"load": f"160.000{k} N", "low": "19 mm", "high": "21 mm"} for k in (1, 2)]},
        },
        r"points\[1\] = 19 to 21 mm: contradicts",
    ),
    "one load twice": (
        {"band": SAID | {"points": [{"load": "160 N", "low": "19 mm", "high": "21 mm"}] * 2}},
        r"points\[1\] = 19 to 21 mm: contradicts",
    ),
    "no band in it": ({"band": SAID | {"file": "mine.csv"}}, r"reference\.band\.file = mine.csv: "),
    "no file": ({"curves": [CURVE | {"file": "none.csv"}]}, r"reference\.curves\[0\]\.file = none.csv: "),
    "no half width": ({"curves": [NO_UNCERTAINTY]}, r"curves\[0\]\.uncertainty: is missing: neither the study nor the"),
    "negative": ({"curves": [CURVE | {"uncertainty": "-3 %"}]}, r"curves\[0\]\.uncertainty = -3 %: must lie between"),
    "no such orientation": ({"curves": [CURVE | {"orientation": "7 deg"}]}, "must be one of fe.orientations"),
}


@pytest.mark.parametrize(("reference", "message"), BAD.values(), ids=BAD)
def test_bad_input_is_one_message(tmp_path: Path, reference: dict[str, Any], message: str) -> None:
    with pytest.raises(StudyError, match=message):
        _study(tmp_path, **reference)


def test_a_band_whose_ends_are_turned_round_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bad.csv").write_text(BAND_FILE.replace("78,82", "82,78"), encoding="utf-8")
    with pytest.raises(InputError, match="needs 0 <= load_low_N <= load_high_N"):
        read_band(tmp_path / "bad.csv")


MOVED = {
    "compare": ({"compare": {"curves": [CURVE]}}, r"compare = a table: is \[\[reference\.curves\]\] now; "),
    "wheel": (
        {"tolerances": {"reference_wheel": True}},
        r"tolerances\.reference_wheel = True: is \[reference\] thesis_words",
    ),
    "up to": (
        {"tolerances": {"initial_tangent_up_to": 0.005}},
        r"initial_tangent_up_to = 0\.005: is .* slope\.up_to now",
    ),
    "slope": (
        {"reference": {"initial_tangent": 8250, "source": "s"}},
        r"reference\.initial_tangent.* slope\.value now",
    ),
    "points": ({"reference": {"points": POINTS, "source": "s"}}, r"reference\.points = a list: is .* band\.points now"),
}


@pytest.mark.parametrize(("table", "message"), MOVED.values(), ids=MOVED)
def test_an_earlier_key_names_the_new_one(table: dict[str, Any], message: str) -> None:
    with pytest.raises(StudyError, match=message):
        study_of(Path("study.toml"), copy.deepcopy(FIRST) | table)


def test_the_thesis_words_are_asked_of_the_wheel_that_says_so_and_not_of_a_copy(tmp_path: Path) -> None:
    assert asked(read_study(built_in_study()))
    path = tmp_path / "mine.toml"
    assert run_new(path, "exomars") == 0
    copied = read_study(path)
    assert (copied.reference, asked(copied)) == (None, False)
    assert "reference.thesis_words" not in copied.inferred


def test_words_that_cannot_be_asked_are_told(tmp_path: Path) -> None:
    assert not [line for line in warnings_of(read_study(built_in_study())) if "thesis_words" in line]
    (line,) = (line for line in warnings_of(_study(tmp_path, thesis_words=True)) if "thesis_words" in line)
    assert line.startswith("reference.thesis_words judges no stiffness: the thesis' words need [ancf] with")


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("0,0,0,0\n10,80,78,82\n20,160,155,165\n", "deflection_m holds 20, beyond any wheel's 1"),
        ("0,0,0,0\n0.01,80,78,inf\n", "load_high_N holds inf"),
        ("0,0,0,0\n0.01,80,78,1e99\n", r"load_high_N holds 1e\+99"),
        ("0,0,0,0\n0.3,80,78,82\n", "has no row between first contact and fe.max_deflection = 34 mm"),
    ],
)
def test_a_band_file_in_other_units_or_out_of_reach_is_refused(tmp_path: Path, rows: str, message: str) -> None:
    (tmp_path / "other.csv").write_text(f"deflection_m,load_N,load_low_N,load_high_N\n{rows}", encoding="utf-8")
    with pytest.raises(StudyError, match=message):
        _study(tmp_path, band=SAID | {"file": "other.csv"})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("deflection_m,load_N\n0.2,80\n0.3,160\n", "goes from 200 to 300 mm and shares nothing with 0 to fe.max_defl"),
        ("deflection_m,load_N\n-0.02,0\n-0.01,80\n", "shares nothing with 0 to"),
        ("deflection_m,load_N\n0,0\n0.04,0\n0.05,80\n", "holds no load above zero from 0 to 34 mm"),
        ("deflection_m,load_N,load_N\n0,0,0\n0.01,8,80\n", "has two columns load_N"),
        ("deflection_m,load_N,deflection_mm\n0,0,0\n0.01,8,10\n", "has two columns of deformation"),
        ("# uncertainty: lots\ndeflection_m,load_N\n0,0\n0.01,80\n", "uncertainty.*lots"),
    ],
)
def test_a_curve_that_cannot_be_compared_is_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "other.csv").write_text(text, encoding="utf-8")
    with pytest.raises(StudyError, match=message):
        _study(tmp_path, curves=[CURVE | {"file": "other.csv"}])


def test_a_curve_that_begins_loaded_is_taken(tmp_path: Path) -> None:
    (tmp_path / "stiff.csv").write_text("deflection_m,load_N\n0.001,300\n0.02,1600\n", encoding="utf-8")
    assert _study(tmp_path, curves=[CURVE | {"file": "stiff.csv"}]).reference is not None


def test_a_band_with_one_header_twice_is_refused_and_one_without_a_lower_end_is_taken(tmp_path: Path) -> None:
    header = "deflection_m,load_N,load_low_N,load_high_N"
    (tmp_path / "twice.csv").write_text(f"{header},load_low_N\n0,0,0,0,0\n0.01,80,78,82,1\n", encoding="utf-8")
    with pytest.raises(InputError, match="has two columns load_low_N"):
        read_band(tmp_path / "twice.csv")
    (tmp_path / "open.csv").write_text(f"{header}\n0,0,0,0\n0.001,8,0,15\n", encoding="utf-8")
    assert read_band(tmp_path / "open.csv").low.tolist() == [0.0, 0.0]


def test_a_curve_without_load_is_refused(tmp_path: Path) -> None:
    (tmp_path / "zeros.csv").write_text("deflection_m,load_N\n0,0\n0.01,0\n0.02,0\n", encoding="utf-8")
    with pytest.raises(StudyError, match="holds no load above zero"):
        _study(tmp_path, curves=[CURVE | {"file": "zeros.csv", "uncertainty": "3 %"}])
