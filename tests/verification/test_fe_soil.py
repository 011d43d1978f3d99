"""Soil under the solid model and under the plates.

Claims: a flat plate of Bekker's test carries k z^n A, a tilted one the same on its level area; with n = 1 a block
with its flanks is carried as Archimedes says; the tangent is the derivative of the force; a wheel with grousers at rest
carries the same by both models, which share no code, to 0.5 % (0.2 found; 1 without the plates' level part); soil as
hard as rock is rigid ground. Sources: Bekker (1969) as docs/theory/soil.md 11.1 has it; each model by the other.
Negative control: half the modulus carries less.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround, press
from contracts.errors import InputError
from contracts.hub_travel import HubTravel, Way
from contracts.materials import TI_6AL_4V
from geometry.build import build_mesh
from geometry.wheel import WheelDesign, exomars_hoops
from reference_fe import dolfinx_api as api
from reference_fe.contact.obstacle import ObstacleTerm
from reference_fe.contact.obstacles import HalfRoundRock
from reference_fe.contact.soil_ground import SoilContact
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.arc_length import ArcLength, follow_path
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.pressed import solve_wheel
from soil.soil import soil_named

MODULUS, EXPONENT = 2.5e6, 1.1
SOIL = soil_named("ding2011")
LAW = (SOIL.modulus(0.12), SOIL.exponent)
DEFLECTIONS = (5e-3, 10e-3)
ORIENTATION = 15.0


def plate(
    tilt: float = 0.0, soil: tuple[float, float] = (MODULUS, EXPONENT), faces: tuple[str, ...] = ("z0",)
) -> tuple[ObstacleTerm, int]:
    """A block of 1 m whose lower face, at z = 0 about the origin, stands on soil tilted about y [rad]."""
    domain = Domain.from_tagged(block_mesh((2, 2, 1), lambda X: X - [0.5, 0.5, 0.0]))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    contact = SoilContact(
        faces=faces,
        normal=(math.sin(tilt), 0.0, math.cos(tilt)),
        along=(math.cos(tilt), 0.0, -math.sin(tilt)),
        distance_at_touch=0.0,
        stiffness=1.0,
        modulus=soil[0],
        exponent=soil[1],
    )
    return contact.build(domain, V), int(V.dofmap.index_map.size_global * 3)


def pressed(term: ObstacleTerm, u: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Force vector and dense stiffness."""
    batch = term.evaluate(u, 0.0)
    force, stiffness = np.zeros_like(u), np.zeros((len(u), len(u)))
    for nodes, f, k in zip(batch.nodes, batch.force, batch.stiffness, strict=True):
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        force[rows] += f.ravel()
        stiffness[np.ix_(rows, rows)] += k.reshape(len(rows), -1)
    return force, stiffness


def test_a_plate_carries_what_bekkers_law_says() -> None:
    term, n = plate()
    term.set_control(0.012)
    force, _ = pressed(term, np.zeros(n))
    assert force[2::3].sum() == pytest.approx(MODULUS * 0.012**EXPONENT, rel=1e-12)
    assert not term.augment()
    softer, _ = plate(soil=(0.5 * MODULUS, EXPONENT))
    softer.set_control(0.012)
    assert pressed(softer, np.zeros(n))[0][2::3].sum() == pytest.approx(0.5 * force[2::3].sum(), rel=1e-12)


def test_a_tilted_plate_is_pressed_on_its_level_area() -> None:
    """n = 1: mean depth times the level area cos(tilt)."""
    tilt, rise = 0.1, 0.3
    term, n = plate(tilt, (MODULUS, 1.0))
    term.set_control(rise)
    pressed(term, np.zeros(n))
    assert not term.augment()
    normal = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    assert term.resultant() @ normal == pytest.approx(MODULUS * rise * math.cos(tilt), rel=1e-12)
    assert np.abs(np.cross(term.resultant(), normal)).max() < 1e-6 * MODULUS


@pytest.mark.parametrize("tilt", [-0.3, 0.0, 0.6])
def test_with_an_exponent_of_one_it_is_archimedes(tilt: float) -> None:
    """A block of 1 m^3 wholly below the surface: k at its middle, however deep; what looks up takes from it."""
    for depth in (1.5, 3.0):
        term, n = plate(tilt, (MODULUS, 1.0), ("z0", "z1", "x0", "x1"))
        term.set_control(depth)
        pressed(term, np.zeros(n))
        assert not term.augment()
        normal = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
        np.testing.assert_allclose(term.resultant(), MODULUS * normal, atol=1e-9 * MODULUS)
        middle = np.array([0.0, 0.0, 0.5])
        np.testing.assert_allclose(term.moment(), np.cross(middle, MODULUS * normal), atol=1e-9 * MODULUS)


