"""Tasks of the mesh and of the continuum model, which the report's topics share.

Verified by tests/unit/test_workbench_graph.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from contracts.materials import Material
from workbench.execution.task import Task
from workbench.study.model import Study
from workbench.study.wheel_design import part_materials, wheel_design
from workbench.tasks.orientation import degrees

__all__ = [
    "HUB_PARTS",
    "INNER_STIFFNESS",
    "curve_deflections",
    "fe_inputs",
    "fe_task",
    "material_inputs",
    "mesh_task",
    "wheel_inputs",
    "without_fields",
]


HUB_PARTS = ["outer_hub", "cone", "impact_springs", "inner_hub"]
"""Parts within the springs' welds on the hub, outside to inside."""
INNER_STIFFNESS = 1e11
"""Penalty stiffness between the wheel's own parts [N/m^3]."""


def mesh_task(
    study: Study, name: str, changes: Mapping[str, Any] | None = None, *, factor: float | None = None
) -> Task:
    """A mesh of the study's wheel, with its own refinement factor and with other options changed.

    What it costs, and what is solved on it, is found by `workbench.graph.foresight`.
    """
    mesh = study.mesh
    options = {
        "element_size": mesh.element_size,
        "axial_size": mesh.axial_size,
        "thickness_elements": mesh.thickness_elements,
        "order": mesh.order,
        "half_width": mesh.half_width,
        "refinement": dict(mesh.refinement),
        "parts": "flexible" if study.fe.hub == "rigid" else "all",
        "factor": factor or mesh.factor,
    }
    inputs = {"wheel": wheel_inputs(study), "options": options | dict(changes or {})}
    return Task(name=name, function="workbench.tasks.mesh:build", inputs=inputs)


def wheel_inputs(study: Study) -> dict[str, Any]:
    """Numbers of the wheel's parts and of the materials they use, see `workbench.study.model_parameters.design_from`.

    The study's name, names of materials and their sources are words about the wheel that decide no result: the report
    takes them from the study, so that to change them computes nothing again.
    """
    wheel = study.wheel.model_dump(mode="json")
    labels = {name: f"material {k}" for k, name in enumerate(dict.fromkeys(part_materials(study).values()), start=1)}
    for group in wheel.values():
        for part in group if isinstance(group, list) else [group] if group else []:
            part["material"] = labels[part["material"]]
    words = {"source", "temperature_data"}
    materials = {label: study.materials[name].model_dump(mode="json", exclude=words) for name, label in labels.items()}
    return {"wheel": wheel, "materials": materials}


def material_inputs(materials: Mapping[str, Material]) -> dict[str, dict[str, float]]:
    """Numbers of the material of each part, without its name and where they come from."""
    words = ("name", "source", "temperature_data")
    return {
        part: {name: value for name, value in asdict(material).items() if name not in words}
        for part, material in materials.items()
    }


def fe_inputs(study: Study, orientation_deg: float, deflections: Iterable[float]) -> dict[str, Any]:
    """Inputs of ``workbench.tasks.fe:solve_orientation`` as the study has them."""
    fe = study.fe
    return {
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
        "rigid_parts": HUB_PARTS if fe.hub == "rigid" else [],
        "materials": material_inputs(wheel_design(study).materials),
    }


def without_fields(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The same run, its curve alone."""
    return {**inputs, "snapshot_loads": [], "keep_points": False}


def fe_task(name: str, inputs: Mapping[str, Any], mesh: str = "mesh") -> Task:
    """One orientation solved on the mesh of the task ``mesh``."""
    function = "workbench.tasks.fe:solve_orientation"
    long = {"resumable": True, "shared": True}
    return Task(name=name, function=function, inputs=inputs, needs=(mesh,), **long)


def curve_deflections(study: Study) -> list[float]:
    """Deflections [m] of the points of every FE curve."""
    fe = study.fe
    grid = np.linspace(0.0, fe.max_deflection, fe.points + 1)[1:].round(12).tolist()
    more = [] if study.mesh_study is None else np.round(study.mesh_study.deflections, 12).tolist()
    return sorted({*grid, *more})
