"""The ANCF wheel bent in its plane alone against planar finite elements in plane strain: same wheel, nothing fitted.

Both models of one physics in two dimensions, contact of springs with the rim included, so that what differs in three
(curling across strips, the rim's bending along the axle) plays no part. Negative control: welds' ends that cannot turn.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.planar import planar
from ancf_reduced.wheel.static import WheelOnGround, press
from geometry.planar import build_planar_mesh
from geometry.wheel import WheelDesign, exomars, exomars_hoops
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.section import solve_section

DEFLECTIONS = (10e-3, 20e-3, 30e-3)
LEAVES = 0.005


def plates(design: WheelDesign) -> AncfWheel:
    return planar(build_ancf_wheel(design, axial_size=0.2))


def excess(
    wheel: AncfWheel, design: WheelDesign, orientation: float, deflections: tuple[float, ...] = DEFLECTIONS
) -> NDArray[np.float64]:
    """Load of the plates over that of planar finite elements, minus one."""
    mesh = build_planar_mesh(design, element_size=8e-3)
    case = WheelLoadCase(
        orientation_deg=orientation,
        deflections=deflections,
        maximum_load=1e4,
        transverse_constraint=dict.fromkeys(mesh.parts, 1.0),
    )
    curve = solve_section(mesh, design, case).curve
    states = list(press(WheelOnGround(wheel, math.radians(orientation)), deflections))
    assert all(state.negative == 0 for state in states)
    return np.array([state.load / curve.load_at(state.deflection) - 1.0 for state in states])


@pytest.mark.parametrize(
    ("design", "orientation", "limit"),
    [(exomars(), 15.0, LEAVES), (exomars_hoops(), 30.0, 0.01)],
    ids=["leaves", "hoops"],
)
def test_load_is_that_of_planar_finite_elements(design: WheelDesign, orientation: float, limit: float) -> None:
    """Within 0.5 % of leaves, 1 % of hoops at every point; springs lie on the rim at the last ones."""
    wheel = plates(design)
    assert wheel.basis.shape[1] < 1000
    assert np.abs(excess(wheel, design, orientation)).max() < limit


def test_control_welds_that_cannot_turn_are_caught() -> None:
    """Clamped welds' ends: too stiff from the beginning, beyond the limit of leaves."""
    wheel = plates(exomars())
    clamped = replace(wheel, ties=replace(wheel.ties, turning=1e3 * wheel.ties.turning), held=1e3 * wheel.held)
    assert excess(clamped, exomars(), 15.0, DEFLECTIONS[:1])[0] > 1.5 * LEAVES
