"""Question: the wheel's own metal as thin ANCF plates, beside the solid model, nothing fitted.

Verified by tests/unit/test_workbench_ancf_wheel.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check, Role
from workbench.execution.result_files import read_result
from workbench.questions.ancf_wheel.figures import ancf_wheel_figures
from workbench.questions.ancf_wheel.graph import ancf_wheel_tasks
from workbench.questions.ancf_wheel.results import AncfWheelRuns, energy_differences, stress_differences
from workbench.questions.model_curves import model_curves
from workbench.questions.question import Question
from workbench.study.ancf_wheel import without_ancf_wheel
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_most

__all__ = ["ANCF_WHEEL"]

_SOURCE = "our own solid model of the same design: code to code, no number fitted"


def _read(study: Study, folders: Mapping[str, Path]) -> AncfWheelRuns:
    asked = folders.get("ancf_wheel_shape")
    return AncfWheelRuns(
        ancf=model_curves("ancf_wheel", folders, around(study)),
        fe=model_curves("fe", folders, around(study)),
        shapes=None if asked is None else read_result(asked)["rows"],
    )


def _checks(study: Study, runs: AncfWheelRuns) -> Sequence[Check]:
    def claim(name: str, title: str, role: Role = "gate", unit: str = "-") -> Claim:
        words, quantity = f"ANCF wheel against the solid model, {title}", "difference" if unit == "-" else "distance"
        return Claim(id=f"ancf_wheel.{name}", title=words, quantity=quantity, unit=unit, role=role, source=_SOURCE)

    def largest() -> float:
        return float(np.abs(runs.all_differences()).max())

    def mean() -> float:
        return float(np.abs(runs.all_differences()).mean())

    def energy() -> float:
        return float(np.abs(runs.all_differences(energy_differences)).max())

    def stress(*, touching: bool) -> float:
        found = np.abs(runs.all_differences(partial(stress_differences, touching=touching)))
        if not len(found):
            raise InputError("curves", "ancf_wheel, fe", "have no such point", "compute them further, or closer")
        return float(found.max())

    limits = study.tolerances
    checks = [
        at_most(claim("load_largest", "load at any orientation"), largest, limits.ancf_wheel_largest),
        at_most(claim("load_mean", "load, mean over orientations and points"), mean, limits.ancf_wheel_mean),
        at_most(claim("energy_largest", "strain energy at any orientation"), energy, limits.ancf_wheel_largest),
        at_most(
            claim("spring_stress", "largest stress of springs before they touch rim or hub"),
            partial(stress, touching=False),
            limits.ancf_wheel_stress,
        ),
    ]
    if any(row.stress_touching is not None for row in runs.rows):
        after = claim("spring_stress_touching", "largest stress of springs that touch rim or hub", "finding")
        checks.append(at_most(after, partial(stress, touching=True), limits.ancf_wheel_stress))
    if runs.shapes is not None:
        shape = claim("shape", "deformed middle surfaces of rim and springs", unit="m")
        checks.append(at_most(shape, runs.shape_distance, limits.ancf_wheel_shape))
    if runs.touching:
        force = claim("rim_force", "force between springs and rim, over the load", "finding")
        checks.append(at_most(force, runs.rim_force_difference, limits.ancf_wheel_stress))
    return checks


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
