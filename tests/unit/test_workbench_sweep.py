"""A parameter study's graph, table, files and figure."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq  # type: ignore[import-untyped]
import pytest

from contracts.curves import StiffnessCurve, read_curve, write_curve
from contracts.hub_travel import Way
from workbench.execution.result_files import FAILURE, write_result
from workbench.execution.store import Entry
from workbench.execution.task import task_keys
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.sweep.figures import coordinate_axes, curves_figure, parallel_coordinates
from workbench.questions.sweep.graph import SweepGraph, sweep_graph
from workbench.questions.sweep.results import Outcome, outcomes, references
from workbench.questions.sweep.table import SweepTable, sweep_table
from workbench.questions.sweep.words import column_of
from workbench.report.parquet import write_parquet
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study_table, study_of
from workbench.study.sweep_points import sweep_points

PATH = built_in_study().parent / "exomars_hoops.toml"


def _swept(**sweep: Any) -> tuple[Study, SweepGraph]:
    table = read_study_table(PATH) | {"sweep": sweep}
    study = study_of(PATH, table)
    assert study.sweep is not None
    return study, sweep_graph(sweep_points(PATH, table), study.sweep.models)


def test_what_is_alike_is_one_task_with_the_key_it_has_in_a_study_of_its_own() -> None:
    """Two orientations share a mesh; the base's tasks are those of `workbench stiffness`."""
    study, graph = _swept(orientation=["0 deg", "15 deg"], models=["fe", "brush"])
    names = [task.name for task in graph.tasks]
    assert sum(name.endswith("/mesh") for name in names) == 1
    assert sum("/fe_phi" in name for name in names) == len(study.fe.orientations)
    own = task_keys(stiffness_tasks(study, "fe", ()))
    assert {graph.keys[f"p0/{name}"] for name in own} == set(own.values())
    last = graph.runs[-2]
    assert (last.point.number, last.model, last.curves) == (2, "fe", {"fe_phi015": "p0/fe_phi015"})
    assert task_keys(graph.tasks) == graph.keys


def test_at_a_temperature_only_the_materials_of_the_runs_change() -> None:
    _, graph = _swept(temperature=["-40 degC", "20 degC"], models=["fe"])
    cold = next(task for task in graph.tasks if task.name == "p1/fe_phi015")
    base = next(task for task in graph.tasks if task.name == "p0/fe_phi015")
    assert cold.inputs["materials"]["tire"]["thermal_strain"] < 0.0
    assert cold.inputs["materials"]["tire"]["young_modulus"] > base.inputs["materials"]["tire"]["young_modulus"]
    assert cold.needs == base.needs == ("p0/mesh",)
    assert {k: v for k, v in cold.inputs.items() if k != "materials"} == {
        k: v for k, v in base.inputs.items() if k != "materials"
    }


def _results(folder: Path, graph: SweepGraph, slopes: dict[str, float]) -> dict[str, Entry]:
    """Straight lines of 40 mm and stress 1 MPa/N as results of the tasks named, as entries of a store."""
    deflection = np.linspace(0.0, 0.04, 41)
    entries = {}
    for name, slope in slopes.items():
        path = folder / name
        path.mkdir(parents=True)
        load = slope * deflection
        columns = {"max_von_mises_tire_Pa": 1e6 * load, "max_von_mises_springs_Pa": 0.5e6 * load}
        curve = StiffnessCurve(model="section", orientation_deg=0.0, deflection=deflection, load=load, columns=columns)
        write_curve(curve, path / "curve.csv")
        write_result(path, {FAILURE: None})
        entries[name] = Entry(key=graph.keys[name], path=path, manifest={"wall_s": 2.0})
    return entries


@pytest.fixture
def made(tmp_path: Path) -> tuple[SweepTable, list[Outcome], SweepGraph]:
    """Three points and the base, of which the last point failed."""
    study, graph = _swept(**{"fe.max_load": ["290 N", "310 N", "320 N"]}, loads=["160 N", "250 N"])
    study = study.model_copy(update={"fe": study.fe.model_copy(update={"orientations": (0.0,)})})
    slopes = {}
    for task in graph.tasks:
        point = int(task.name[1])
        if point < 3:
            slopes[task.name] = 8000.0 + 1000.0 * point
    entries = _results(tmp_path, graph, slopes)
    failures = {task.name: f"task {task.name} failed: why" for task in graph.tasks if task.name.startswith("p3/")}
    found = outcomes(graph, entries, failures)
    return sweep_table(study, graph.keys, found, references(study, tmp_path, found)), found, graph


