"""Question: what elastic hubs, cone and impact springs add to the curve, one part after another.

Verified by tests/unit/test_workbench_hub.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from contracts.records import Check
from workbench.execution.result_files import read_result
from workbench.execution.task import Task
from workbench.questions.fe.graph import fe_inputs, fe_task, without_end
from workbench.questions.model_curves import CURVE
from workbench.questions.question import Question
from workbench.questions.wheel.graph import coarse_across, mesh_task
from workbench.study.laws import HUB_PARTS
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees
from workbench.study.wheel_design import wheel_design
from workbench.verdict.rules import Claim, at_most

__all__ = ["HUB", "HubRun", "HubStudy", "held_parts"]


@dataclass(frozen=True, slots=True, kw_only=True)
class HubRun:
    """One step: the parts that are elastic beside rim and springs, and the curve."""

    elastic: tuple[str, ...]
    curve: StiffnessCurve
    dofs: int


@dataclass(frozen=True, slots=True, kw_only=True)
class HubStudy:
    """Runs on one mesh, from all parts within the springs rigid to all of them elastic.

    Attributes
    ----------
    orientation_deg : where [deg]
    deflections : where loads are compared [m]
    runs : each with one part more elastic than the one before, outside to inside
    """

    orientation_deg: float
    deflections: tuple[float, ...]
    runs: tuple[HubRun, ...]

    def reached(self, run: HubRun, deflection: float) -> bool:
        """Whether this run and the rigid one came as far as a deflection [m]."""
        return all(r.curve.deflection[-1] >= deflection - 1e-12 for r in (run, self.runs[0]))

    def load(self, run: HubRun, deflection: float) -> float:
        """Load [N] of a run at one of the deflections [m]."""
        return float(run.curve.load_at(deflection))

    def change(self, run: HubRun, deflection: float) -> float:
        """Load of a run over that with everything rigid, minus 1 [-]."""
        return self.load(run, deflection) / self.load(self.runs[0], deflection) - 1.0


def held_parts(study: Study) -> tuple[tuple[str, ...], ...]:
    """Rigid parts of each run, outside to inside: all of them first, none last."""
    parts = tuple(part for part in HUB_PARTS if part in wheel_design(study).materials)
    return tuple(parts[i:] for i in range(len(parts) + 1))


def _run_name(held: Sequence[str]) -> str:
    return f"fe_hub_{len(held)}_rigid"


def _tasks(study: Study) -> Sequence[Task]:
    section = stated(study.hub_study, "hub_study")
    mesh = mesh_task(study, "mesh_hub", {"parts": "all", **coarse_across(study)})
    deflections = np.round(section.deflections, 12).tolist()
    inputs = without_end(fe_inputs(study, degrees(section.orientation), deflections))
    runs = [(_run_name(held), inputs | {"rigid_parts": list(held)}) for held in held_parts(study)]
    return [mesh, *(fe_task(name, changed, mesh.name) for name, changed in runs)]


def _read(study: Study, folders: Mapping[str, Path]) -> HubStudy:
    section = stated(study.hub_study, "hub_study")
    orientation, steps = degrees(section.orientation), held_parts(study)
    runs = []
    for held in steps:
        folder = folders[_run_name(held)]
        curve = read_curve(folder / CURVE, model="fe", orientation_deg=orientation)
        elastic = tuple(part for part in steps[0] if part not in held)
        runs.append(HubRun(elastic=elastic, curve=curve, dofs=read_result(folder)["dofs"]))
    return HubStudy(orientation_deg=orientation, deflections=section.deflections, runs=tuple(runs))


def _checks(study: Study, results: HubStudy) -> Sequence[Check]:
    last, end = results.runs[-1], results.deflections[-1]
    claim = Claim(
        id="fe.hub_compliance",
        title=f"FE: change of load with elastic hubs, cone and impact springs at {end * 1e3:g} mm, "
        f"{results.orientation_deg:g} deg",
        quantity="change of load",
        unit="-",
        role="finding",
        source="rigid hubs on the same mesh; the limit is ours",
    )
    return [at_most(claim, lambda: abs(results.change(last, end)), study.tolerances.hub_compliance)]


def _curves(study: Study, results: HubStudy) -> list[StiffnessCurve]:
    names = map(_run_name, held_parts(study))
    return [replace(run.curve, model=name) for name, run in zip(names, results.runs, strict=True)]


HUB = Question(
    name="hub",
    title="Hub compliance",
    group="Wheel",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    curves=_curves,
    applies=lambda study: study.hub_study is not None and study.parametric.inner_hub is not None,
)
