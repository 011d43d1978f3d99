"""Claim: a strip whose thickness varies bends as its beam does, and has the area of its mean thickness.

Source: curved beams as many short straight ones, each with its own thickness (tests/lattice_frame.py). Strip and beam
differ by the give of the weld's end, of first order in thickness over length: it must halve with the thickness, and
0.5 % of the rest is allowed (measured: 0.2 %). Volumes agree with length times mean thickness to 2e-6.
Negative controls: an even strip of the same mean thickness is another spring; a wrong middle is caught.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError, MeshError
from geometry.build import build_mesh
from geometry.checks import check_matches_design, check_mesh
from geometry.closed_form import closed_form_volume
from geometry.measures import mesh_volume
from geometry.parts import SpringSet
from geometry.planar import build_planar_mesh
from geometry.springs import spring_leg
from geometry.wheel import WheelDesign, exomars_hoops
from reference_fe.cells.discretisation import Discretisation
from reference_fe.cells.orientation import curved_axis_first
from reference_fe.material.stored_energy import StoredEnergy
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from tests.lattice_frame import beam

BASE = replace(exomars_hoops(), grousers=None, cone=None, impact_springs=None, inner_hub=None)
GAP = (BASE.outer_hub.outer_radius, BASE.tire.inner_radius)
THICK = {"thickness": 1.6e-3, "thickness_middle": 1.0e-3, "thickness_hub": 0.6e-3}
SHAPES = {"arc": (), "spline": ((0.3, 0.45), (0.7, 0.5))}
SHIFT = 1e-6
PIECES = 16


def springs(shape: str, factor: float = 1.0, **changes: float | None) -> SpringSet:
    sheet: dict[str, float | None] = {name: factor * value for name, value in THICK.items()}
    return SpringSet(
        name="leaves",
        count=1,
        bands=((-0.06, 0.06),),
        shape="arc" if shape == "arc" else "spline",
        points=SHAPES[shape],
        weld_length=8e-3,
        **(sheet | changes),  # type: ignore[arg-type]
    )


def wheel(one: SpringSet) -> WheelDesign:
    return replace(BASE, spring_sets=(one,))


@functools.cache
def solid_stiffness(one: SpringSet) -> float:
    """Of one leaf between rigid rings that are shifted against each other [N/m^2]."""
    design = wheel(one)
    mesh = curved_axis_first(build_planar_mesh(design, element_size=3e-3))
    rings = [
        Support(parts=("outer_hub",), components=(0, 1)),
        Support(parts=("tire",), components=(0, 1), value=(SHIFT, SHIFT)),
    ]
    flexible = {"leaves": one.material}
    rule = Discretisation(gauss_points=(2, 3))
    problem = StaticProblem(Domain.from_tagged(mesh), flexible, rings, discretisation=rule)
    problem.set_control(1.0)
    assert NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-7)).solve().converged
    return 2.0 * StoredEnergy(problem).value() / SHIFT**2 / 0.12


def beam_stiffness(one: SpringSet) -> float:
    """The same of short straight beams along the centreline."""
    leg = spring_leg(one, GAP, 0.0, 1)
    at = np.linspace(0.0, 1.0, len(leg.points))
    thickness = one.thickness_at(0.5 * (at[1:] + at[:-1]))
    modulus = one.material.young_modulus / (1.0 - one.material.poisson_ratio**2)
    K = np.zeros((3 * len(at),) * 2)
    for k, t in enumerate(thickness):
        K[3 * k : 3 * k + 6, 3 * k : 3 * k + 6] += beam(leg.points[k + 1] - leg.points[k], modulus, float(t))
    u = np.zeros(len(K))
    u[:2] = 1.0
    free = np.arange(3, len(K) - 3)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], -K[np.ix_(free, [0, 1])].sum(axis=1))
    return float(u @ K @ u)


def beyond_the_beam(one: SpringSet) -> float:
    return solid_stiffness(one) / beam_stiffness(one) - 1.0


@pytest.mark.parametrize("shape", SHAPES)
def test_a_tapered_leaf_bends_as_its_beam(shape: str) -> None:
    thick, thin = (beyond_the_beam(springs(shape, factor)) for factor in (1.0, 0.5))
    assert abs(thick) < 0.06
    assert abs(2.0 * thin - thick) < 0.005


@pytest.mark.parametrize("shape", SHAPES)
def test_an_even_leaf_is_another_spring(shape: str) -> None:
    """Negative control: the mean thickness alone does not say how a leaf bends."""
    leaf = springs(shape)
    even = replace(leaf, thickness=leaf.mean_thickness, thickness_middle=None, thickness_hub=None)
    assert abs(solid_stiffness(even) / beam_stiffness(leaf) - 1.0) > 0.1


@pytest.mark.parametrize("shape", SHAPES)
def test_volume_of_a_solid_leaf(shape: str) -> None:
    design = wheel(springs(shape))
    mesh = build_mesh(design, element_size=8e-3, axial_size=0.06, thickness_elements=2)
    check_mesh(mesh)
    exact = closed_form_volume(design)["leaves"]
    assert mesh_volume(mesh)["leaves"] == pytest.approx(exact, rel=2e-6)
    with pytest.raises(MeshError, match="volume of leaves"):
        check_matches_design(mesh, wheel(springs(shape, thickness_middle=1.005e-3)), 1e-4)


def test_a_wedge_is_what_two_ends_make() -> None:
    wedge = springs("arc", thickness_middle=None)
    assert wedge.thickness_at(np.array([0.0, 0.25, 0.5, 1.0])) == pytest.approx([1.6e-3, 1.35e-3, 1.1e-3, 0.6e-3])
    assert wedge.mean_thickness == pytest.approx(1.1e-3)
    bulge = springs("arc", thickness_hub=None, thickness_middle=2e-3)
    assert (bulge.hub_thickness, bulge.largest_thickness) == pytest.approx((1.6e-3, 2e-3))


def test_what_no_strip_is_is_refused() -> None:
    with pytest.raises(InputError, match="where it is thinnest") as error:
        springs("arc", thickness_middle=0.01e-3)
    assert error.value.key == "thickness_middle"
    with pytest.raises(InputError, match="crosses the hub or the rim"):
        wheel(springs("arc", thickness_middle=4e-3))  # it thickens faster than its arc leaves the rim
    with pytest.raises(InputError, match="overlap each other"):
        wheel(replace(springs("arc"), count=40))
