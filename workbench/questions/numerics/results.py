"""How each run of the finite elements went. Verified by tests/unit/test_workbench_numerics.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from workbench.execution.result_files import early_ends
from workbench.questions.mesh_study.question import mesh_study_of
from workbench.questions.mesh_study.results import MeshRun
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.wheel.results import WheelMeshes, read_wheel
from workbench.study.model import Study

__all__ = ["Numerics", "SolverRow", "read_numerics"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverRow:
    """One orientation [deg] in the table of increments.

    Attributes
    ----------
    increments, cuts, iterations : converged, cut back; Newton iterations of all
    partial, missing : the run ended before its target; no point of it converged
    residual : largest relative residual at the end of a converged increment [-]; None without any
    imbalance, moment_imbalance : largest of any point, over the contact force, and over that times the radius [-]
    deflection, load : where the curve ends [m, N]
    dofs, solve_s : unknowns, wall time [s]
    """

    orientation: float
    increments: int
    cuts: int
    iterations: int
    partial: bool
    missing: bool
    residual: float | None
    imbalance: float
    moment_imbalance: float
    deflection: float
    load: float
    dofs: int
    solve_s: float


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
        return [self._row(orientation) for orientation in self.fe.by_orientation]

    def _row(self, orientation: float) -> SolverRow:
        curve, run = self.fe.by_orientation[orientation], self.fe.runs[orientation]
        return SolverRow(
            orientation=orientation,
            increments=len(run.converged),
            cuts=len(run.increments) - len(run.converged),
            iterations=run.iterations,
            partial=curve.partial,
            missing=curve.unloaded,
            residual=max((one.residuals[-1] for one in run.converged), default=None),
            imbalance=float(abs(curve.columns["force_imbalance"]).max()),
            moment_imbalance=float(abs(curve.columns["moment_imbalance"]).max()),
            deflection=float(curve.deflection[-1]),
            load=float(curve.load[-1]),
            dofs=run.dofs,
            solve_s=run.solve_s,
        )


def read_numerics(study: Study, folders: Mapping[str, Path]) -> Numerics:
    """Everything about the runs from the folders of their tasks."""
    mesh_study = mesh_study_of(study, folders)
    return Numerics(
        fe=model_curves("fe", folders),
        others=() if mesh_study is None else mesh_study.runs,
        meshes=read_wheel(study, folders),
        early_ends=early_ends(folders),
    )
