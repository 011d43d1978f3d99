"""A coarse wheel solved in a process of its own: ``python -m tests.verification.wheel_process OUT FILE [FACTOR]``.

OUT takes the curve, its columns and the fields at 20 N as a NumPy archive, FILE is the checkpoint; FACTOR scales
Young's modulus. May be run by mpiexec.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.dolfinx_api import COMM
from reference_fe.wheel.pressed import WheelLoadCase, solve_wheel

DEFLECTIONS = (0.003, 0.007, 0.011, 0.015)
"""The last one lies beyond the touch of springs and rim."""


def solve(checkpoint: Path, factor: float) -> dict[str, np.ndarray]:
    """Curve, columns and fields of a coarse half wheel at one orientation."""
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=True)
    case = WheelLoadCase(orientation_deg=15.0, deflections=DEFLECTIONS, snapshot_loads=(20.0,), keep_points=True)
    material = replace(TI_6AL_4V, young_modulus=factor * TI_6AL_4V.young_modulus)
    result = solve_wheel(mesh, dict.fromkeys(mesh.parts, material), case, checkpoint=checkpoint)
    (fields,) = result.snapshots
    table = {"deflection_m": result.curve.deflection, "load_N": result.curve.load, **result.curve.columns}
    points = np.array([one.displacement for one in result.points])
    assert fields.principal_stress is not None
    kept = {"displacement_m": fields.displacement, "von_mises_Pa": fields.von_mises, "points_m": points}
    return table | kept | {"principal_Pa": fields.principal_stress}


if __name__ == "__main__":
    found = solve(Path(sys.argv[2]), float(sys.argv[3]) if len(sys.argv) > 3 else 1.0)
    if COMM.rank == 0:
        np.savez(sys.argv[1], allow_pickle=False, **found)  # type: ignore[arg-type]
