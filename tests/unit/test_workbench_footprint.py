"""Footprints in the workbench: which studies have the task, what it needs, its figure."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.footprint import Footprint
from workbench.questions.fe.figures import footprint_figure
from workbench.questions.fe.graph import fe_curve_tasks, footprint_tasks
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def test_it_follows_every_curve_of_the_study(study: Study) -> None:
    curves = fe_curve_tasks(study)
    tasks = footprint_tasks(study, curves)
    assert [task.needs for task in tasks] == [("mesh", curve.name) for curve in curves]
    assert tasks[1].name == "footprint_phi015"
    assert tasks[1].inputs["case"]["orientation_deg"] == 15.0


@pytest.mark.parametrize(
    "changes",
    [
        {"snapshot_loads": ()},
        {"contact_stiffness": None},
        {"contact_method": "augmented_lagrangian"},
    ],
)
def test_none_where_no_gap_tells_the_pressure(study: Study, changes: dict[str, object]) -> None:
    changed = study.model_copy(update={"fe": study.fe.model_copy(update=changes)})
    assert footprint_tasks(changed, fe_curve_tasks(changed)) == []


def test_its_figure_shows_the_first_orientation() -> None:
    place = np.array([[-0.02, 0.01], [0.03, -0.04]])
    one = Footprint(place=place, force=np.array([150.0, 50.0]), pressure=np.array([1e6, 2e6]))
    assert "heatmap" in footprint_figure({0.0: one})
    assert footprint_figure({}) == ""
