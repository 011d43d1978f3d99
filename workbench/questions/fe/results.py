"""The continuum's curves with what belongs to them. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from contracts.curves import StiffnessCurve, read_curve
from contracts.footprint import FOOTPRINT, Footprint, read_footprint
from workbench.execution.result_files import read_result
from workbench.questions.fe.unloading import Unloading, unloadings
from workbench.questions.mesh_study.question import mesh_study_of
from workbench.questions.mesh_study.results import MeshStudy
from workbench.questions.model_curves import ModelCurves, UserCurve, model_curves
from workbench.questions.wheel.graph import MESH
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.orientation import degrees, orientation_name
from workbench.study.reference_file import stated_uncertainty

__all__ = ["OVERLAP", "ContinuumCurves", "PartsDepth", "read_continuum", "user_curves"]


OVERLAP = "parts_overlap"
"""Task that measures how deep parts lie in one another."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PartsDepth:
    """Load of a curve's last point [N], the deepest overlap of two parts there [m], and their names."""

    load: float
    depth: float
    parts: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ContinuumCurves:
    """Curves of the continuum model.

    Attributes
    ----------
    fe : at each orientation, and their average
    mesh_study : three meshes, and the numerical uncertainty they give every curve; None where the study has none
    users : the curves of the study's reference
    mesh_folder, solved : where the mesh lies, and the fields of each orientation [deg]
    picture : still of the deformed wheel; None if no orientation came to its load
    unloadings : ways back by orientation [deg]; empty where the study does not unload
    footprints : at the first snapshot load, by orientation [deg]; empty where there are none
    overlaps : deepest overlap of any two parts at each curve's last point; None where its fields are not kept
    """

    fe: ModelCurves
    mesh_study: MeshStudy | None
    users: tuple[UserCurve, ...]
    mesh_folder: Path
    solved: Mapping[float, Path]
    picture: Path | None
    unloadings: Mapping[float, Unloading]
    footprints: Mapping[float, Footprint]
    overlaps: Mapping[str, PartsDepth] | None = None

    @property
    def curves(self) -> list[StiffnessCurve]:
        """All, with their numerical uncertainty where it is known."""
        found = [*self.fe.by_orientation.values(), self.fe.average]
        return found if self.mesh_study is None else [self.mesh_study.stated(curve) for curve in found]


def read_continuum(study: Study, folders: Mapping[str, Path]) -> ContinuumCurves:
    """The curves from the folders of their tasks."""
    fe = model_curves("fe", folders, around(study))
    return ContinuumCurves(
        fe=fe,
        mesh_study=mesh_study_of(study, folders),
        users=user_curves(study, folders["metrics"]),
        mesh_folder=folders[MESH],
        solved={o: folders[orientation_name("fe", o)] for o in fe.by_orientation},
        picture=next(iter(sorted(folders["pictures"].glob("deformed_*N.png"))), None),
        unloadings=unloadings(fe.by_orientation, folders),
        footprints=_footprints(study, folders, fe.by_orientation),
        overlaps=_overlaps(folders[OVERLAP]) if OVERLAP in folders else None,
    )


def _footprints(study: Study, folders: Mapping[str, Path], orientations: Iterable[float]) -> dict[float, Footprint]:
    tasks = {o: name for o in orientations if (name := orientation_name(FOOTPRINT, o)) in folders}
    files = {o: folders[name] / f"{FOOTPRINT}_{study.fe.snapshot_loads[0]:.0f}N.csv" for o, name in tasks.items()}
    return {o: read_footprint(path) for o, path in files.items() if path.is_file()}


def _overlaps(folder: Path) -> dict[str, PartsDepth]:
    found = read_result(folder)
    return {
        name: PartsDepth(load=row["load_N"], depth=row["depth"], parts=tuple(row["parts"]))
        for name, row in found.items()
    }


def user_curves(study: Study, folder: Path) -> tuple[UserCurve, ...]:
    """The curves of the study's reference, in SI as the task ``metrics`` wrote them into ``folder``."""
    return tuple(
        UserCurve(
            label=section.label,
            curve=replace(read_curve(folder / f"user_{i}.csv", model=section.label), source=section.source),
            orientation_deg=None if section.orientation is None else degrees(section.orientation),
            kind=section.kind,
            uncertainty=stated_uncertainty(section),
        )
        for i, section in enumerate(study.reference_curves)
    )