def test_the_table_has_what_was_varied_and_what_was_found(made: tuple[SweepTable, list[Outcome], SweepGraph]) -> None:
    """A line of slope k: tangent k, load k d, deflection F / k, stress 1 MPa/N, L2 |k / k_base - 1|."""
    table, _, graph = made
    assert table.column("point") == (0, 1, 2, 3)
    assert table.column("fe.max_load_N") == (None, 290.0, 310.0, 320.0)
    assert table.column("state") == ("whole", "whole", "whole", "failed")
    row = dict(zip(table.names, table.rows[2], strict=True))
    assert row["initial_tangent_N_per_m"] == pytest.approx(10000.0)
    assert row["load_at_20mm_N"] == pytest.approx(200.0)
    assert row["deflection_at_250N_m"] == pytest.approx(0.025)
    assert row["max_von_mises_at_250N_Pa"] == pytest.approx(250e6)
    assert row["relative_l2"] == pytest.approx(0.25)
    assert row["held_against"] == "the study as it is"
    assert row["wall_time_s"] == 2.0 * 5
    assert str(row["task_key"]).split() == [graph.keys[f"p2/section_phi{o:03d}"] for o in (0, 15, 30, 45, 60)]
    failed = dict(zip(table.names, table.rows[3], strict=True))
    assert failed["initial_tangent_N_per_m"] is None
    assert "task p3/section_phi000 failed: why" in str(failed["note"])


def test_a_travel_that_failed_leaves_the_curve_it_began_at(tmp_path: Path) -> None:
    _, graph = _swept(**{"fe.max_load": ["290 N"]})
    tasks = [task.name for task in graph.tasks if task.name.startswith("p1/section")]
    run = next(one for one in graph.runs if one.point.number == 1)
    moved = replace(run, tasks=(*run.tasks, "p1/moved"), travels={Way.LATERAL: {0.0: "p1/moved"}})
    entries = _results(tmp_path, graph, dict.fromkeys(tasks, 8000.0))
    (found,) = outcomes(replace(graph, runs=(moved,)), entries, {"p1/moved": "task p1/moved failed: why"})
    assert found.state == "partial"
    assert found.note == "task p1/moved failed: why"
    assert found.curve is not None
    assert found.curve.initial_tangent(0.005) == pytest.approx(8000.0)
    (whole,) = outcomes(replace(graph, runs=(run,)), entries, {})
    assert (whole.state, whole.note) == ("whole", "")


def test_a_curve_that_ends_early_says_where_and_why(tmp_path: Path) -> None:
    """Half of the curve is there: its state is partial, its numbers are those it reaches."""
    study, graph = _swept(**{"fe.max_load": ["290 N"]}, deflections=["10 mm", "30 mm"])
    tasks = [task.name for task in graph.tasks if task.name.startswith("p1/section")]
    for task, entry in _results(tmp_path, graph, dict.fromkeys(tasks, 8000.0)).items():
        whole = read_curve(entry.path / "curve.csv", model="section", orientation_deg=0.0)
        half = replace(
            whole,
            deflection=whole.deflection[:21],
            load=whole.load[:21],
            columns={name: values[:21] for name, values in whole.columns.items()},
            partial=True,
        )
        write_curve(half, entry.path / "curve.csv")
        write_result(entry.path, {FAILURE: f"{task} stopped"})
    entries = {t: Entry(key=graph.keys[t], path=tmp_path / t, manifest={"wall_s": 2.0}) for t in tasks}
    found = [outcome for outcome in outcomes(graph, entries, {}) if outcome.run.point.number == 1]
    table = sweep_table(study, graph.keys, found, {})
    assert table.column("state") == ("partial",)
    assert table.column("load_at_10mm_N") == (pytest.approx(80.0),)
    assert table.column("load_at_30mm_N") == (None,)
    (note,) = table.column("note")
    assert str(note).startswith("ends at 20 mm and 160 N; ")
    assert str(note).endswith(" stopped")


