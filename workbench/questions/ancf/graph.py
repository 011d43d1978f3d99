"""Tasks of the ANCF tire's curves. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from workbench.execution.task import Task
from workbench.questions.ancf.preset_table import preset_table
from workbench.study.model import Study, stated
from workbench.study.model_parameters import ancf_tire
from workbench.study.orientation import degrees, orientation_name
from workbench.study.sections import AncfSection

__all__ = ["ancf_curve_tasks"]


def ancf_curve_tasks(study: Study, orientations_deg: Sequence[float] = ()) -> list[Task]:
    """A curve at each orientation [deg]; none means those of the study."""
    ancf = stated(study.ancf, "ancf")
    grid = np.linspace(0.0, ancf.max_deflection, ancf.points + 1).round(12).tolist()
    points = sorted({*grid, *_table_deflections(ancf)})
    tire = ancf_tire(study)
    return [
        Task(
            name=orientation_name("ancf", orientation),
            function="workbench.questions.ancf.task:solve_orientation",
            inputs=tire | {"orientation_deg": orientation, "deflections": points},
            cost=10.0,
        )
        for orientation in orientations_deg or [degrees(o) for o in ancf.orientations]
    ]


def _table_deflections(ancf: AncfSection) -> list[float]:
    """Deflections of the preset's table [m] that the study reaches, solved themselves and never interpolated."""
    if not ancf.thesis_preset:
        return []
    return [d for d in preset_table()[:, 0].round(12).tolist() if d <= ancf.max_deflection]
