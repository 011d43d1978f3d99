"""Question: does the mesh have the volume and the mass of the wheel that was designed?

Verified by tests/unit/test_workbench_checks.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contracts.records import Check
from geometry.measures import MeshQuality
from geometry.summary import PartSummary
from workbench.execution.result_files import read_result
from workbench.questions.question import Question
from workbench.questions.wheel.graph import MESH, MESH_WHOLE, wheel_meshes
from workbench.study.model import Study
from workbench.study.own_mesh import material_names, own_mesh
from workbench.study.sections import ToleranceSection
from workbench.study.thesis import WHEEL_MASS
from workbench.verdict.rules import Claim, at_least, near

__all__ = ["WHEEL", "MeshNumbers", "WheelMeshes", "mesh_checks", "mesh_numbers", "read_wheel"]

_RIGID = ("outer_hub", "cone", "impact_springs", "inner_hub")


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshNumbers:
    """Numbers of one mesh, with the names that the study gives the parts' materials.

    Attributes
    ----------
    quality, parts : of the cells, and part by part, see `geometry.summary`
    volume, volume_closed_form : of all parts meshed, on the mesh and by the dimensions [m^3]; NaN, also of parts and
        masses, for a mesh from another program, which has none
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

    @property
    def flexible_mass(self) -> float:
        """Mass of rim, grousers and springs [kg]."""
        return sum(n.mass for part, n in self.whole.parts.items() if part not in _RIGID)

    @property
    def missing_mass(self) -> float:
        """What the wheel of the thesis' Table I weighs beyond all parts meshed [kg]."""
        return WHEEL_MASS - self.whole.mass


def mesh_numbers(study: Study, folder: Path) -> MeshNumbers:
    """Numbers of the mesh whose task filled ``folder``."""
    found, materials = read_result(folder), material_names(study)
    if own_mesh(study) is not None:
        return _own_numbers(found, materials)
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


def _own_numbers(found: Mapping[str, Any], materials: Mapping[str, str]) -> MeshNumbers:
    """Numbers of a mesh from another program; half a wheel counts twice."""
    sides = 2.0 if found["half_width"] else 1.0
    nowhere = {"volume_closed_form": math.nan, "mass_closed_form": math.nan}
    parts = {
        part: PartSummary(
            cells=row["cells"],
            material=materials[part],
            volume=sides * row["volume"],
            mass=sides * row["mass"],
            **nowhere,
        )
        for part, row in found["parts"].items()
    }
    return MeshNumbers(
        quality=MeshQuality(**found["quality"]),
        parts=parts,
        volume=sides * found["total_volume"],
        mass=sides * found["total_mass"],
        hash=found["hash"],
        **nowhere,
    )


def read_wheel(study: Study, folders: Mapping[str, Path]) -> WheelMeshes:
    """Both meshes from the folders of their tasks."""
    return WheelMeshes(
        solved=mesh_numbers(study, folders[MESH]),
        whole=mesh_numbers(study, folders[MESH_WHOLE]),
        whole_folder=folders[MESH_WHOLE],
        picture=folders["pictures"] / "wheel.png",
    )


def mesh_checks(mesh: MeshNumbers, whole: MeshNumbers, tolerances: ToleranceSection) -> list[Check]:
    """Volume and mass of the whole wheel against closed form, where it has one; the worst cell of both meshes."""
    form, whole_wheel = "closed form of the design", "Mesh of the whole wheel"
    volume = Claim(
        id="mesh.volume", title=f"{whole_wheel}: volume", quantity="volume", unit="m^3", role="gate", source=form
    )
    mass = Claim(id="mesh.mass", title=f"{whole_wheel}: mass", quantity="mass", unit="kg", role="gate", source=form)
    shape = Claim(
        id="mesh.min_scaled_jacobian",
        title="Smallest scaled Jacobian of any cell",
        quantity="scaled Jacobian",
        unit="-",
        role="gate",
        source="scaled Jacobian of the cell, Stimpson et al. 2007, SAND2007-1751; the limit is ours",
    )
    worst = min(m.quality.min_scaled_jacobian for m in (mesh, whole))
    cells = at_least(shape, lambda: worst, tolerances.min_scaled_jacobian)
    if math.isnan(whole.volume_closed_form):
        return [cells]
    return [
        near(volume, lambda: whole.volume, whole.volume_closed_form, tolerances.mesh_mass),
        near(mass, lambda: whole.mass, whole.mass_closed_form, tolerances.mesh_mass),
        cells,
    ]


def _checks(study: Study, results: WheelMeshes) -> Sequence[Check]:
    return mesh_checks(results.solved, results.whole, study.tolerances)


def _figures(study: Study, results: WheelMeshes) -> Mapping[str, str]:
    from workbench.charts.packing import picture_link
    from workbench.questions.wheel.scene import parts_scene

    return {"parts_scene": parts_scene(results.whole_folder, picture_link(results.picture))}


WHEEL = Question(
    name="wheel",
    title="Wheel",
    group="Wheel",
    tasks=wheel_meshes,
    read=read_wheel,
    checks=_checks,
    figures=_figures,
    budget=760,
)
