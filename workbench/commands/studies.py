"""``workbench new`` and ``workbench check``: a study file to begin with, and whether one can be used.

Verified by tests/end_to_end/test_studies_commands.py.
"""

from __future__ import annotations

import contextlib
import os
import uuid
from pathlib import Path

import numpy as np
import tomlkit

from contracts.errors import InputError
from contracts.input_file import input_text
from contracts.memory import shown_size
from contracts.mesh import TaggedMesh
from geometry.own_mesh.repeats import least_reach
from geometry.own_mesh.roles import Roles
from geometry.own_mesh.step_body import StepBody, told
from geometry.own_mesh.wheel_checks import outer_radius, parts_of_faces
from workbench.commands.computing import console, naming, read_and_warn, warn
from workbench.commands.optimise import require_optimise
from workbench.execution.disk import STUDY, naming_the_disk
from workbench.questions.fe.foresight import own_bytes
from workbench.questions.input_uncertainty.samples import require_inputs
from workbench.questions.section.graph import without_planar_model
from workbench.questions.study_graph import report_tasks
from workbench.questions.sweep.graph import sweep_graph
from workbench.questions.wheel.own_mesh_task import faces_told, own_content, require_rover_wheel, wheel_in
from workbench.report.placing import moved
from workbench.study.full import full_study, steps_around
from workbench.study.model_parameters import rover_radius
from workbench.study.own_mesh import own_mesh, placement_and_roles
from workbench.study.own_mesh_section import OwnMeshSection
from workbench.study.reading import built_in_study, read_study_table, study_of
from workbench.study.rewrite import rewritten_study
from workbench.study.sweep_points import beyond_reach, end_points

__all__ = ["run_check", "run_new"]

_USUAL_RADIUS = 50e-3, 500e-3
"""Of a rover's wheel [m]: outside it the unit is asked about."""


def run_new(path: Path, like: str) -> int:
    """Write a copy of a shipped study, comments and all, named after the new file, which must not exist yet; without
    the words of the thesis, which speak of one wheel."""
    shipped = {one.stem: one for one in sorted(built_in_study().parent.glob("*.toml"))}
    if like not in shipped:
        raise InputError("--from", repr(like), "is no study to begin with", f"choose one of {', '.join(shipped)}")
    source = shipped[like]
    text = rewritten_study(input_text(source, "study file"), {}, f"begun as a copy of {source.name}", source.parent)
    document = tomlkit.parse(text)
    document["name"] = path.stem
    _without_the_thesis(document)
    study_of(path, document.unwrap())  # the file's name may be none that a study may have
    with naming_the_disk(STUDY, path):
        _write_new(path, tomlkit.dumps(document))
    console.print(f"study: {path}; next: workbench check {path}", soft_wrap=True)
    return 0


def _without_the_thesis(document: tomlkit.TOMLDocument) -> None:
    """Another wheel is not the one the thesis speaks of: nobody is judged by its words without saying so."""
    if document.get("reference", {}).pop("thesis_words", None) is not None:
        if not document["reference"]:
            document.pop("reference")
        document.get("inferred", {}).pop("reference.thesis_words", None)


def _write_new(path: Path, text: str) -> None:
    """Write a file beside its place, then give it its name: whole, or not there; never over another."""
    aside = path.with_name(f".workbench-new-{uuid.uuid4().hex}")
    try:
        with aside.open("x", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())  # some disks say only here that they are full
        if not moved(aside, path):
            raise InputError("study file", path, "is there already", "give another name")
    except OSError as error:  # on a full disk it names no file
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        with contextlib.suppress(OSError):
            aside.unlink()


def _tell_own(path: Path, section: OwnMeshSection, *, of_rover: bool) -> None:
    """Read a wheel's own mesh; of solids, list what a user may name, before any name is looked for."""
    file, table = Path(section.file), section.model_dump(mode="json")
    content = own_content(file, table)
    if isinstance(content, StepBody):
        for line in told(content, placement_and_roles(table)[0]):
            console.print(f"{file.name}: {line}", soft_wrap=True)
        for line in faces_told(content, table, file):
            console.print(f"{path}: {line}", soft_wrap=True)
    mesh = wheel_in(content, table, file)
    unknowns, memory = own_bytes(
        mesh, tetrahedra=isinstance(content, StepBody) or "tetrahedra" in content.blocks[0].kind
    )
    console.print(
        f"{path}: {len(mesh.cells)} cells, {unknowns} unknowns, about {shown_size(memory)} to solve", soft_wrap=True
    )
    _tell_size(path, mesh, section)
    if of_rover:
        require_rover_wheel(outer_radius(mesh, section.ground), least_reach(mesh, section.ground), rover_radius())
    warn(path, _odd_holds(mesh, placement_and_roles(table)[1]))


def _odd_holds(mesh: TaggedMesh, roles: Roles) -> list[str]:
    """Held faces that lie where few would hold a wheel of several parts."""
    found = []
    on_ground = parts_of_faces(mesh, roles.ground)
    for name in roles.held_faces:
        parts = parts_of_faces(mesh, [name])
        if len(parts) > 1:
            found.append(f"mesh.hub: held faces {name} lie on {', '.join(parts)}: is more than one part meant?")
        if len(mesh.parts) > 1 and (both := [part for part in parts if part in on_ground]):
            found.append(f"mesh.hub: held faces {name} lie on {', '.join(both)}, which has ground faces, too")
    return found


def _tell_size(path: Path, mesh: TaggedMesh, section: OwnMeshSection) -> None:
    """Size of a wheel whose mesh is its own, which shows a wrong unit."""
    radius, width = outer_radius(mesh, section.ground), float(np.ptp(mesh.points[:, 1]))
    width *= 2.0 if section.half_width else 1.0
    console.print(f"{path}: radius {1e3 * radius:.4g} mm, width {1e3 * width:.4g} mm")
    low, high = _USUAL_RADIUS
    if not low <= radius <= high:
        usual = f"a rover's wheel has {1e3 * low:g} to {1e3 * high:g} mm"
        key = "mesh.file" if section.of_solids else "mesh.units"
        warn(path, [f"{key}: a radius of {1e3 * radius:.4g} mm is unusual ({usual}): is the unit right?"])


def run_check(path: Path) -> int:
    """Read a study as every command does, with its own mesh, plan its reports, its sweep, its samples; what is unusual
    goes to stderr."""
    study = read_and_warn(path)
    points = end_points(path, read_study_table(path)) if study.sweep is not None else []
    warn(path, beyond_reach(study, points))
    with naming(path):
        if (mesh := own_mesh(study)) is not None:
            _tell_own(path, mesh, of_rover=study.rover is not None)
        tasks = report_tasks(study)
        if "full" in study.model_fields_set:
            _ = full_study(study) if mesh is None else steps_around(study)
        if study.sweep is not None:
            sweep_graph(points, study.sweep.models, study.sweep.moved)
        if study.optimise is not None:
            batches, section = require_optimise(path, read_study_table(path), study)
            warn(path, batches.unusable_ends(section.as_sweep))
        if study.input_uncertainty is not None and without_planar_model(study) is None:
            require_inputs(path, read_study_table(path), study.input_uncertainty)
    console.print(f"{path}: {study.title}: can be used; its report takes {len(tasks)} tasks", soft_wrap=True)
    return 0
