"""Curves as CSV: round trip, files people make by hand, files that cannot be used."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, read_curve, write_curve
from contracts.errors import InputError


def sample(source: str = "a solver, 2026", partial: bool = False) -> StiffnessCurve:
    d = np.linspace(0.0, 0.03, 7)
    return StiffnessCurve(
        model="fe",
        orientation_deg=15.0,
        deflection=d,
        load=8250.0 * d / 3.0,
        columns={"patch_length_m": np.sqrt(d), "newton": np.arange(7.0)},
        source=source,
        partial=partial,
    )


@pytest.mark.parametrize("partial", [False, True])
def test_round_trip_to_twelve_digits(tmp_path: Path, partial: bool) -> None:
    path = tmp_path / "new" / "fe_phi015.csv"
    write_curve(sample(partial=partial), path)
    back = read_curve(path, model="fe", orientation_deg=15.0)
    np.testing.assert_allclose(back.deflection, sample().deflection, rtol=1e-11)
    np.testing.assert_allclose(back.load, sample().load, rtol=1e-11)
    assert list(back.columns) == ["patch_length_m", "newton"]
    np.testing.assert_allclose(back.columns["patch_length_m"], sample().columns["patch_length_m"], rtol=1e-11)
    assert (back.model, back.orientation_deg, back.source, back.partial) == ("fe", 15.0, "a solver, 2026", partial)


def test_header_is_the_contract(tmp_path: Path) -> None:
    path = tmp_path / "c.csv"
    write_curve(sample(), path)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0] == "# source: a solver, 2026"
    assert lines[1] == "deflection_m,load_N,patch_length_m,newton"
    assert lines[2] == "0,0,0,0"


def test_a_source_of_several_lines_stays_a_comment(tmp_path: Path) -> None:
    path = tmp_path / "c.csv"
    write_curve(sample(source="line one\nline two"), path)
    assert read_curve(path).source == "line one line two"


def test_a_file_made_by_hand_is_read(tmp_path: Path) -> None:
    """A byte order mark (spreadsheets write it), Windows line ends, blank lines, spaces: none of them is an error."""
    path = tmp_path / "digitised.csv"
    path.write_bytes(b"\xef\xbb\xbf# source: Figure 7\r\ndeflection_m, load_N\r\n\r\n0, 0\r\n0.01, 80.5\r\n# end\r\n")
    back = read_curve(path)
    np.testing.assert_array_equal(back.deflection, [0.0, 0.01])
    np.testing.assert_array_equal(back.load, [0.0, 80.5])
    assert (back.model, back.orientation_deg, back.source) == ("digitised", None, "Figure 7")


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("", "must have a header deflection_m,load_N and two or more rows"),
        ("deflection_m,load_N\n0,0\n", "two or more rows"),
        ("0,0\n0.01,80\n0.02,160\n", "must have a header"),
        ("deflection_mm,load_N\n0,0\n10,80\n", "must have a header"),
        ("load_N,deflection_m\n0,0\n80,0.01\n", "must have a header"),
        ("# c\n\ndeflection_m,load_N\n0,0\n0.01,many\n", "has a bad row, line 5 .*'many'"),
        ("deflection_m,load_N\n0,0\n0.01\n", "has 1 value in line 3 under 2 headers"),
        ("deflection_m,load_N,more\n0,0\n0.01,80\n", "has 2 values in line 2 under 3 headers"),
        ("deflection_m,load_N\n0,0,5\n0.01,80,6\n", "has 3 values in line 2 under 2 headers"),
        ("deflection_m,load_N\n0\n0.01\n", "has 1 value in line 2 under 2 headers"),
        ("deflection_m,load_N\n0,0\n0.02,160\n0.01,80\n", "must increase strictly"),
        ("deflection_m,load_N\n0,0\n0.01,nan\n", "not finite"),
    ],
)
def test_files_that_cannot_be_used_are_refused(tmp_path: Path, text: str, rule: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=rule) as caught:
        read_curve(path)
    assert str(path) in str(caught.value)


def test_a_missing_file_a_folder_and_a_binary_file_are_refused(tmp_path: Path) -> None:
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00\x01")
    for path in (tmp_path / "missing.csv", tmp_path, binary):
        with pytest.raises(InputError, match=r"does not exist|is a folder|is not UTF-8") as caught:
            read_curve(path)
        assert str(path) in str(caught.value)
