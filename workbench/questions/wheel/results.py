"""What is known of the wheel's meshes. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from geometry.measures import MeshQuality
from geometry.summary import PartSummary
from workbench.execution.result_files import read_result
from workbench.questions.wheel.graph import MESH, MESH_WHOLE
from workbench.study.model import Study
from workbench.study.wheel_design import part_materials

__all__ = ["MeshNumbers", "WheelMeshes", "mesh_numbers", "read_wheel"]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshNumbers:
    """Numbers of one mesh, with the names that the study gives the parts' materials.

    Attributes
    ----------
    quality, parts : of the cells, and part by part, see `geometry.summary`
    volume, volume_closed_form : of all parts meshed, on the mesh and by the dimensions [m^3]
    mass, mass_closed_form : the same [kg]
    hash : of points and cells
    """

    quality: MeshQuality
    parts: Mapping[str, PartSummary]
    volume: float
    volume_closed_form: float
    mass: float
    mass_closed_form: float
    hash: str


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelMeshes:
    """Both meshes of a wheel: the one that is solved, and the whole wheel; where the latter and its picture lie."""

    solved: MeshNumbers
    whole: MeshNumbers
    whole_folder: Path
    picture: Path


def mesh_numbers(study: Study, folder: Path) -> MeshNumbers:
    """Numbers of the mesh whose task filled ``folder``."""
    found, materials = read_result(folder), part_materials(study)
    parts = {part: replace(PartSummary(**row), material=materials[part]) for part, row in found["parts"].items()}
    return MeshNumbers(
        quality=MeshQuality(**found["quality"]),
        parts=parts,
        volume=found["total_volume"],
        volume_closed_form=found["total_volume_closed_form"],
        mass=found["total_mass"],
        mass_closed_form=found["total_mass_closed_form"],
        hash=found["hash"],
    )


def read_wheel(study: Study, folders: Mapping[str, Path]) -> WheelMeshes:
    """Both meshes from the folders of their tasks."""
    return WheelMeshes(
        solved=mesh_numbers(study, folders[MESH]),
        whole=mesh_numbers(study, folders[MESH_WHOLE]),
        whole_folder=folders[MESH_WHOLE],
        picture=folders["pictures"] / "wheel.png",
    )
