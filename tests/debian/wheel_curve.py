"""Stiffness curve of the default wheel on a coarse mesh, for comparing one build of DOLFINx with another.

Usage: python wheel_curve.py FILE
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe import dolfinx_api
from reference_fe.wheel.pressed import WheelLoadCase, solve_wheel


def main(path: Path) -> None:
    """Solve to 8 mm and write the curve with all digits."""
    mesh = build_mesh(exomars_hoops(), element_size=14e-3, axial_size=40e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=15.0, deflections=tuple(np.linspace(2e-3, 8e-3, 4)))
    curve = solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case).curve
    versions = ", ".join(f"{name} {version}" for name, version in dolfinx_api.versions().items())
    rows = [f"{d:.17g},{f:.17g}" for d, f in zip(curve.deflection, curve.load, strict=True)]
    path.write_text("\n".join([f"# source: {versions}", "deflection_m,load_N", *rows]) + "\n", encoding="utf-8")
    print(f"{versions}: {curve.load[-1]:.12g} N at {1e3 * curve.deflection[-1]:g} mm")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
