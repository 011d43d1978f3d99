"""Files the user gets: schema of summary and JUnit, whole files only, other people's files left alone."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check, Timing
from contracts.series import TimeSeries
from workbench.report.evidence import Evidence
from workbench.report.folders import check_folder
from workbench.report.opening import verdict
from workbench.report.outputs import curve_file, junit, publish, summary, to_json
from workbench.report.own_files import FILES
from workbench.verdict.number_format import displayed, displayed_reference, largest_by_unit, power_of_ten


def _check(name: str, role: str = "gate", status: str = "pass", value: float | None = 8.0) -> Check:
    return Check(
        id=name,
        title="A <title> & more",
        quantity="initial tangent",
        unit="N/m",
        value=value,
        reference=(1.0, 2.0),
        tolerance="3 %",
        status=status,  # type: ignore[arg-type]
        role=role,  # type: ignore[arg-type]
        source="a source",
        claim="It holds.",
        why="ours",
    )


CHECKS = [
    _check("a"),
    _check("b", status="fail"),
    _check("c", status="error", value=None),
    _check("d", role="finding", status="fail"),
]


def _curve(model: str, orientation: float | None) -> StiffnessCurve:
    d = np.array([0.0, 0.01])
    return StiffnessCurve(model=model, orientation_deg=orientation, deflection=d, load=8250.0 * d)


def test_summary_has_exactly_the_agreed_fields() -> None:
    evidence = [Evidence(check=c, section="fe", tasks={"t": "0f"}, files=("curves/fe_average.csv",)) for c in CHECKS]
    verdict = {"computation": "no", "wheel": "undecided", "models": {"brush": "no"}}
    timings = [Timing(task="t", wall_s=1.0, dofs=3)]
    made = json.loads(to_json(summary("s", evidence, timings, {"commit": None}, verdict)))
    assert list(made) == ["schema", "study", "status", "verdict", "checks", "timings", "provenance"]
    assert (made["schema"], made["study"], made["status"], made["verdict"]) == (2, "s", "fail", verdict)
    fields = ["id", "title", "quantity", "unit", "value", "reference", "tolerance", "status", "role", "source"]
    fields += ["claim", "why", "theory", "tests", "section", "tasks", "files"]
    assert all(list(c) == fields for c in made["checks"])
    assert made["checks"][0]["tasks"] == {"t": "0f"}
    assert made["checks"][0]["reference"] == [1.0, 2.0]
    assert made["checks"][2]["value"] is None
    assert made["timings"] == [{"task": "t", "wall_s": 1.0, "dofs": 3}]


def test_junit_counts_gates_only_and_names_every_check() -> None:
    root = ElementTree.fromstring(junit("s", CHECKS))
    (suite,) = root
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("4", "1", "1")
    assert [case.get("name") for case in suite] == ["a", "b", "c", "d"]
    undecided = ElementTree.fromstring(junit("s", [_check("e", status="undecided")]))
    assert [undecided[0].get("failures"), undecided[0][0][0].tag] == ["1", "failure"]
    kinds = [next(iter(case)).tag for case in suite]
    assert kinds == ["system-out", "failure", "error", "system-out"]
    assert "A <title> & more" in suite[1][0].get("message", "")


@pytest.mark.parametrize(
    ("model", "orientation", "name"),
    [
        ("fe", 0.0, "fe_phi000.csv"),
        ("fe", 15.0, "fe_phi015.csv"),
        ("ancf", 345.0, "ancf_phi345.csv"),
        ("fe", 22.5, "fe_phi022.5.csv"),
        ("ancf", None, "ancf_average.csv"),
        ("brush", None, "brush_average.csv"),
    ],
)
def test_curve_file_names(model: str, orientation: float | None, name: str) -> None:
    assert curve_file(_curve(model, orientation)) == name


def test_publish_replaces_ours_and_leaves_the_rest(tmp_path: Path) -> None:
    out = tmp_path / "report"
    field = tmp_path / "field"
    field.write_text("field", encoding="utf-8")
    curves, copies = [_curve("fe", 0.0), _curve("fe", 30.0)], {"fields/fe_phi000_200N.vtu": field}
    assert publish(out, "report", {"report.html": "one"}, curves, copies=copies) == []
    assert (out / "fields" / "fe_phi000_200N.vtu").read_text(encoding="utf-8") == "field"
    (out / "notes.txt").write_text("mine", encoding="utf-8")
    (out / "curves" / "digitised.csv").write_text("mine", encoding="utf-8")
    assert publish(out, "report", {"report.html": "two"}, [_curve("fe", 0.0)]) == []
    assert list((out / "fields").iterdir()) == []
    assert (out / "report.html").read_text(encoding="utf-8") == "two"
    assert sorted(p.name for p in (out / "curves").iterdir()) == ["digitised.csv", "fe_phi000.csv"]
    assert sorted(p.name for p in out.iterdir()) == [FILES, "curves", "fields", "notes.txt", "report.html"]


def _series(scenario: str, tire: str = "ancf") -> TimeSeries:
    return TimeSeries(
        scenario=scenario, tire=tire, time=np.array([0.0, 0.1]), columns={"hub_z_m": np.array([1.0, 2.0])}
    )


def test_series_are_published_and_replaced(tmp_path: Path) -> None:
    """Those of an earlier run go, other people's files stay; two of one name are refused before anything is written."""
    publish(tmp_path, "report", {"report.html": "one"}, series=[_series("drop"), _series("drop", "brush")])
    (tmp_path / "series" / "measured.csv").write_text("mine", encoding="utf-8")
    publish(tmp_path, "report", {"report.html": "two"}, series=[_series("ride")])
    assert sorted(p.name for p in (tmp_path / "series").iterdir()) == ["measured.csv", "ride_ancf.csv"]
    with pytest.raises(InputError, match=r"drop_ancf\.csv"):
        publish(tmp_path / "new", "report", {"report.html": "three"}, series=[_series("drop"), _series("drop")])
    assert not (tmp_path / "new").exists()


