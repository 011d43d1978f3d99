"""Tasks of the wheel's meshes. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from workbench.execution.task import Task
from workbench.study.model import Study
from workbench.study.wheel_design import part_materials

__all__ = ["MESH", "MESH_WHOLE", "coarse_across", "mesh_task", "wheel_inputs", "wheel_meshes"]

MESH, MESH_WHOLE = "mesh", "mesh_whole"
"""Names of the tasks."""


def wheel_meshes(study: Study) -> tuple[Task, Task]:
    """The mesh that is solved, and the whole wheel with every part for the picture and the mass."""
    whole = mesh_task(study, MESH_WHOLE, {"parts": "all", "half_width": False}, factor=1.0)
    return mesh_task(study, MESH), whole


def mesh_task(
    study: Study, name: str, changes: Mapping[str, Any] | None = None, *, factor: float | None = None
) -> Task:
    """A mesh of the study's wheel, with its own refinement factor and with other options changed.

    What it costs, and what is solved on it, is found by `workbench.questions.fe.foresight`.
    """
    mesh = study.mesh
    options = {
        "element_size": mesh.element_size,
        "axial_size": mesh.axial_size,
        "edge_size": mesh.edge_size,
        "thickness_elements": mesh.thickness_elements,
        "order": mesh.order,
        "half_width": mesh.half_width,
        "refinement": dict(mesh.refinement),
        "parts": "flexible" if study.fe.hub == "rigid" else "all",
        "factor": factor or mesh.factor,
    }
    inputs = {"wheel": wheel_inputs(study), "options": options | dict(changes or {})}
    return Task(name=name, function="workbench.questions.wheel.mesh_task:build", inputs=inputs)


def coarse_across(study: Study) -> dict[str, Any]:
    """Changes to a mesh for what does not depend on how strips curl: no edge elements, or twice as long ones."""
    mesh = study.mesh
    return {"edge_size": None, "axial_size": mesh.axial_size if mesh.edge_size else 2.0 * mesh.axial_size}


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
