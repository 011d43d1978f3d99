"""Curve files in other units and other deformations, on numbers converted by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from contracts.errors import InputError
from workbench.study.curve_file import MeasuredCurve, in_si, load_uncertainty, newtons, read_measured_curve


def _read(folder: Path, text: str) -> MeasuredCurve:
    path = folder / "mine.csv"
    path.write_text(text, encoding="utf-8")
    return read_measured_curve(path)


RADIUS = "# unloaded_radius: 142.5 mm\nloaded_radius_mm,load_N\n"
SAME = {
    "own format": "deflection_m,load_N\n0,0\n0.01,80\n0.02,165\n",
    "mm and kN": "deflection_mm,load_kN\n0,0\n10,0.08\n20,0.165\n",
    "brackets": "Radial deflection [mm],Force [N]\n0,0\n10,80\n20,165\n",
    "parentheses": "radial deflection (cm),wheel load (daN)\n0,0\n1,8\n2,16.5\n",
    "load first": "load_N,deflection_mm\n0,0\n80,10\n165,20\n",
    "between others": "time_s,hub_drop_um,note,force_mN\n0,0,1,0\n1,10000,1,80000\n2,20000,1,165000\n",
    "contact approach": "contact_approach_mm,load_N\n0,0\n10,80\n20,165\n",
    "said in a comment": "# deformation: approach\ndeflection_m,load_N\n0,0\n0.01,80\n0.02,165\n",
    "loaded radius": "# unloaded_radius: 142.5 mm\nloaded_radius_mm,load_N\n142.5,0\n132.5,80\n122.5,165\n",
    "hub above ground": "# Unloaded radius: 0.1425 m\nhub height [m],load_N\n0.1425,0\n0.1325,80\n0.1225,165\n",
}


@pytest.mark.parametrize("text", SAME.values(), ids=SAME.keys())
def test_ways_to_write_one_curve(tmp_path: Path, text: str) -> None:
    found = _read(tmp_path, text)
    np.testing.assert_allclose(found.curve.deflection, [0.0, 0.01, 0.02], rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(found.curve.load, [0.0, 80.0, 165.0], rtol=1e-13)
    assert (found.kind, found.uncertainty, found.curve.model) == ("radial deflection", None, "mine")


def test_pounds_and_inches(tmp_path: Path) -> None:
    found = _read(tmp_path, "deflection_in,load_lbf\n0,0\n1,10\n")
    np.testing.assert_allclose(found.curve.deflection, [0.0, 0.0254], rtol=1e-13)
    np.testing.assert_allclose(found.curve.load, [0.0, 44.4822161526], rtol=1e-11)


@pytest.mark.parametrize(
    "text",
    [
        "diameter_change_mm,load_N\n0,0\n10,80\n",
        "diametral compression [mm],load_N\n0,0\n10,80\n",
        "# deformation: change of diameter\ndeflection_m,load_N\n0,0\n0.01,80\n",
        "# unloaded_diameter: 285 mm\nloaded_diameter_mm,load_N\n285,0\n275,80\n",
    ],
)
def test_a_change_of_diameter_keeps_its_kind(tmp_path: Path, text: str) -> None:
    found = _read(tmp_path, text)
    assert found.kind == "change of diameter"
    np.testing.assert_allclose(found.curve.deflection, [0.0, 0.01], rtol=1e-12, atol=1e-16)
    with pytest.raises(InputError, match="change of diameter between two plates"):
        in_si(tmp_path / "mine.csv")


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("deflection_m,load_N,load_uncertainty_N\n0,0,1\n0.01,80,2\n", [1.0, 2.0]),
        ("deflection_mm,load_kN,load_uncertainty_N\n0,0,1\n10,0.08,2\n", [1.0, 2.0]),
        ("deflection_m,load_N,load_uncertainty_%\n0,0,5\n0.01,80,5\n", [0.0, 4.0]),
        ("# uncertainty: 3 %\ndeflection_m,load_N\n0,0\n0.01,80\n", [0.0, 2.4]),
        ("# uncertainty: 0.5 lbf\ndeflection_m,load_N\n0,0\n0.01,80\n", [2.22411080763] * 2),
    ],
)
def test_stated_uncertainty(tmp_path: Path, text: str, wanted: list[float]) -> None:
    found = _read(tmp_path, text).uncertainty
    assert found is not None
    np.testing.assert_allclose(found, wanted, rtol=1e-11)


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("deflection_kg,load_N\n0,0\n10,80\n", "unit must be a length"),
        ("deflection_mm,load_lb\n0,0\n10,80\n", "unit must be a force"),
        ("deflection_furlongish,load_N\n0,0\n10,80\n", "unit cannot be read"),
        ("deflection,load_N\n0,0\n10,80\n", "deflection without a unit"),
        ("deflection_mm,load\n0,0\n10,80\n", "load without a unit"),
        ("x_mm,load_N\n0,0\n10,80\n", "no column of deformation"),
        ("deflection_mm,y_N\n0,0\n10,80\n", "no column of load"),
        ("deflection_mm;load_N\n0;0\n10;80\n", "parts its columns by semicolons"),
        ("deflection_mm\tload_N\n0\t0\n10\t80\n", "parts its columns by tabs"),
        ("deflection_mm,diameter_change_mm,load_N\n0,0,0\n10,20,80\n", "two columns of deformation"),
        ("deflection_mm,load_N,force_N\n0,0,0\n10,20,80\n", "two columns of load"),
        ("loaded_radius_mm,load_N\n142.5,0\n132.5,80\n", "does not say the unloaded size"),
        ("# unloaded_radius: 142.5\nloaded_radius_mm,load_N\n142.5,0\n132.5,80\n", "needs its unit"),
        ("# deformation: shear\ndeflection_mm,load_N\n0,0\n10,80\n", "deformation that is not known: shear"),
        ("# deformation: change of diameter\nradial_deflection_m,load_N\n0,0\n1,80\n", "in a comment and"),
        ("# uncertainty: 300 %\ndeflection_m,load_N\n0,0\n0.01,80\n", "between 0 and 100 %"),
        ("# uncertainty: some\ndeflection_m,load_N\n0,0\n0.01,80\n", "must be a force"),
        ("deflection_m,load_N,load_uncertainty_N\n0,0,1\n0.01,80,-2\n", "negative or missing value"),
        ("deflection_m,load_N,load_uncertainty_m\n0,0,1\n0.01,80,2\n", "unit must be a force"),
        ("deflection_mm,load_N\n0,0\n20,80\n10,160\n", r"must increase strictly \(line 4\)"),
        ("deflection_mm,load_kN\n0,0\n10,1e308\n", r"not finite \(line 3\)"),
        ("deflection_mm,load_N\n0,0\n10\n", "1 value in line 3"),
        ("deflection_mm,load_N\n", "two or more rows"),
        ("deflection_mm,load_N\n0,0\n3_0,24_7.5\n", r"bad row, line 3 \(.*'3_0'"),
        ("deflection_mm,load_N\n0,0\n٣٠,247\n", r"bad row, line 3"),
        (f"{RADIUS}142.5,0\n100,100\n-50,247\n", r"leaves -50 mm of 142.5 mm: the wheel would be gone.*\(line 5\)"),
        (f"{RADIUS}142.5,0\n0,100\n", "leaves 0 mm of 142.5 mm"),
        (f"{RADIUS}152.5,0\n100,100\n", r"has 152.5 mm under load, more than the unloaded 142.5 mm \(line 3\)"),
        ("# unloaded_radius: 142.5 mm\ndeflection_mm,load_N\n0,0\n142.5,80\n", "leaves 0 mm of 142.5 mm"),
        ("# unloaded_diameter: 285 mm\nloaded_diameter_mm,load_N\n285,0\n-1,80\n", "leaves -1 mm of 285 mm"),
        ("# unloaded_diameter: 285 mm\ndiameter_change_mm,load_N\n0,0\n290,80\n", "leaves -5 mm of 285 mm"),
        (
            "# unloaded_radius: 1e300 mm\ndeflection_mm,load_N\n0,0\n30,80\n",
            "unloaded_radius = 1e300 mm: must lie between 5 mm",
        ),
        ("# unloaded_radius: -142.5 mm\ndeflection_mm,load_N\n0,0\n30,80\n", "must be greater than zero"),
        ("# unloaded_radius: 0 mm\ndeflection_mm,load_N\n0,0\n30,80\n", "must lie between 5 mm"),
    ],
)
def test_files_that_cannot_be_used(tmp_path: Path, text: str, rule: str) -> None:
    with pytest.raises(InputError, match=rule) as caught:
        _read(tmp_path, text)
    assert "mine.csv" in str(caught.value)


def test_a_first_point_may_lie_above_the_unloaded_radius_by_noise(tmp_path: Path) -> None:
    assert _read(tmp_path, f"{RADIUS}142.6,0\n132.5,80\n").curve.deflection[0] == pytest.approx(-1e-4)


@pytest.mark.parametrize(
    "lines",
    [
        ("uncertainty: 5 %", "uncertainty: 50 %"),
        ("unloaded_radius: 142.5 mm", "Unloaded radius: 150 mm"),
        ("unloaded_diameter: 285 mm", "unloaded_diameter: 300 mm"),
        ("deformation: approach", "deformation: change of diameter"),
        ("partial: True", "partial: False"),
    ],
)
def test_a_thing_said_twice_and_differently_is_refused_in_either_order(tmp_path: Path, lines: tuple[str, str]) -> None:
    rows = "deflection_mm,load_N\n0,0\n30,247\n"
    for first, second in (lines, lines[::-1]):
        with pytest.raises(InputError, match=f"says {lines[0].partition(':')[0]} twice, .* and "):
            _read(tmp_path, f"# {first}\n# {second}\n{rows}")
    assert _read(tmp_path, f"# {lines[0]}\n# {lines[0].replace(' ', '  ')}\n# source: a\n# source: b\n{rows}").curve


def test_a_file_in_the_own_format_is_handed_on_as_it_is_and_others_converted(tmp_path: Path) -> None:
    path = tmp_path / "c.csv"
    own = "# source: me\ndeflection_m,load_N,extra\n0,0,7\n0.01,80,8\n"
    path.write_text(own, encoding="utf-8")
    assert in_si(path) == own
    path.write_text("# source: me\ndeflection_mm,load_kN\n0,0\n10,0.08\n", encoding="utf-8")
    assert read_measured_curve(path).kind == "radial deflection"
    converted = tmp_path / "si.csv"
    converted.write_text(in_si(path), encoding="utf-8")
    back = read_curve(converted)
    np.testing.assert_allclose(back.load_at([0.0, 0.01]), [0.0, 80.0], rtol=1e-12)
    assert back.source == "me"
    radius = "# deformation: loaded radius\n# unloaded_radius: 0.1425 m\ndeflection_m,load_N\n0.1425,0\n0.1325,80\n"
    path.write_text(radius, encoding="utf-8")
    converted.write_text(in_si(path), encoding="utf-8")
    np.testing.assert_allclose(read_curve(converted).deflection, [0.0, 0.01], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "wanted"), [("3 %", 6.0), ("0.03", 6.0), ("5 N", 5.0), ("5e-3 kN", 5.0), ("0 %", 0.0)]
)
def test_uncertainty_as_text(text: str, wanted: float) -> None:
    assert float(load_uncertainty(text, np.array([-200.0]))[0]) == pytest.approx(wanted)


@pytest.mark.parametrize("text", ["3", "-1 %", "101 %", "nan", "", "%", "5 mm", "3,5 %", "2*3 N"])
def test_uncertainty_that_is_none(text: str) -> None:
    with pytest.raises(InputError, match="uncertainty"):
        load_uncertainty(text, np.array([200.0]))


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        ((1e12, 1.0), "largest deflection = .* must lie"),
        ((1.0, 1e12), "largest load = .* must"),
        ((1e-12, 1.0), "must"),
        ((1.0, 1e-14), "largest load = .* must"),
    ],
)
def test_numbers_that_no_tire_has_are_refused(tmp_path: Path, factor: tuple[float, float], words: str) -> None:
    rows = "".join(f"{factor[0] * d},{factor[1] * 8 * d}\n" for d in range(12))
    (tmp_path / "c.csv").write_text(f"deflection_mm,load_N\n{rows}", encoding="utf-8")
    with pytest.raises(InputError, match=words):
        read_measured_curve(tmp_path / "c.csv")


def test_an_uncertainty_beyond_numbers_is_refused() -> None:
    with pytest.raises(InputError, match="must not exceed 1e12 N"):
        load_uncertainty("1e200 N", np.ones(3))


def test_a_tire_that_carries_nothing_is_a_curve(tmp_path: Path) -> None:
    """Zero is a load; next to zero is a mistaken unit."""
    (tmp_path / "c.csv").write_text("deflection_mm,load_N\n0,0\n10,0\n20,0\n", encoding="utf-8")
    assert read_measured_curve(tmp_path / "c.csv").curve.load.max() == 0.0


def test_an_endless_header_is_refused_at_once(tmp_path: Path) -> None:
    """Looking for its unit took time as its length squared."""
    (tmp_path / "a.csv").write_text(f"deflection{'_' * 100_000}!,load_N\n0,0\n1,5\n", encoding="utf-8")
    with pytest.raises(InputError, match="has no column of deformation"):
        read_measured_curve(tmp_path / "a.csv")


@pytest.mark.parametrize(("text", "newton"), [("250", 250.0), (" 1e3 ", 1000.0), ("0.25 kN", 250.0), ("-1", -1.0)])
def test_loads_of_the_command_line(text: str, newton: float) -> None:
    assert newtons("max load", text) == newton


@pytest.mark.parametrize("text", ["", "3 mm", "lots", "1e999", "nan"])
def test_loads_that_are_none(text: str) -> None:
    with pytest.raises(InputError, match="max load"):
        newtons("max load", text)
