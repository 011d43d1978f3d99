"""Question: does the mesh have the volume and the mass of the wheel that was designed?

Verified by tests/unit/test_workbench_checks.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.question import Question
from workbench.questions.wheel.checks import mesh_checks
from workbench.questions.wheel.graph import wheel_meshes
from workbench.questions.wheel.results import WheelMeshes, read_wheel
from workbench.study.model import Study

__all__ = ["WHEEL"]


def _tasks(study: Study) -> Sequence[Task]:
    return wheel_meshes(study)


def _checks(study: Study, results: WheelMeshes) -> Sequence[Check]:
    return mesh_checks(results.solved, results.whole, study.tolerances)


def _figures(study: Study, results: WheelMeshes) -> Mapping[str, str]:
    from workbench.charts.packing import picture_link
    from workbench.questions.wheel.scene import parts_scene

    return {"parts_scene": parts_scene(results.whole_folder, picture_link(results.picture))}


WHEEL = Question(
    name="wheel", title="Wheel", group="Wheel", tasks=_tasks, read=read_wheel, checks=_checks, figures=_figures
)
