"""Tasks of the wheel's meshes. Verified by tests/unit/test_workbench_graph.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contracts.input_file import require_ordinary_file
from geometry.own_mesh.files import LARGEST_FILE
from workbench.execution.fingerprint import file_sha256
from workbench.execution.task import Task
from workbench.questions.wheel.mesh_file import OWN_FILE
from workbench.study.model import Study
from workbench.study.model_parameters import rover_radius
from workbench.study.own_mesh import materials_by_part, own_mesh, sized_mesh
from workbench.study.wheel_design import part_materials

__all__ = [
    "MESH",
    "MESH_WHOLE",
    "coarse_across",
    "mesh_task",
    "own_mesh_task",
    "own_mesh_tasks",
    "wheel_inputs",
    "wheel_meshes",
]

MESH, MESH_WHOLE = "mesh", "mesh_whole"
"""Names of the tasks."""
_NAMED_WHERE_GIVEN = ("tread", "lattice")
"""Parts that tasks hear of only where the wheel has them: results of other wheels keep their keys."""
_THICKNESSES = ("thickness_middle", "thickness_hub")
"""Keys of springs of which the same is true."""


def wheel_meshes(study: Study) -> tuple[Task, Task]:
    """The mesh that is solved, and the whole wheel with every part for the picture and the mass.

    Of a mesh from another program both are that mesh, read twice.
    """
    if own_mesh(study) is not None:
        return own_mesh_task(study, MESH), own_mesh_task(study, MESH_WHOLE)
    whole = mesh_task(study, MESH_WHOLE, {"parts": "all", "half_width": False}, factor=1.0)
    return mesh_task(study, MESH), whole


def mesh_task(
    study: Study, name: str, changes: Mapping[str, Any] | None = None, *, factor: float | None = None
) -> Task:
    """A mesh of the study's wheel, with its own refinement factor and with other options changed.

    What it costs, and what is solved on it, is found by `workbench.questions.fe.foresight`.
    """
    if own_mesh(study) is not None and not changes:
        return own_mesh_task(study, name, factor)
    mesh = sized_mesh(study)
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


def own_mesh_task(study: Study, name: str = MESH, factor: float | None = None) -> Task:
    """The study's mesh from another program, read, checked, divided by its own or another factor.

    Its content decides the result, not its path. With [rover] it has to be the rover's wheel.

    Raises
    ------
    InputError
        For a file that cannot be read at all.
    """
    section = own_mesh(study)
    assert section is not None
    path = Path(section.file)
    require_ordinary_file(path, "mesh file", LARGEST_FILE)
    densities = {part: material.density for part, material in materials_by_part(study).items()}
    divided = section if factor is None else section.model_copy(update={"factor": round(factor)})
    left_out = {"file"} | ({"repeats"} if section.repeats == 1 else set())
    inputs = {
        "mesh": divided.model_dump(mode="json", exclude=left_out),
        "ending": path.suffix.lower(),
        "sha256": file_sha256(path),
        "densities": densities,
    } | ({} if study.rover is None else {"rover_radius": rover_radius()})
    function = "workbench.questions.wheel.own_mesh_task:read"
    return Task(name=name, function=function, inputs=inputs, files={OWN_FILE: path}, cost=5.0)


def own_mesh_tasks(study: Study, *, with_files: bool) -> tuple[Task, ...]:
    """The study's mesh from another program, and if asked for its files as this program writes them."""
    mesh = own_mesh_task(study)
    function = "workbench.questions.wheel.own_mesh_files:write_files"
    return (mesh, Task(name="mesh_files", function=function, inputs={}, needs=(MESH,))) if with_files else (mesh,)


def coarse_across(study: Study) -> dict[str, Any]:
    """Changes to a mesh for what does not depend on how strips curl: no edge elements, or twice as long ones."""
    mesh = sized_mesh(study)
    return {"edge_size": None, "axial_size": mesh.axial_size if mesh.edge_size else 2.0 * mesh.axial_size}


def wheel_inputs(study: Study) -> dict[str, Any]:
    """Numbers of the wheel's parts and of the materials they use, see `workbench.study.model_parameters.design_from`.

    The study's name, names of materials and their sources are words about the wheel that decide no result: the report
    takes them from the study, so that to change them computes nothing again.
    """
    left_out = {name for name in _NAMED_WHERE_GIVEN if getattr(study.parametric, name) is None}
    wheel = study.parametric.model_dump(mode="json", exclude=left_out)
    labels = {name: f"material {k}" for k, name in enumerate(dict.fromkeys(part_materials(study).values()), start=1)}
    for group in wheel.values():
        for part in group if isinstance(group, list) else [group] if group else []:
            part["material"] = labels[part["material"]]
            for key in _THICKNESSES:
                if part.get(key, 0.0) is None:
                    del part[key]
    words = {"source", "temperature_data"}
    materials = {label: study.materials[name].model_dump(mode="json", exclude=words) for name, label in labels.items()}
    return {"wheel": wheel, "materials": materials}
