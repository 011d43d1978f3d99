"""The Python interface without a solve: what it refuses, what it finds in a store or a report's folder."""

from __future__ import annotations

import json
import logging
import math
import re
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

import workbench as ww
from contracts.curves import StiffnessCurve, write_curve
from contracts.errors import ConvergenceError, IncrementRecord, InputError, StudyError
from contracts.records import Check, Timing
from tests.small_report_folder import write_small_report
from workbench.execution import runner
from workbench.execution.result_files import FAILURE, increment_rows, write_result
from workbench.execution.store import Store
from workbench.execution.task import task_keys
from workbench.questions.curve_graph import stiffness_tasks

ROOT = Path(__file__).parents[2]
FIRST = ROOT / "studies" / "first.toml"
DEFLECTION = np.linspace(0.0, 0.04, 5)


@pytest.fixture(autouse=True)
def nobody_computes(monkeypatch: pytest.MonkeyPatch) -> None:
    """No test here may start a worker."""

    def refuse(*_: object) -> None:
        raise AssertionError("a worker was started")

    monkeypatch.setattr(runner, "LocalWorkers", refuse)


@pytest.fixture(scope="module")
def study() -> ww.Study:
    return ww.read_study(FIRST)


def stored(study: ww.Study, root: Path, angles: tuple[float, ...], failure: str | None = None) -> None:
    """Results of the FE tasks, made up: 10 N/mm and 1 N/mm more at each further orientation; fields at 200 N."""
    tasks = stiffness_tasks(study, "fe", angles)
    keys, store = task_keys(tasks), Store(root)
    for i, task in enumerate(tasks):
        folder = store.scratch()
        if task.name != "mesh":
            load = (9e3 + 1e3 * i) * DEFLECTION
            columns = {"max_von_mises_tire_Pa": 2e6 * load}
            curve = StiffnessCurve(
                model="fe",
                orientation_deg=None,
                deflection=DEFLECTION,
                load=load,
                columns=columns,
                partial=bool(failure),
            )
            write_curve(curve, folder / "curve.csv")
            record = IncrementRecord(
                target=0.04, step=0.01, converged=False, residuals=(1.0, math.inf)
            )  # a refused iterate
            write_result(folder, {FAILURE: failure, "increments": increment_rows([record])})
            (folder / "fields_200N.vtu").write_text("fields", encoding="utf-8")
        store.put(keys[task.name], folder, {"task": task.name, "wall_s": 1.0})


def test_the_built_in_study_is_read_without_a_path() -> None:
    assert ww.read_study().name == "exomars"
    assert ww.read_study(str(FIRST)).name == "first"


def test_what_is_wrong_with_a_study_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml: .*; ") as raised:
        ww.read_study(tmp_path / "nowhere.toml")
    assert "\n" not in str(raised.value)
    (tmp_path / "odd.toml").write_text(FIRST.read_text(encoding="utf-8").replace('"120 mm"', '"-120 mm"', 1))
    with pytest.raises(InputError, match=r"odd\.toml: wheel\.tire\.width = '-120 mm': must be") as raised:
        ww.read_study(tmp_path / "odd.toml")
    assert isinstance(raised.value.__cause__, StudyError)
    assert str(raised.value) == str(raised.value.__cause__)
    with pytest.raises(InputError, match="study file = 3: is no path"):
        ww.read_study(3)  # type: ignore[arg-type]


