"""Question: the wheel's own metal as thin ANCF plates, beside the solid model, nothing fitted.

Verified by tests/unit/test_workbench_ancf_wheel.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.questions.ancf_wheel.figures import ancf_wheel_figures
from workbench.questions.ancf_wheel.graph import ancf_wheel_tasks
from workbench.questions.ancf_wheel.results import AncfWheelRuns, energy_differences
from workbench.questions.model_curves import model_curves
from workbench.questions.question import Question
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most

__all__ = ["ANCF_WHEEL"]

_SOURCE = "our own solid model of the same design: code to code, no number fitted"


def _read(study: Study, folders: Mapping[str, Path]) -> AncfWheelRuns:
    return AncfWheelRuns(
        ancf=model_curves("ancf_wheel", folders, around(study)), fe=model_curves("fe", folders, around(study))
    )


def _checks(study: Study, runs: AncfWheelRuns) -> Sequence[Check]:
    def claim(name: str, title: str) -> Claim:
        words = f"ANCF wheel against the solid model, {title}"
        return Claim(id=f"ancf_wheel.{name}", title=words, quantity="difference", unit="-", role="gate", source=_SOURCE)

    def largest() -> float:
        return float(np.abs(runs.all_differences()).max())

    def mean() -> float:
        return float(np.abs(runs.all_differences()).mean())

    def energy() -> float:
        return float(np.abs(runs.all_differences(energy_differences)).max())

    limits = study.tolerances
    return [
        at_most(claim("load_largest", "load at any orientation"), largest, limits.ancf_wheel_largest),
        at_most(claim("load_mean", "load, mean over orientations and points"), mean, limits.ancf_wheel_mean),
        at_most(claim("energy_largest", "strain energy at any orientation"), energy, limits.ancf_wheel_largest),
    ]


def _curves(study: Study, runs: AncfWheelRuns) -> Sequence[StiffnessCurve]:
    return [*runs.ancf.by_orientation.values(), runs.ancf.average]


ANCF_WHEEL = Question(
    name="ancf_wheel",
    title="ANCF wheel",
    group="Wheel",
    tasks=ancf_wheel_tasks,
    read=_read,
    checks=_checks,
    figures=ancf_wheel_figures,
    curves=_curves,
    applies=lambda study: study.ancf_wheel is not None and without_ancf_wheel(study) is None,
)