def test_a_publish_that_fails_leaves_the_earlier_set(tmp_path: Path) -> None:
    publish(tmp_path, "report", {"report.html": "one"}, [_curve("fe", 0.0)])
    with pytest.raises(AttributeError):
        publish(tmp_path, "report", {"report.html": "two", "b": None}, [_curve("fe", 30.0)])  # type: ignore[dict-item]
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == "one"
    assert [p.name for p in (tmp_path / "curves").iterdir()] == ["fe_phi000.csv"]
    assert sorted(p.name for p in tmp_path.iterdir()) == [FILES, "curves", "report.html"]


def test_output_folder_that_cannot_be_made_is_refused_early(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    check_folder(tmp_path / "new" / "deep")
    for bad in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(InputError, match="--out"):
            check_folder(bad)


def test_a_link_to_nothing_is_refused(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    for bad in (tmp_path / "link", tmp_path / "link" / "below"):
        with pytest.raises(InputError, match="link to nothing"):
            check_folder(bad)


@pytest.mark.parametrize("name", ["report.html", "summary.json", "curves/fe_phi030.csv"])
def test_a_folder_in_a_file_s_place_is_found_before_anything_moves(tmp_path: Path, name: str) -> None:
    publish(tmp_path, "report", {"note.html": "one"}, [_curve("fe", 0.0)])
    (tmp_path / name).mkdir()
    texts = {"note.html": "two", "report.html": "two", "summary.json": "two"}
    with pytest.raises(InputError, match="is a folder"):
        publish(tmp_path, "report", texts, [_curve("fe", 30.0)])
    assert (tmp_path / "note.html").read_text(encoding="utf-8") == "one"
    assert (tmp_path / "curves" / "fe_phi000.csv").is_file()
    assert not (tmp_path / "curves" / "fe_phi030.csv").is_file()


def test_a_file_in_a_folder_s_place_is_found_before_anything_moves(tmp_path: Path) -> None:
    (tmp_path / "curves").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is not a folder"):
        publish(tmp_path, "report", {"report.html": "two"}, [_curve("fe", 30.0)])
    assert [p.name for p in tmp_path.iterdir()] == ["curves"]
    (tmp_path / "curves").unlink()
    (tmp_path / "fields").symlink_to(tmp_path / "nowhere")
    with pytest.raises(InputError, match="is not a folder"):
        publish(
            tmp_path, "report", {"report.html": "two"}, [_curve("fe", 30.0)], copies={"fields/a.vtu": tmp_path / "a"}
        )
    assert [p.name for p in tmp_path.iterdir()] == ["fields"]


def test_verdict_is_one_sentence() -> None:
    assert verdict([_check("a")]) == "All 1 gates passed; every finding lies inside its limits."
    assert verdict(CHECKS) == "2 of 3 gates did not pass; 1 finding outside its limits."
    unknown = [_check(f"e{i}", role="finding", status="error", value=None) for i in range(4)]
    assert verdict([*CHECKS[3:], *unknown]).endswith("; 1 finding outside its limits, 4 undecided or not evaluated.")
    assert verdict([_check("a"), *unknown]).endswith("; no finding outside its limits, 4 undecided or not evaluated.")
    assert verdict([CHECKS[3], CHECKS[3]]).endswith("; 2 findings outside their limits.")


@pytest.mark.parametrize(
    ("value", "unit", "quantity", "text"),
    [
        (8250.0, "N/m", "tangent", "8.25 N/mm"),
        (0.0196, "m", "deflection", "19.6 mm"),
        (0.0316, "-", "spread", "3.16 %"),
        (3.47e-15, "-", "residual", "3.47·10⁻¹⁵"),
        (0.0, "-", "residual", "0"),
        (None, "N", "load", "–"),
        (36.28, "N", "load", "36.28 N"),
    ],
)
def test_numbers_as_a_reader_wants_them(value: float | None, unit: str, quantity: str, text: str) -> None:
    assert displayed(value, unit, quantity) == text


def test_reference_interval() -> None:
    assert displayed_reference(_check("a")) == "0.001 … 0.002 N/mm"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Torque:
    value: float
    unit: str


def test_round_off_is_no_number_beside_the_values_of_its_table() -> None:
    """A torque of 4.5e-14 N m among some of 30 N m; alone, or above round-off, it is shown as it is."""
    scales = largest_by_unit([_Torque(value=v, unit="N m") for v in (-30.0, 4.5e-14)] + [_Torque(value=2.0, unit="m")])
    assert scales == {"N m": 30.0, "m": 2.0}
    assert displayed(4.5e-14, "N m", scale=scales["N m"]) == "≈ 0 N m"
    assert displayed(-1e-10, "m", scale=scales["m"]) == "≈ 0 mm"
    assert displayed(4.5e-14, "N m") == "4.50·10⁻¹⁴ N m"
    assert displayed(1e-7, "N m", scale=scales["N m"]) == "1.00·10⁻⁷ N m"
    assert displayed(0.0, "N m", scale=scales["N m"]) == "0 N m"


def test_powers_of_ten_are_written_as_such() -> None:
    assert [power_of_ten(2.9e-3, 2), power_of_ten(1e-4, 1), power_of_ten(-5.26e12)] == [
        "2.9·10⁻³",
        "10⁻⁴",
        "-5.26·10¹²",
    ]
