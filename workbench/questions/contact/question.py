"""Question: how far the load depends on the contact penalty. Verified by tests/unit/test_workbench_contact.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.fe.graph import INNER_STIFFNESS, fe_inputs, fe_task, without_end
from workbench.questions.model_curves import CURVE
from workbench.questions.question import Question
from workbench.questions.wheel.graph import coarse_across, mesh_task
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees
from workbench.verdict.rules import Claim, at_most

__all__ = ["AUGMENTED", "CONTACT", "ContactRun", "PenaltyStudy", "largest_change", "penalty_check"]

AUGMENTED = "augmented_lagrangian"
_LIMIT = 0.005


def largest_change(loads: Mapping[str, float]) -> float:
    """Largest |F / F_al - 1| of the study's penalty and ten times it, F_al with the augmented Lagrangian [-]."""
    return max(abs(loads[name] / loads[AUGMENTED] - 1.0) for name in ("1", "10"))


def penalty_check(loads: Callable[[], Mapping[str, float]], where: str) -> Check:
    """``loads`` gives loads [N] by factor on the penalty (``"0.1"``, ``"1"``, ``"10"``) and by `AUGMENTED`."""
    claim = Claim(
        id="fe.penalty_study",
        title=f"FE: load with the penalty, once and ten times, against the augmented Lagrangian, {where}",
        quantity="change of load",
        unit="-",
        role="gate",
        source="augmented Lagrangian, Simo & Laursen 1992, Comput. Struct. 42, 97-116; the limit is ours",
    )
    return at_most(claim, lambda: largest_change(loads()), _LIMIT)


_FACTORS = ("0.1", "1", "10")


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactRun:
    """One way to keep the wheel out of the ground: factor on the study's penalty, or the augmented Lagrangian."""

    name: str
    stiffness: float
    curve: StiffnessCurve

    @property
    def load(self) -> float:
        """Load at the last point [N]; InputError if no point converged."""
        self._need_a_point()
        return float(self.curve.load[-1])

    def largest(self, column: str) -> float:
        """Largest value of a column along the curve; InputError if no point of it converged."""
        self._need_a_point()
        return float(self.curve.columns[column].max())

    @property
    def iterations(self) -> int:
        """Newton iterations of the whole curve."""
        return int(self.curve.columns["newton_iterations"].sum())

    def _need_a_point(self) -> None:
        if self.curve.unloaded:
            raise InputError(f"run {self.name}", "no point", "converged", "see its message")


@dataclass(frozen=True, slots=True, kw_only=True)
class PenaltyStudy:
    """Runs on one mesh at one orientation [deg] to one deflection [m]."""

    orientation_deg: float
    deflection: float
    runs: tuple[ContactRun, ...]

    def loads(self) -> dict[str, float]:
        """Load [N] of each run; InputError unless all reached the deflection."""
        for run in self.runs:
            if run.curve.deflection[-1] < self.deflection - 1e-12:
                raise InputError(f"run {run.name}", "partial", "must reach the deflection", "choose a smaller one")
        return {run.name: run.load for run in self.runs}

    def change(self, run: ContactRun) -> float:
        """Load over that with the augmented Lagrangian, minus 1 [-]; InputError if one of them has no point."""
        return run.load / self.runs[-1].load - 1.0


def _task_name(run: str) -> str:
    return f"fe_penalty_{run}"


def _tasks(study: Study) -> Sequence[Task]:
    section, stiffness = stated(study.penalty_study, "penalty_study"), study.fe.contact_stiffness
    assert stiffness is not None
    mesh = mesh_task(study, "mesh_penalty", coarse_across(study))
    end = round(section.deflection, 12)
    inputs = without_end(fe_inputs(study, degrees(section.orientation), (0.5 * end, end)))
    changes: dict[str, dict[str, Any]] = {f: _scaled(float(f), stiffness) for f in _FACTORS}
    changes[AUGMENTED] = {"contact_stiffness": stiffness, "contact_method": AUGMENTED}
    return [mesh, *(fe_task(_task_name(name), inputs | change, mesh.name) for name, change in changes.items())]


def _scaled(factor: float, stiffness: float) -> dict[str, Any]:
    """Both penalties of a run, on the ground and between the wheel's own parts."""
    inner = factor * INNER_STIFFNESS
    return {"contact_stiffness": factor * stiffness, "inner_contact_stiffness": inner, "contact_method": "penalty"}


def _read(study: Study, folders: Mapping[str, Path]) -> PenaltyStudy:
    section, stiffness = stated(study.penalty_study, "penalty_study"), study.fe.contact_stiffness
    assert stiffness is not None
    orientation, runs = degrees(section.orientation), []
    for name in (*_FACTORS, AUGMENTED):
        curve = read_curve(folders[_task_name(name)] / CURVE, model="fe", orientation_deg=orientation)
        factor = 1.0 if name == AUGMENTED else float(name)
        runs.append(ContactRun(name=name, stiffness=factor * stiffness, curve=curve))
    return PenaltyStudy(orientation_deg=orientation, deflection=section.deflection, runs=tuple(runs))


def _checks(study: Study, results: PenaltyStudy) -> Sequence[Check]:
    where = f"{results.deflection * 1e3:g} mm, {results.orientation_deg:g} deg"
    return [penalty_check(results.loads, where)]


def _curves(study: Study, results: PenaltyStudy) -> list[StiffnessCurve]:
    return [replace(run.curve, model=_task_name(run.name)) for run in results.runs]


CONTACT = Question(
    name="contact",
    title="Contact",
    group="Wheel",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    curves=_curves,
    applies=lambda study: study.penalty_study is not None and study.fe.contact_stiffness is not None,
)
