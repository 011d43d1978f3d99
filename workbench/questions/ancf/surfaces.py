"""The task that writes the ANCF tire's surfaces. Verified by tests/unit/test_workbench_ancf_surfaces.py."""

from __future__ import annotations

from collections.abc import Sequence

from workbench.execution.task import Task
from workbench.study.model import Study, stated
from workbench.study.model_parameters import ancf_tire
from workbench.study.orientation import degrees

__all__ = ["SURFACES", "report_surfaces_task", "surfaces_task"]

SURFACES = "ancf_surfaces"
"""Name of the task."""
_REPORTED_DEFLECTION = 0.010
"""Deflection [m] of the loaded tire in the report, where a study reaches it."""


def surfaces_task(study: Study, orientation_deg: float, deflections: Sequence[float]) -> Task:
    """The tire unloaded, and at deflections [m] in increasing order at one orientation."""
    return Task(
        name=SURFACES,
        function="workbench.questions.ancf.surfaces_task:write_surfaces",
        inputs=ancf_tire(study) | {"orientation_deg": orientation_deg, "deflections": list(deflections)},
        cost=3.0,
    )


def report_surfaces_task(study: Study) -> Task:
    """What the report states: the first orientation, unloaded and at 10 mm."""
    ancf = stated(study.ancf, "ancf")
    return surfaces_task(study, degrees(ancf.orientations[0]), [min(_REPORTED_DEFLECTION, ancf.max_deflection)])
