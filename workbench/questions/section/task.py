"""Task of the planar section model: mesh and solve one orientation, which takes seconds.

Verified by tests/end_to_end/test_section.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.curves import write_curve
from contracts.mesh import TaggedMesh
from geometry.planar import build_planar_mesh
from reference_fe.wheel.section import solve_section
from workbench.execution.result_files import FAILURE, increment_rows, write_result
from workbench.questions.fe.task import converged_part, load_case
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["solve_orientation"]


def solve_orientation(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Solve one orientation: ``curve.csv`` and ``result.json`` (increments, timings, why the curve is partial)."""
    design = design_from(inputs["wheel"])
    mesh = _mesh(json.dumps([inputs["wheel"], inputs["options"]], sort_keys=True))

    def report(deflection: float, load: float) -> None:
        progress(max(deflection / inputs["deflections"][-1], load / inputs["max_load"]))

    result, failure = converged_part(lambda: solve_section(mesh, design, load_case(inputs), report))
    write_curve(result.curve, out / "curve.csv")
    numbers = {
        "dofs": result.dofs,
        "solve_s": result.wall_s,
        "cells": len(mesh.cells),
        "increments": increment_rows(result.increments),
        FAILURE: failure,
    }
    write_result(out, numbers)
    return result.dofs


@lru_cache(maxsize=1)
def _mesh(inputs: str) -> TaggedMesh:
    """The planar mesh of a wheel and its options, both as JSON: the next task is often the same wheel, turned."""
    wheel, options = json.loads(inputs)
    return build_planar_mesh(design_from(wheel), **options)
