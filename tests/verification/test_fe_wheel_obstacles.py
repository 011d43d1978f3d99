"""Claim: a wheel on a step's edge, a rock or tilted ground has the limits that geometry demands.

Source: geometry. A step of no height and a rock of huge radius are the plane; a wheel that is its own mirror image, on
mirrored ground, is pushed to the other side with the same force; tilted ground presses on the side that it lifts.
Tolerances: a rock of radius R lies a^2 / (2 R) below its tangent plane at the end of a patch of half length a, at most
the chord a^2 = 2 R_w d of a wheel of radius R_w at deflection d: the load differs by R_w / R at most; a step of 1
micrometre, twice its height over the deflection; mirror images 1e-6 (Newton 1e-8).
Negative controls: a rock of 30 mm, a step of 2 mm, a wheel that is not its mirror image.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import TI_6AL_4V
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.planar import build_planar_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact.obstacle import ObstacleTerm
from reference_fe.contact.obstacles import Cleat, HalfRoundRock, Obstacle, Plane, StepEdge
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSolver
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.problem import wheel_problem

RISE = 0.003


@dataclass(frozen=True, slots=True, kw_only=True)
class Pressed:
    """Forces of the ground along its normal and forward [N]; centre of pressure, one component an axis [m]."""

    normal: float
    forward: float
    centre: NDArray[np.float64]


@functools.cache
def planar_mesh() -> TaggedMesh:
    return build_planar_mesh(exomars_hoops(), element_size=16e-3)


@functools.cache
def full_width_mesh() -> TaggedMesh:
    return build_mesh(exomars_hoops(), element_size=14e-3, axial_size=60e-3, parts="flexible", half_width=False)


@functools.cache
def press(obstacle: Obstacle, *, orientation: float = 0.0, camber: float = 0.0, planar: bool = True) -> Pressed:
    mesh = planar_mesh() if planar else full_width_mesh()
    case = WheelLoadCase(
        orientation_deg=orientation, deflections=(RISE,), obstacle=obstacle, camber_deg=camber, inner_contact=False
    )
    wheel = wheel_problem(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case)
    (state,) = [s for s in solve_increments(NewtonSolver(wheel.problem, case.newton), [RISE], []) if s.wanted]
    term = wheel.problem.surfaces.terms[0]
    assert isinstance(term, ObstacleTerm)
    points, pressure = term.points_and_pressure()
    force = state.contact_force
    assert np.linalg.norm(state.reaction + force) < 1e-6 * np.linalg.norm(force)
    return Pressed(
        normal=float(force @ wheel.normal),
        forward=float(force @ wheel.tangent),
        centre=pressure @ points / pressure.sum(),
    )


def test_a_rock_of_huge_radius_is_the_plane() -> None:
    plane, radius = press(Plane(), orientation=15.0), 500.0
    rock = press(HalfRoundRock(radius=radius), orientation=15.0)
    assert rock.normal != plane.normal
    assert rock.normal == pytest.approx(plane.normal, rel=exomars_hoops().tire.outer_radius / radius)
    assert abs(press(HalfRoundRock(radius=0.03), orientation=15.0).normal / plane.normal - 1.0) > 0.02


def test_a_step_of_no_height_is_the_plane() -> None:
    plane, height = press(Plane()), 1e-6
    flat = press(StepEdge(height=height, edge_radius=height))
    assert flat.normal == pytest.approx(plane.normal, rel=2.0 * height / RISE)
    assert abs(press(StepEdge(height=2e-3, edge_radius=1e-3)).normal / plane.normal - 1.0) > 0.05


def test_a_wide_cleat_is_the_plane_and_a_narrow_one_is_softer() -> None:
    """Its sides beyond the wheel; one beside the middle pushes back alike on either side."""
    plane = press(Plane())
    wide = press(Cleat(height=0.02, width=0.4, edge_radius=0.005))
    assert wide.normal == pytest.approx(plane.normal, rel=1e-9)
    ahead, behind = (press(Cleat(height=0.02, width=0.02, edge_radius=0.01, position=s)) for s in (0.02, -0.02))
    assert ahead.normal < 0.97 * plane.normal
    assert ahead.normal == pytest.approx(behind.normal, rel=1e-6)
    assert ahead.forward == pytest.approx(-behind.forward, rel=1e-6)
    assert ahead.forward < -0.01 * ahead.normal


def test_a_rock_ahead_pushes_back_and_one_behind_forward() -> None:
    ahead, behind = (press(HalfRoundRock(radius=0.03, position=s)) for s in (0.02, -0.02))
    assert ahead.forward < -0.01 * ahead.normal
    assert ahead.normal == pytest.approx(behind.normal, rel=1e-6)
    assert ahead.forward == pytest.approx(-behind.forward, rel=1e-6)
    turned = press(HalfRoundRock(radius=0.03, position=-0.02), orientation=10.0)  # not the mirror image
    assert abs(turned.normal / ahead.normal - 1.0) > 1e-3


def test_camber_presses_on_the_lifted_side() -> None:
    left, right = (press(Plane(), camber=c, planar=False) for c in (4.0, -4.0))
    assert left.centre[1] > 0.02
    assert left.centre[1] == pytest.approx(-right.centre[1], rel=1e-5)
    level = press(Plane(), planar=False)
    assert abs(level.centre[1]) < 1e-4
