"""Tasks of the ANCF tire: one orientation, and the plate element against exact reference matrices.

Verified by tests/unit/test_workbench_tasks.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plate_mass import flexible_mass, gravity_force, mass_matrix
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import build_plate_model
from ancf_reduced.static_tire import stiffness_curve
from ancf_reduced.tire_mesh import build_tire
from ancf_reduced.tire_preset import TirePreset
from ancf_reduced.tire_surfaces import outer_face_error
from contracts.curves import write_curve
from contracts.published import published_matrix
from workbench.result_files import write_result
from workbench.task import Progress

__all__ = ["plate_element_errors", "solve_orientation", "verify_plate"]


def solve_orientation(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Stiffness curve of the tire at one orientation: ``curve.csv`` and ``result.json``."""
    values: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in inputs["preset"].items()}
    preset = TirePreset(**values)
    curve = stiffness_curve(preset, math.radians(inputs["orientation_deg"]), inputs["deflections"])
    write_curve(curve, out / "curve.csv")
    tire = build_tire(preset)
    mass = flexible_mass(tire.model)
    write_result(out, {"flexible_mass_kg": mass, "outer_face_error_m": outer_face_error(tire)})
    progress(1.0)
    return int(tire.mesh.reference_coordinates()[tire.tie.free].size)


def verify_plate(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Mass, gravity and elastic force of one plate against the reference matrices: ``result.json``."""
    write_result(out, plate_element_errors())
    return 48


def plate_element_errors() -> dict[str, float]:
    """Largest difference over largest reference entry, for mass, gravity and elastic force of one plate [-].

    Plate 1 x 1 x 0.01 m, rho 7850, E 210e9, nu 0.3, 8 x 8 x 4 Gauss points; node 2 raised 1 mm for the elastic force.
    """
    patch = flat_patch(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), 0.01, "plate")
    model = build_plate_model(
        build_plate_mesh([patch]), young_modulus=210e9, poisson_ratio=0.3, density=7850.0, quadrature=(8, 8, 4)
    )
    raised = model.mesh.reference_coordinates()
    raised[1, 0, 2] += 1e-3
    found = {
        "mass": mass_matrix(model),
        "gravity": gravity_force(model, np.array([0.0, 0.0, -9.80665])).reshape(16, 3),
        "elastic_force": model.elastic_force(raised).reshape(16, 3),
    }
    return {name: _relative_error(values, name) for name, values in found.items()}


def _relative_error(values: NDArray[np.float64], name: str) -> float:
    reference = published_matrix(f"ancf_plate_{name}")
    return float(np.abs(values - reference).max() / np.abs(reference).max())