def test_a_face_that_goes_down_is_pressed_by_its_new_depth_on_the_same_area() -> None:
    term, n = plate()
    term.set_control(0.012)
    u = np.zeros(n)
    before = pressed(term, u)[0][2::3].sum()
    u[3 * np.unique(term.couplings()) + 2] = -0.002
    assert pressed(term, u)[0][2::3].sum() == pytest.approx(before * (0.014 / 0.012) ** EXPONENT, rel=1e-12)
    assert not term.augment()


def test_the_tangent_is_the_derivative_of_the_force() -> None:
    term, n = plate(0.02)
    term.set_control(0.05)
    u = 1e-3 * np.random.default_rng(3).standard_normal(n)
    pressed(term, u)
    assert term.augment()
    assert not term.augment()
    direction, h = np.random.default_rng(4).standard_normal(n), 1e-7
    ahead, behind = (pressed(term, u + k * h * direction)[0] for k in (1, -1))
    _, stiffness = pressed(term, u)
    np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-9 * MODULUS)
    np.testing.assert_allclose(stiffness @ direction, -(ahead - behind) / (2 * h), atol=1e-6 * MODULUS)


def test_what_a_failed_increment_goes_back_to_are_its_level_parts_too() -> None:
    term, n = plate(0.02)
    term.set_control(0.05)
    u = 1e-3 * np.random.default_rng(3).standard_normal(n)
    before, kept = pressed(term, u)[0], term.state()
    assert term.augment()
    assert np.abs(pressed(term, u)[0] - before).max() > 1e-4 * np.abs(before).max()
    term.restore(kept)
    np.testing.assert_array_equal(pressed(term, u)[0], before)


def test_soil_is_followed_along_no_path() -> None:
    """Its level parts would stay those of the beginning."""
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X))
    soil = SoilContact(faces=("z0",), normal=(0.0, 0.0, 1.0), distance_at_touch=0.0, modulus=MODULUS, exponent=EXPONENT)
    problem = StaticProblem(domain, {"body": TI_6AL_4V}, [Support(faces=("z1",))], contact=soil)
    with pytest.raises(InputError, match="or soil"):
        list(follow_path(NewtonSolver(problem, NewtonSettings()), ArcLength(first=1e-3), []))


def test_what_soil_does_not_know_is_refused() -> None:
    given = {
        "faces": ("z0",),
        "normal": (0.0, 0.0, 1.0),
        "distance_at_touch": 0.0,
        "modulus": LAW[0],
        "exponent": LAW[1],
    }
    for odd in ({"friction": 0.3}, {"obstacle": HalfRoundRock(radius=0.1)}):
        with pytest.raises(InputError, match="presses as a plane"):
            SoilContact(**given | odd)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="above zero"):
        SoilContact(**given | {"modulus": 0.0})  # type: ignore[arg-type]
    with pytest.raises(InputError, match="leaves a rut"):
        WheelLoadCase(orientation_deg=0.0, deflections=DEFLECTIONS, soil=LAW, unload=True)
    wheel = build_ancf_wheel(design(), element_size=40e-3, axial_size=60e-3)
    with pytest.raises(InputError, match="leave the friction out"):
        WheelOnGround(wheel, 0.0, friction=0.3, soil=LAW)
    travel = HubTravel.along(way=Way.FORE_AFT, start=5e-3, steps=(1e-3,))
    with pytest.raises(InputError, match="leave the friction out"):
        WheelOnGround(wheel, 0.0, friction=0.3, travel=travel, soil=LAW)


def design() -> WheelDesign:
    """Three hoops with grousers."""
    hoops = exomars_hoops()
    inner = replace(hoops.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, phase=0.0)
    return replace(hoops, spring_sets=(inner,))


@cache
def solid(soil: tuple[float, float] | None) -> NDArray[np.float64]:
    """Loads of the solid model [N]."""
    mesh = build_mesh(design(), element_size=20e-3, axial_size=20e-3, edge_size=6e-3, parts="flexible")
    case = WheelLoadCase(orientation_deg=ORIENTATION, deflections=DEFLECTIONS, soil=soil)
    return solve_wheel(mesh, design().materials, case).curve.load[1:]


def plates(soil: tuple[float, float] | None) -> NDArray[np.float64]:
    """Loads of the plates [N]."""
    wheel = build_ancf_wheel(design(), axial_size=18e-3)
    problem = WheelOnGround(wheel, math.radians(ORIENTATION), soil=soil)
    return np.array([state.load for state in press(problem, DEFLECTIONS)])


@pytest.mark.slow
def test_both_models_stand_alike_on_soil_and_softer_than_on_rigid_ground() -> None:
    found = plates(LAW)
    assert np.abs(found / solid(LAW) - 1.0).max() < 5e-3
    assert (solid(LAW) < 0.9 * solid(None)).all()


@pytest.mark.slow
def test_soil_as_hard_as_rock_is_rigid_ground() -> None:
    hard = (1e11, 1.0)
    assert solid(hard) == pytest.approx(solid(None), rel=5e-3)
    assert plates(hard) == pytest.approx(plates(None), rel=5e-3)
