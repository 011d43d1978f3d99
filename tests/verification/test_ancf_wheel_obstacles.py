"""The ANCF wheel under camber and on a rock askew against the solid model: same wheel, nothing fitted.

Three hoops with grousers, which camber bends and twists. Negative control: grousers as sheets, whose flanks are held.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround, press
from contracts.curves import StiffnessCurve
from contracts.terrain import Plane, Terrain
from contracts.terrain_ridges import HalfRound
from geometry.build import build_mesh
from geometry.wheel import WheelDesign, exomars_hoops
from reference_fe.contact import obstacles
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.pressed import solve_wheel

CAMBER = 8.0
DEFLECTIONS = (6e-3,)


def design() -> WheelDesign:
    hoops = exomars_hoops()
    inner = replace(hoops.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    return replace(hoops, spring_sets=(inner,))


@pytest.fixture(scope="module")
def wheel() -> AncfWheel:
    return build_ancf_wheel(design(), axial_size=10e-3, half_width=False, ground_spacing=0.5e-3)


def solid(obstacle: obstacles.Obstacle, camber: float = 0.0) -> StiffnessCurve:
    mesh = build_mesh(
        design(), element_size=20e-3, axial_size=20e-3, edge_size=4e-3, parts="flexible", half_width=False
    )
    case = WheelLoadCase(orientation_deg=15.0, deflections=DEFLECTIONS, obstacle=obstacle, camber_deg=camber)
    return solve_wheel(mesh, design().materials, case).curve


def excess(wheel: AncfWheel, terrain: Terrain, curve: StiffnessCurve, camber: float = 0.0) -> np.ndarray:
    problem = WheelOnGround(wheel, math.radians(15.0), terrain=terrain, camber=math.radians(camber))
    return np.array([e.load / curve.load_at(e.deflection) - 1.0 for e in press(problem, DEFLECTIONS)])


@pytest.mark.long
def test_load_on_a_rock_askew(wheel: AncfWheel) -> None:
    """Within 2 % of the solid, whose coarse mesh and points of contact bear a part of it."""
    rock = obstacles.HalfRoundRock(radius=30e-3, position=10e-3, yaw_deg=30.0)
    askew = HalfRound(radius=30e-3, position=10e-3, yaw=math.radians(30.0), base=-30e-3)
    assert np.abs(excess(wheel, askew, solid(rock))).max() < 0.02


@pytest.mark.long
def test_load_under_camber_and_control_grousers_that_do_not_twist(wheel: AncfWheel) -> None:
    """Within 2 %; with grousers as sheets the same wheel is far off."""
    curve = solid(obstacles.Plane(), CAMBER)
    assert np.abs(excess(wheel, Plane(), curve, CAMBER)).max() < 0.02
    plates = wheel.plates
    layers = [tuple(_sheet(layer) for layer in each) for each in plates.layers]
    sheets = replace(wheel, plates=ThinPlates(plates.reference, plates.plates, plates.sizes, layers))
    assert excess(sheets, Plane(), curve, CAMBER).max() > 0.03


def _sheet(layer: Layer) -> Layer:
    return replace(layer, rib=0.0, foot=0.0)