def test_what_is_unusual_is_warned_of(tmp_path: Path) -> None:
    text = FIRST.read_text(encoding="utf-8").replace('contact_stiffness = "1000 N/m"', 'contact_stiffness = "1e9 N/m"')
    (tmp_path / "odd.toml").write_text(text, encoding="utf-8")
    with pytest.warns(UserWarning, match=r"odd\.toml: ancf\.contact_stiffness = 1e9 N/m is unusual"):
        ww.read_study(tmp_path / "odd.toml")


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"model": "magic"}, "model = 'magic': is not known; give one of fe, section, ancf_wheel, ancf, brush"),
        ({"model": ["fe"]}, "is not known"),
        ({"orientation": float("nan")}, "orientation = nan: must be a finite number"),
        ({"orientation": -float("inf")}, "orientation = -inf: must be a finite number"),
        ({"orientation": 10**400}, "must be a finite number"),
        ({"orientation": True}, "orientation = True: must be a finite number"),
        ({"workers": True}, "workers = True: must be a whole number"),
        ({"orientation": "left"}, "orientation = 'left': must be a finite number"),
        ({"model": "brush", "orientation": "15"}, "must be a finite number"),
        ({"workers": 0}, "workers = 0: must be a whole number, at least 1"),
        ({"study": "my.toml"}, "study = 'my.toml': is no study; give what read_study returns"),
    ],
)
def test_bad_input_is_refused_before_anything_is_written(
    study: ww.Study, tmp_path: Path, given: dict[str, object], text: str
) -> None:
    with pytest.raises(InputError) as raised:
        ww.stiffness(**{"study": study, "store": tmp_path / "store"} | given)  # type: ignore[arg-type]
    assert text in str(raised.value)
    assert not (tmp_path / "store").exists()


@pytest.mark.parametrize("model", ["ancf", "brush"])
def test_a_model_that_the_study_does_not_have_is_refused(study: ww.Study, tmp_path: Path, model: str) -> None:
    with pytest.raises(InputError, match=rf"\[{model}\]: is not in the study"):
        ww.stiffness(study.model_copy(update={model: None}), model=model, store=tmp_path / "store")


@pytest.mark.parametrize("given", [15, 15.0, np.int64(15), np.float32(15.0), -345.0, 735.0, 15.0 + 1e-12])
def test_an_orientation_is_any_number_of_degrees(study: ww.Study, tmp_path: Path, given: float) -> None:
    stored(study, tmp_path, (15.0,))
    curve = ww.stiffness(study, model="fe", orientation=given, store=tmp_path)
    assert (curve.model, curve.orientation_deg) == ("fe", 15.0)
    assert curve.load_at(0.01) == pytest.approx(100.0)


def test_a_whole_turn_is_none(study: ww.Study, tmp_path: Path) -> None:
    stored(study, tmp_path, (0.0,))
    for given in (360.0, -1e-15, -720):
        assert ww.stiffness(study, orientation=given, store=tmp_path).orientation_deg == 0.0


