"""Words of a study (names, titles, labels, sources, what is inferred) decide no result, and stand in the report."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from contracts.curves import read_curve, write_curve
from geometry.build import build_mesh
from rover_dynamics.tires.brush_tire import stiffness_curve
from workbench.execution.result_files import write_result
from workbench.execution.task import task_keys
from workbench.questions.curve_graph import mesh_tasks, stiffness_tasks
from workbench.questions.models.brush_task import solve as solve_brush
from workbench.questions.models.curves import brush_curve
from workbench.questions.study_graph import report_tasks
from workbench.questions.wheel.graph import mesh_task
from workbench.questions.wheel.mesh_task import measure
from workbench.questions.wheel.question import mesh_numbers
from workbench.study.model_parameters import brush_parameters
from workbench.study.reading import built_in_study, read_study_table, study_of
from workbench.study.wheel_design import design_from

BUILT_IN = built_in_study()
OTHER = "Other words: [b]=1+1</b>"
WORDS = ("title", "source", "label")


def _table() -> dict[str, Any]:
    """The built-in study with every text that a study may have beside it."""
    table = read_study_table(BUILT_IN)
    said = {"kind": "published", "source": "a text", "uncertainty": "3 %"}
    points = [{"load": "160 N", "low": "15 mm", "high": "20 mm"}]
    table["reference"] |= {"slope": said | {"value": "8.25 N/mm"}, "band": said | {"points": points}}
    table["reference"]["curves"] = [said | {"file": "amalia_fe.csv", "label": "a paper"}]
    return table


def _words(content: Any, place: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Where the words stand: texts of keys that decide nothing, and all that is inferred."""
    pairs = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    for key, value in pairs:
        if isinstance(value, str) and (key in WORDS or "inferred" in place):
            yield (*place, key)
        yield from _words(value, (*place, key))


PLACES = [("name",), *_words(_table())]


def _with(*changes: tuple[tuple[str | int, ...], str]) -> dict[str, Any]:
    """The table with other texts at these places."""
    table = copy.deepcopy(_table())
    for place, text in changes:
        content: Any = table
        for key in place[:-1]:
            content = content[key]
        content[place[-1]] = text
    return table


def _keys(table: dict[str, Any]) -> dict[str, str]:
    study = study_of(BUILT_IN, table)
    keys = task_keys(report_tasks(study))
    return keys | {f"section {name}": key for name, key in task_keys(stiffness_tasks(study, "section", ())).items()}


@pytest.fixture(scope="module")
def known() -> dict[str, str]:
    return _keys(_table())


def test_the_places_are_all_there() -> None:
    assert {place[-1] for place in PLACES} >= {"name", "title", "source", "label"}
    assert sum(place[0] == "inferred" for place in PLACES) == len(_table()["inferred"])
    assert ("reference", "curves", 0, "source") in PLACES
    assert ("materials", "Ti-6Al-4V", "source") in PLACES


def test_other_words_compute_nothing_again(known: dict[str, str]) -> None:
    """All at once: a key is a hash, so that no change can make up for another."""
    others = [(place, "other" if place == ("name",) else OTHER) for place in PLACES]
    assert _keys(_with(*others)) == known


def test_another_name_of_a_material_computes_nothing_again(known: dict[str, str]) -> None:
    text = BUILT_IN.read_text(encoding="utf-8")
    assert '"Ti-6Al-4V"' in text
    table = _table()
    table["materials"]["titanium"] = table["materials"].pop("Ti-6Al-4V")
    for part in table["wheel"].values():
        for one in part if isinstance(part, list) else [part]:
            one["material"] = "titanium"
    assert _keys(table) == known


def test_a_number_of_a_material_computes_the_wheel_again(known: dict[str, str]) -> None:
    keys = _keys(_with((("materials", "Ti-6Al-4V", "young_modulus"), "113.9 GPa")))
    assert {"mesh", "fe_phi000", "section section_phi000"} <= {name for name in keys if keys[name] != known[name]}
    assert keys["brush"] == known["brush"]


def test_meshes_for_other_programs_keep_the_names() -> None:
    study = study_of(BUILT_IN, _table())
    (files,) = (task for task in mesh_tasks(study, with_files=True) if task.name == "mesh_files")
    design = design_from(files.inputs["wheel"])
    assert (design.name, design.tire.material.name) == ("exomars", "Ti-6Al-4V")


def test_the_report_has_the_names_of_the_study(tmp_path: Path) -> None:
    study = study_of(BUILT_IN, _table())
    design = design_from(mesh_task(study, "mesh").inputs["wheel"])
    mesh = build_mesh(design, element_size=0.03, axial_size=0.06, half_width=True)
    write_result(tmp_path, measure(mesh, design))
    numbers = mesh_numbers(study, tmp_path)
    assert {row.material for row in numbers.parts.values()} == {"Ti-6Al-4V"}


def test_the_brush_line_has_the_source_of_the_study(tmp_path: Path) -> None:
    study = study_of(BUILT_IN, _with((("brush", "source"), OTHER)))
    (task,) = stiffness_tasks(study, "brush", ())
    solve_brush(task.inputs, {}, tmp_path, lambda _: None)
    parameters, end = brush_parameters(study), task.inputs["max_deflection"]
    write_curve(stiffness_curve(parameters, end), tmp_path / "as_before.csv")
    found, before = brush_curve(study, tmp_path), read_curve(tmp_path / "as_before.csv", model="brush")
    assert found.source == before.source
    assert OTHER in found.source
    assert (found.load == before.load).all()
