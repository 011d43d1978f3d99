"""A coarse wheel solved in a process of its own, to be killed: ``python -m tests.verification.wheel_process OUT FILE``.

OUT takes the curve as a NumPy array, FILE is the checkpoint.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from contracts.materials import TI_6AL_4V
from geometry import WheelDesign, build_mesh
from reference_fe.dolfinx_api import COMM
from reference_fe.wheel import WheelLoadCase, WheelResult, solve_wheel

DEFLECTIONS = (0.002, 0.004, 0.006, 0.008)


def table(result: WheelResult) -> np.ndarray:
    """Deflection, load and every column of the curve, then the fields kept at 20 N."""
    curve = result.curve
    fields = [array.ravel() for s in result.snapshots for array in (s.displacement, s.von_mises)]
    return np.concatenate([curve.deflection, curve.load, *curve.columns.values(), *fields])


def solve(checkpoint: Path | None) -> WheelResult:
    """The wheel of the test: coarse, half width, one orientation."""
    mesh = build_mesh(WheelDesign(), element_size=14e-3, axial_size=40e-3, parts="flexible", half_width=True)
    case = WheelLoadCase(orientation_deg=15.0, deflections=DEFLECTIONS, snapshot_loads=(20.0,))
    return solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case, checkpoint=checkpoint)


if __name__ == "__main__":
    result = solve(Path(sys.argv[2]))
    if COMM.rank == 0:
        np.save(sys.argv[1], table(result))