def test_without_an_orientation_it_is_the_average(
    study: ww.Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    stored(study, tmp_path, (0.0, 45.0))
    monkeypatch.setenv("WORKBENCH_STORE", str(tmp_path))
    with caplog.at_level(logging.INFO, logger="workbench"):
        curve = ww.stiffness(study)
    assert curve.orientation_deg is None
    assert curve.load_at(0.01) == pytest.approx(105.0)
    assert curve.fields == {}
    assert caplog.messages == ["mesh: reused", "fe_phi000: reused", "fe_phi045: reused"]


def test_fields_and_stress_of_one_orientation(study: ww.Study, tmp_path: Path) -> None:
    stored(study, tmp_path, (0.0,))
    curve = ww.stiffness(study, orientation=0.0, store=tmp_path)
    assert {load: path.read_text() for load, path in curve.fields.items()} == {200.0: "fields"}
    assert all(path.is_absolute() for path in curve.fields.values())
    (row,) = curve.peak_stress(150.0).to_dict("records")
    assert row == {
        "part": "tire",
        "stress_Pa": pytest.approx(300e6),
        "max_von_mises_Pa": pytest.approx(300e6),
        "yield_strength_Pa": 880e6,
        "utilisation": pytest.approx(300 / 880),
    }
    with pytest.raises(InputError, match="load = 500 N: lies outside the curve"):
        curve.peak_stress(500.0)
    assert replace(curve, columns={}).peak_stress(150.0).empty


def test_a_curve_as_a_table_and_drawn(study: ww.Study, tmp_path: Path) -> None:
    stored(study, tmp_path, (0.0, 45.0))
    one, other = (ww.stiffness(study, orientation=angle, store=tmp_path) for angle in (0.0, 45.0))
    table = one.to_dataframe()
    assert list(table.columns[:2]) == ["deflection_m", "load_N"]
    assert table["load_N"].to_numpy() == pytest.approx(1e4 * DEFLECTION)
    ax = other.plot(one.plot())
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("radial deflection [mm]", "wheel load [N]")
    first, second = ax.lines
    assert (first.get_xdata()[-1], first.get_ydata()[-1]) == (pytest.approx(40.0), pytest.approx(400.0))  # type: ignore[index]
    assert first.get_color() != second.get_color()
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["fe 0°", "fe 45°"]  # type: ignore[union-attr]
    matplotlib.pyplot.close(ax.figure)


def test_a_partial_curve_is_an_error_that_holds_it(study: ww.Study, tmp_path: Path) -> None:
    stored(study, tmp_path, (0.0,), failure="stopped at 40 mm; try a finer mesh")
    with pytest.raises(
        ConvergenceError, match="fe_phi000 did not converge: stopped at 40 mm; try a finer mesh"
    ) as raised:
        ww.stiffness(study, orientation=0.0, store=tmp_path)
    curve = raised.value.last_good
    assert isinstance(curve, ww.Curve)
    assert curve.partial
    assert curve.deflection[-1] == 0.04
    assert [record.residuals for record in raised.value.history] == [(1.0, math.inf)]  # a refused iterate


@pytest.fixture
def report_folder(tmp_path: Path) -> Path:
    write_small_report(tmp_path / "report")
    check = Check(
        id="fe.mass", title="mass", quantity="mass", unit="kg", value=1.0, reference=(0.9, 1.1), tolerance="10 %",
        status="pass", role="gate", source="scales", claim="It weighs a kilogram.", why="as the scales do",
    )  # fmt: skip
    summary = {
        "schema": 1,
        "study": "small",
        "status": "pass",
        "checks": [asdict(check) | {"section": "wheel", "of_a_later_version": 1}],
        "timings": [asdict(Timing(task="mesh", wall_s=2.0, dofs=0))],
        "provenance": {"commit": "abc"},
    }
    (tmp_path / "report" / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    return tmp_path / "report"


def test_a_report_is_read(report_folder: Path) -> None:
    report = ww.read_report(str(report_folder))
    assert (report.study, report.status, report.provenance["commit"]) == ("small", "pass", "abc")
    assert report.check("fe.mass").reference == (0.9, 1.1)
    with pytest.raises(InputError, match=r"check = fe\.colour: is none of the 1"):
        report.check("fe.colour")
    table = report.checks_table()
    assert table[["id", "value", "status", "role"]].to_numpy().tolist() == [["fe.mass", 1.0, "pass", "gate"]]
    assert set(report.curves) == {"fe_phi000", "fe_phi030", "fe_average"}
    tilted, average = report.curves["fe_phi030"], report.curves["fe_average"]
    assert (tilted.model, tilted.orientation_deg) == ("fe", 30.0)
    assert (average.model, average.orientation_deg) == ("fe", None)
    assert average.to_dataframe()["load_N"].iloc[-1] == pytest.approx(8300.0 * 0.03)
    assert report.series["straight_brush"].to_dataframe().columns[0] == "time_s"
    assert report.fields["fe_phi000_200N"].is_file()
    assert report.timings[0].wall_s == 2.0


def test_the_page_s_code_on_reports_runs(report_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    (block,) = (one for one in re.findall(r"```python\n(.*?)```", text, flags=re.S) if "read_report" in one)
    monkeypatch.chdir(report_folder.parent)
    names: dict[str, Any] = {"ww": ww}
    exec(compile(block.replace("build/report", "report"), "python.md", "exec"), names)
    assert len(names["table"]) == 1
    assert names["failed"].empty


@pytest.mark.parametrize(
    ("summary", "text"),
    [("{}", "is no summary of a report"), ("[1]", "must be a table"), ('{"checks": [1]}', "is no summary of a report"),
     ('{"checks": [], "timings": [{}], "provenance": {}}', "is no summary of a report")],
)  # fmt: skip
def test_what_is_no_report_is_refused(report_folder: Path, summary: str, text: str) -> None:
    (report_folder / "summary.json").write_text(summary, encoding="utf-8")
    with pytest.raises(InputError, match=text):
        ww.read_report(report_folder)


def test_a_folder_without_a_report_is_refused(report_folder: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        ww.read_report(tmp_path / "nowhere")
    (report_folder / "summary.json").unlink()
    with pytest.raises(InputError, match="summary"):
        ww.read_report(report_folder)
