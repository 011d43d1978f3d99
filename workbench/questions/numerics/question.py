"""Question: did every run of the finite elements come to its end in equilibrium, and on what mesh?

Verified by tests/unit/test_workbench_checks.py, tests/unit/test_workbench_numerics.py and
tests/end_to_end/test_partial_curve.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.execution.result_files import early_ends
from workbench.questions.mesh_study.question import mesh_study_of
from workbench.questions.mesh_study.results import MeshRun
from workbench.questions.model_curves import ModelCurves, RunNumbers, model_curves
from workbench.questions.numerics.energy import energy_check
from workbench.questions.question import Question
from workbench.questions.wheel.question import WheelMeshes, read_wheel
from workbench.study.full import around
from workbench.study.model import Study
from workbench.verdict.rules import Claim, stated
from workbench.verdict.status import COMPLETE

__all__ = [
    "NUMERICS",
    "Numerics",
    "SolverRow",
    "completeness_check",
    "read_numerics",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverRow:
    """One orientation [deg] in the table of increments: its curve, and the run that gave it."""

    orientation: float
    curve: StiffnessCurve
    run: RunNumbers

    @property
    def cuts(self) -> int:
        """Increments that were cut back."""
        return len(self.run.increments) - len(self.run.converged)

    @property
    def residual(self) -> float | None:
        """Largest relative residual at the end of a converged increment [-]; None without any."""
        return max((one.residuals[-1] for one in self.run.converged), default=None)

    def largest(self, column: str) -> float:
        """Largest absolute value of a column of the curve."""
        return float(abs(self.curve.columns[column]).max())


@dataclass(frozen=True, slots=True, kw_only=True)
class Numerics:
    """Runs of every orientation and of the mesh study, the meshes, and task -> why its run ended early."""

    fe: ModelCurves
    others: tuple[MeshRun, ...]
    meshes: WheelMeshes
    early_ends: Mapping[str, str]

    @property
    def rows(self) -> list[SolverRow]:
        """In the order of the orientations."""
        curves = self.fe.by_orientation.items()
        return [SolverRow(orientation=o, curve=curve, run=self.fe.runs[o]) for o, curve in curves]


def read_numerics(study: Study, folders: Mapping[str, Path]) -> Numerics:
    """Everything about the runs from the folders of their tasks."""
    mesh_study = mesh_study_of(study, folders)
    return Numerics(
        fe=model_curves("fe", folders, around(study)),
        others=() if mesh_study is None else mesh_study.runs,
        meshes=read_wheel(study, folders),
        early_ends=early_ends(folders),
    )


def completeness_check(early_ends: Mapping[str, str]) -> Check:
    """A gate: no finite element run ended before its target. ``early_ends``: task name -> reason."""
    named = f": {', '.join(early_ends)}; what rests on them is partial" if early_ends else ""
    claim = Claim(
        id=COMPLETE,
        title=f"FE: runs that did not converge to their end{named}",
        quantity="runs",
        unit="-",
        role="gate",
        source="no publication: guards every other number against resting on a curve that ended early",
    )
    return stated(claim, float(len(early_ends)), 0.0, "none", "error" if early_ends else "pass")


def _checks(study: Study, results: Numerics) -> Sequence[Check]:
    tolerances, curves = study.tolerances, list(results.fe.by_orientation.values())
    return [
        completeness_check(results.early_ends),
        energy_check(curves, tolerances.fe_energy),
    ]


NUMERICS = Question(name="numerics", title="Mesh and solver", group="Solvers", read=read_numerics, checks=_checks)
