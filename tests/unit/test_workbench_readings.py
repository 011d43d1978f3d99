"""Readings of the thesis' tire: their mass is that of Table I, and the files of the search are their curves."""

from __future__ import annotations

from pathlib import Path

import pytest

from ancf_reduced.plates.mass import flexible_mass
from contracts.curves import read_curve
from workbench.questions.ancf.task import solve_orientation
from workbench.questions.words.readings import ORIENTATIONS, READINGS, reading_tasks
from workbench.study.ancf_tire import tire_from
from workbench.study.reading import built_in_study, read_study

ROOT = Path(__file__).parents[2]
TASKS = {task.name: task for task in reading_tasks(read_study(built_in_study()))}


@pytest.mark.parametrize("reading", READINGS, ids=lambda reading: reading.name)
def test_plates_weigh_what_table_i_says(reading: object) -> None:
    """Samarini 2020, Table I: 4.44157 kg."""
    task = TASKS[f"words_{reading.name}_phi000"]  # type: ignore[attr-defined]
    assert flexible_mass(tire_from(task.inputs).model) == pytest.approx(4.44157, rel=1e-4)


def test_every_reading_has_both_orientations_and_its_files() -> None:
    assert len(TASKS) == len(READINGS) * len(ORIENTATIONS)
    named = {f"{reading.name}_{o:g}deg.csv" for reading in READINGS for o in ORIENTATIONS}
    assert {path.name for path in (ROOT / "studies" / "thesis_tires").glob("*.csv")} == named


@pytest.mark.parametrize(
    ("name", "file"),
    [("words_hub40_edges_phi045", "hub40_edges_45deg"), ("words_hub60_centres_phi000", "hub60_centres_0deg")],
)
def test_a_file_of_the_search_is_the_tires_curve(name: str, file: str, tmp_path: Path) -> None:
    solve_orientation(TASKS[name].inputs, {}, tmp_path, lambda fraction: None)
    found, kept = read_curve(tmp_path / "curve.csv"), read_curve(ROOT / "studies" / "thesis_tires" / f"{file}.csv")
    assert kept.deflection == pytest.approx(found.deflection)
    assert kept.load == pytest.approx(found.load, rel=1e-6, abs=1e-6)