def test_csv_and_parquet_hold_the_same(made: tuple[SweepTable, list[Outcome], SweepGraph], tmp_path: Path) -> None:
    table, _, _ = made
    write_parquet(table, tmp_path / "sweep.parquet")
    parquet = pq.read_table(tmp_path / "sweep.parquet")
    assert tuple(parquet.column_names) == table.names
    assert [tuple(row.values()) for row in parquet.to_pylist()] == list(table.rows)
    assert str(parquet.schema.field("point").type) == "int64"
    assert str(parquet.schema.field("relative_l2").type) == "double"
    header, *rows = csv.reader(io.StringIO(table.csv()))
    assert tuple(header) == table.names
    for row, cells in zip(rows, table.rows, strict=True):
        for text, cell in zip(row, cells, strict=True):
            assert text == "" if cell is None else (text == cell if isinstance(cell, str) else float(text) == cell)


def test_a_reference_of_the_study_s_own_comes_before_the_base(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("deflection_mm,load_kN\n0,0\n40,0.32\n", encoding="utf-8")
    study, graph = _swept(**{"fe.max_load": ["300 N", "310 N"]})
    curve = {"file": "mine.csv", "label": "mine", "source": "me", "kind": "measured", "uncertainty": "1 %"}
    own = study_of(tmp_path / "s.toml", read_study_table(PATH) | {"reference": {"curves": [curve]}})
    found = outcomes(graph, {}, {})
    assert references(study, tmp_path, found) == {}
    reference = references(own, tmp_path, found)["section"]
    assert reference.label == "mine"
    assert (reference.curve.deflection[-1], reference.curve.load[-1]) == pytest.approx((0.04, 320.0))


def test_axes_are_those_every_drawn_row_has_a_number_for(made: tuple[SweepTable, list[Outcome], SweepGraph]) -> None:
    table, found, _ = made
    axes = {axis["label"]: axis for axis in coordinate_axes(table)}
    assert axes["fe.max load [N]"]["values"] == [290.0, 310.0]
    assert "relative L2 [-]" in axes
    assert [label for label in axes if not label.endswith("]")] == []
    assert axes["initial tangent [N/mm]"]["values"] == pytest.approx([9.0, 10.0])
    assert all(
        axis["range"][0] < min(axis["values"]) and max(axis["values"]) < axis["range"][1] for axis in axes.values()
    )
    figure = parallel_coordinates(table)
    assert '"type":"parcoords"' in figure
    drawn = figure.replace("\\u002f", "/")  # Plotly's spelling of a slash inside a page
    assert [label for label in axes if f'"label":"{label}"' not in drawn] == []
    curves = curves_figure(found, "section")
    assert "1: fe.max load 290 N" in curves
    assert "3: fe.max load 320 N" not in curves
    assert "the study as it is, " not in curves  # every point is a mean as the study is


def test_columns_are_words_in_units_that_engineers_read() -> None:
    told = {
        "initial_tangent_N_per_m": ("initial tangent [N/mm]", 1e-3),
        "deflection_at_40N_m": ("deflection at 40 N [mm]", 1e3),
        "load_at_7.5mm_N": ("load at 7.5 mm [N]", 1.0),
        "max_linearised_at_80N_Pa": ("stress in strips at 80 N [MPa]", 1e-6),
    }
    for name, (label, factor) in told.items():
        assert (column_of(name).label, column_of(name).factor) == (label, factor)


def test_a_point_at_one_orientation_is_held_against_the_study_at_that_one(tmp_path: Path) -> None:
    """Not against the mean of two, which no wheel has; its own curve again, no difference."""
    study, graph = _swept(orientation=["0 deg", "30 deg"], loads=["160 N", "250 N"])
    slopes = {"phi000": 9000.0, "phi030": 7000.0}
    entries = _results(tmp_path, graph, {t.name: slopes.get(t.name[-6:], 8000.0) for t in graph.tasks})
    found = outcomes(graph, entries, {})
    table = sweep_table(study, graph.keys, found, references(study, tmp_path, found))
    points = {row[0]: dict(zip(table.names, row, strict=True)) for row in table.rows}
    assert points[1]["held_against"] == "the study as it is, 0 deg"
    assert points[2]["held_against"] == "the study as it is, 30 deg"
    assert (points[1]["relative_l2"], points[2]["relative_l2"]) == (0.0, 0.0)
    assert points[0]["held_against"] == "the study as it is"
    curves = curves_figure(found, "section")
    assert "the study as it is, 30 deg" in curves
