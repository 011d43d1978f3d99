"""Tasks of the continuum model: the wheel at one orientation.

Verified by tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.curves import write_curve
from contracts.errors import ConvergenceError
from contracts.material_laws import law_from
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from reference_fe.contact.obstacle import ContactMethod
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.solver.newton import NewtonSettings
from reference_fe.wheel.case import NamedFaces
from reference_fe.wheel.pressed import FieldSnapshot, WheelLoadCase, WheelResult, solve_wheel
from workbench.execution.result_files import FAILURE, increment_rows, write_result
from workbench.questions.fe.field_file import POINTS_FILE, write_fields, write_points
from workbench.questions.fe.ground import obstacle_of
from workbench.questions.fe.unloading import UNLOADING
from workbench.questions.wheel.mesh_file import MESH, read_mesh

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["converged_part", "load_case", "materials_of", "solve_orientation"]

_STUDY = "the study"
"""Where the numbers of every material come from, for all that a task knows."""


def solve_orientation(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """Solve one orientation: ``curve.csv``, ``result.json`` (increments, timings), fields at chosen loads and points;
    with ``unload`` also ``unloading.csv``, the way back.

    A solve that does not converge leaves its partial curve, first touch at the least, and the reason in the result.
    Needs one task that holds the mesh. Goes on behind the last increment in ``checkpoint``, if there is one.
    """
    (mesh_folder,) = needs.values()
    mesh = read_mesh(mesh_folder / MESH)
    case = load_case(inputs)
    materials = materials_of(inputs)
    top = 0.0

    def report(deflection: float, load: float) -> None:
        nonlocal top
        there = max(deflection / case.deflections[-1], load / inputs["max_load"])
        done = there if deflection > top else 2.0 - deflection / top
        top = max(top, deflection)
        progress(0.5 * done if case.unload else done)

    result, failure = converged_part(lambda: solve_wheel(mesh, materials, case, report, checkpoint))
    write_curve(result.curve, out / "curve.csv")
    if result.unloading is not None:
        write_curve(result.unloading, out / UNLOADING)
    for snapshot in result.snapshots:
        _, wanted = min((abs(load - snapshot.load), load) for load in inputs["snapshot_loads"])
        _write_fields(mesh, snapshot, out / f"fields_{wanted:.0f}N")
    if result.points:
        write_points(result.points, out / POINTS_FILE)
    numbers = {
        "dofs": result.dofs,
        "solve_s": result.wall_s,
        "cells": len(mesh.cells),
        "increments": increment_rows(result.increments),
        FAILURE: failure,
        "snapshots": [{"load_N": s.load, "deflection_m": s.deflection} for s in result.snapshots],
    }
    write_result(out, numbers)
    return result.dofs


def converged_part(solve: Callable[[], WheelResult]) -> tuple[WheelResult, str | None]:
    """The result, or what there is of it with the reason why it ends early; raises what failed before first touch."""
    try:
        return solve(), None
    except ConvergenceError as error:
        if not isinstance(error.last_good, WheelResult):
            raise
        return error.last_good, str(error)


def materials_of(inputs: Mapping[str, Any]) -> dict[str, Material]:
    """The material of each part from a task's inputs."""
    found = {}
    for part, values in inputs["materials"].items():
        law = {"law": law_from(values["law"])} if "law" in values else {}
        found[part] = Material(name=part, source=_STUDY, **values | law)
    return found


def load_case(inputs: Mapping[str, Any]) -> WheelLoadCase:
    """The load case from a task's inputs."""
    return WheelLoadCase(
        orientation_deg=inputs["orientation_deg"],
        deflections=tuple(inputs["deflections"]),
        maximum_load=inputs["max_load"],
        snapshot_loads=tuple(inputs["snapshot_loads"]),
        keep_points=inputs["keep_points"],
        rigid_parts=tuple(inputs["rigid_parts"]),
        law=MaterialLaw(inputs["material_law"]),
        contact_stiffness=inputs["contact_stiffness"],
        obstacle=obstacle_of(inputs["obstacle"]),
        camber_deg=inputs["camber_deg"],
        contact_method=ContactMethod(inputs["contact_method"]),
        soil=tuple(inputs["soil"]) if "soil" in inputs else None,
        friction=inputs["friction"],
        unload=inputs.get("unload", False),
        inner_contact=inputs["inner_contact"],
        inner_contact_stiffness=inputs["inner_contact_stiffness"],
        newton=NewtonSettings(relative_tolerance=inputs["relative_tolerance"]),
        faces=_named_faces(inputs.get("faces")),
    )


def _named_faces(faces: Mapping[str, Any] | None) -> NamedFaces | None:
    """What the face groups of a wheel's own mesh do; None for a mesh of ours."""
    if faces is None:
        return None
    pairs = tuple((slave, master) for slave, master in faces["pairs"])
    return NamedFaces(ground=tuple(faces["ground"]), held=tuple(faces["held"]), pairs=pairs)


def _write_fields(mesh: TaggedMesh, snapshot: FieldSnapshot, stem: Path) -> None:
    """Fields at one load: an archive for our own pictures and a VTU for other programs."""
    archive, vtu = stem.with_suffix(".npz"), stem.with_suffix(".vtu")
    np.savez_compressed(archive, displacement=snapshot.displacement, von_mises=snapshot.von_mises)
    write_fields(mesh, snapshot.displacement, snapshot.von_mises, vtu, snapshot.principal_stress)
