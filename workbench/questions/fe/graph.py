"""Tasks of the continuum model, which many questions share.

Verified by tests/unit/test_workbench_graph.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from contracts.footprint import FOOTPRINT
from contracts.material_laws import law_values
from contracts.materials import Material
from workbench.execution.task import Task
from workbench.study.laws import HUB_PARTS
from workbench.study.model import Study
from workbench.study.orientation import degrees, orientation_name
from workbench.study.own_mesh import materials_by_part, own_mesh
from workbench.study.own_mesh_section import OwnMeshSection

__all__ = [
    "INNER_STIFFNESS",
    "curve_deflections",
    "fe_curve_tasks",
    "fe_inputs",
    "fe_task",
    "footprint_tasks",
    "material_inputs",
    "without_end",
    "without_fields",
]


INNER_STIFFNESS = 1e11
"""Penalty stiffness between the wheel's own parts [N/m^3]."""


def material_inputs(materials: Mapping[str, Material]) -> dict[str, dict[str, Any]]:
    """Numbers of the material of each part, without its name and where they come from; ``law`` where it has one."""
    words = ("name", "source", "temperature_data", "law")
    return {
        part: {name: value for name, value in asdict(material).items() if name not in words} | _law(material)
        for part, material in materials.items()
    }


def _law(material: Material) -> dict[str, Any]:
    return {} if material.law is None else {"law": law_values(material.law)}


def fe_inputs(study: Study, orientation_deg: float, deflections: Iterable[float]) -> dict[str, Any]:
    """Inputs of ``workbench.questions.fe.task:solve_orientation`` as the study has them."""
    fe, mesh = study.fe, own_mesh(study)
    inputs = {
        "orientation_deg": orientation_deg,
        "deflections": list(deflections),
        "max_load": fe.max_load,
        "snapshot_loads": list(fe.snapshot_loads),
        "keep_points": fe.keep_points,
        "material_law": fe.material_law,
        "contact_stiffness": fe.contact_stiffness,
        "contact_method": fe.contact_method,
        "friction": fe.friction,
        "obstacle": fe.obstacle.model_dump(mode="json"),
        "camber_deg": degrees(fe.camber),
        "inner_contact": fe.inner_contact,
        "inner_contact_stiffness": INNER_STIFFNESS,
        "relative_tolerance": fe.relative_tolerance,
        "rigid_parts": list(HUB_PARTS) if fe.hub == "rigid" else [],
        "materials": material_inputs(materials_by_part(study)),
    } | ({"unload": True} if fe.unload else {})
    return inputs if mesh is None else inputs | _of_own_mesh(mesh)


def _of_own_mesh(mesh: OwnMeshSection) -> dict[str, Any]:
    """What of a mesh from another program is held, and what its groups of faces do."""
    held = [name for name in mesh.hub if name not in mesh.parts]
    faces = {"ground": list(mesh.ground), "held": held, "pairs": [list(pair) for pair in mesh.contact]}
    return {"rigid_parts": [name for name in mesh.hub if name in mesh.parts], "faces": faces}


def without_fields(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The same run, its curve alone, without the way back."""
    kept = {name: value for name, value in inputs.items() if name != "unload"}
    return kept | {"snapshot_loads": [], "keep_points": False}


def without_end(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The same run, its curve alone, which no load ends before its last deflection."""
    return without_fields(inputs) | {"max_load": 1e6}


def fe_task(name: str, inputs: Mapping[str, Any], mesh: str = "mesh") -> Task:
    """One orientation solved on the mesh of the task ``mesh``."""
    function = "workbench.questions.fe.task:solve_orientation"
    return Task(name=name, function=function, inputs=inputs, needs=(mesh,), resumable=True, shared=True)


def curve_deflections(study: Study) -> list[float]:
    """Deflections [m] of the points of every FE curve."""
    fe = study.fe
    grid = np.linspace(0.0, fe.max_deflection, fe.points + 1)[1:].round(12).tolist()
    more = [] if study.mesh_study is None else np.round(study.mesh_study.deflections, 12).tolist()
    return sorted({*grid, *more})


def fe_curve_tasks(study: Study, orientations_deg: Sequence[float] = ()) -> list[Task]:
    """A curve at each orientation [deg]; none means those of the study."""
    points = curve_deflections(study)
    wanted = orientations_deg or [degrees(o) for o in study.fe.orientations]
    return [fe_task(orientation_name("fe", o), fe_inputs(study, o, points)) for o in wanted]


def footprint_tasks(study: Study, curves: Sequence[Task], mesh: str = "mesh") -> list[Task]:
    """Footprints of curves at the study's snapshot loads; none where pressures do not follow from a gap to a plane."""
    fe = study.fe
    told = fe.snapshot_loads and fe.obstacle.shape == "plane" and fe.contact_method == "penalty"
    if not told or fe.contact_stiffness is None:
        return []
    function = "workbench.questions.fe.footprint_task:find"
    return [
        Task(
            name=curve.name.replace("fe", FOOTPRINT, 1),
            function=function,
            inputs={"mesh": mesh, "curve": curve.name, "case": dict(curve.inputs)},
            needs=(mesh, curve.name),
            cost=1.0,
        )
        for curve in curves
    ]
