"""Claim: walls of a cell hold each other off where the wheel is pressed until they meet; without contact they cross.

Source: what contact is: the two joints above the ground that meet first keep their order. Tolerance: less than a wall's
thickness into each other (measured: 0.18 of 0.8 mm, on one edge, under 7 kN). Negative control: the same run without
contact, whose joints pass through each other and whose load stays below a third (measured: a quarter).
"""

from __future__ import annotations

import numpy as np

from geometry.planar import build_planar_mesh
from reference_fe.wheel.case import WheelLoadCase, WheelResult
from reference_fe.wheel.section import solve_section
from workbench.study.reading import built_in_study, read_study
from workbench.study.wheel_design import wheel_design

DEFLECTIONS = (0.004, 0.0094, 0.0148, 0.0202, 0.0256, 0.031)


def test_joints_that_meet_keep_their_order() -> None:
    design = wheel_design(read_study(built_in_study().with_name("honeycomb.toml")))
    assert design.lattice is not None
    mesh = build_planar_mesh(design, element_size=8e-3)
    joints = np.unique(mesh.cells[mesh.cell_tags == mesh.parts["lattice_joints"]])
    across, height = mesh.points[joints].T
    middle = joints[(np.abs(across) < design.lattice.thickness) & (height < 0.0)]
    lower = middle[(mesh.points[middle, 1] < -0.07) & (mesh.points[middle, 1] > -0.093)]
    upper = middle[(mesh.points[middle, 1] > -0.07) & (mesh.points[middle, 1] < -0.047)]
    assert len(lower)
    assert len(upper)

    def pressed(inner_contact: bool) -> WheelResult:
        case = WheelLoadCase(
            orientation_deg=0.0, deflections=DEFLECTIONS, inner_contact=inner_contact, keep_points=True
        )
        return solve_section(mesh, design, case)

    def order(result: WheelResult) -> float:
        """Height of the upper joint's lowest node over the lower one's highest at the end [m]."""
        z = mesh.points[:, 1] + result.points[-1].displacement[:, 1]
        return float(z[upper].min() - z[lower].max())

    held, free = pressed(True), pressed(False)
    assert -0.5 * design.lattice.thickness < order(held)
    assert held.curve.columns["inner_penetration_m"].max() < 0.5 * design.lattice.thickness
    assert order(free) < -design.lattice.thickness
    assert free.curve.load[-1] < held.curve.load[-1] / 3.0
