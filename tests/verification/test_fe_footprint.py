"""Claim: the footprint found from displacements is the run's own: its load, its moments, its map on any fine mesh.

A wheel of four hoops, 6 mm deep, turned by 20 degrees so that it stands on no symmetric place.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.footprint import Footprint
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.wheel import WheelDesign, exomars_hoops
from reference_fe.contact.nodal_pressure import nodal_pressure
from reference_fe.contact.obstacle import ContactMethod
from reference_fe.contact.obstacles import HalfRoundRock
from reference_fe.contact.patch import contact_faces, facet_areas
from reference_fe.wheel.case import WheelLoadCase, WheelResult
from reference_fe.wheel.footprint import footprint, pressure_at_nodes
from reference_fe.wheel.pressed import solve_wheel
from reference_fe.wheel.problem import ground_contact

LOAD = 60.0
CASE = WheelLoadCase(orientation_deg=20.0, deflections=(2e-3, 4e-3), snapshot_loads=(LOAD,))
GRID = 8e-3 * np.arange(-12.0, 13.0)


def design() -> WheelDesign:
    hoops = exomars_hoops()
    springs = replace(hoops.spring_sets[1], bands=((-60e-3, 60e-3),), thickness=1e-3, count=4)
    return replace(hoops, tire=replace(hoops.tire, thickness=1e-3), spring_sets=(springs,))


@functools.cache
def solved(factor: float, half: bool = True) -> tuple[TaggedMesh, WheelResult]:
    mesh = build_mesh(design(), element_size=16e-3, axial_size=30e-3, factor=factor, half_width=half, parts="flexible")
    return mesh, solve_wheel(mesh, dict(design().materials), CASE)


@functools.cache
def found(factor: float, half: bool = True) -> Footprint:
    mesh, result = solved(factor, half)
    (snapshot,) = result.snapshots
    return footprint(mesh, snapshot.displacement, CASE, snapshot.deflection)


@pytest.mark.parametrize("half", [True, False])
def test_it_carries_the_runs_load_and_moment(half: bool) -> None:
    result, one = solved(1.0, half)[1], found(1.0, half)
    (snapshot,) = result.snapshots
    assert one.load == pytest.approx(snapshot.load, rel=1e-9)
    assert (one.force > 0.0).all()
    assert one.centre[1] == pytest.approx(0.0, abs=1e-6)
    columns, curve = result.curve.columns, result.curve
    moment = np.interp(snapshot.deflection, curve.deflection, columns["moment_left_Nm"])
    # without friction the ground's force is upright: its arm is the centre's way forward
    assert -one.load * one.centre[0] == pytest.approx(moment, rel=0.05, abs=1e-3)


def test_half_of_a_wheel_has_the_wholes() -> None:
    apart = found(1.0).spread(GRID, GRID) - found(1.0, half=False).spread(GRID, GRID)
    assert np.abs(apart).sum() < 0.01 * found(1.0).spread(GRID, GRID).sum()


@pytest.mark.long
def test_its_map_settles_as_the_mesh_is_refined() -> None:
    """Share of the load that lies elsewhere than on the finest mesh, around places 8 mm apart."""
    maps = [found(factor).spread(GRID, GRID) * 8e-3**2 for factor in (1.0, 2.0, 3.0)]
    elsewhere = [0.5 * np.abs(one - maps[-1]).sum() / LOAD for one in maps[:-1]]
    assert elsewhere[1] < 0.5 * elsewhere[0]
    assert elsewhere[1] < 0.1


def test_another_ground_or_method_is_refused() -> None:
    mesh, result = solved(1.0)
    (snapshot,) = result.snapshots
    for case in (
        replace(CASE, obstacle=HalfRoundRock(radius=20e-3)),
        replace(CASE, contact_method=ContactMethod.AUGMENTED_LAGRANGIAN),
        replace(CASE, contact_stiffness=None),
    ):
        with pytest.raises(InputError, match="footprint"):
            footprint(mesh, snapshot.displacement, case, snapshot.deflection)


def test_another_deflection_carries_another_load() -> None:
    """Negative control: a tenth of a millimetre further the same shape would carry a multiple."""
    mesh, result = solved(1.0)
    (snapshot,) = result.snapshots
    assert footprint(mesh, snapshot.displacement, CASE, snapshot.deflection + 1e-4).load > 3.0 * LOAD


def test_pressures_at_nodes_carry_the_load() -> None:
    """Each times the area that its node stands for, of half the wheel; nowhere negative."""
    mesh, result = solved(1.0)
    (snapshot,) = result.snapshots
    pressure = pressure_at_nodes(mesh, snapshot.displacement, CASE, snapshot.deflection)
    facets = contact_faces(mesh, ("tire_outer", "grouser_outer"))
    _, areas = facet_areas(mesh, facets, ground_contact(mesh, CASE).gauss_points)
    _, area = nodal_pressure(len(mesh.points), facets, areas, np.zeros_like(areas))
    assert 2.0 * float(pressure @ area) == pytest.approx(snapshot.load, rel=1e-9)
    assert pressure.min() == 0.0
    lowest = (mesh.points + snapshot.displacement)[pressure.argmax()]
    assert np.degrees(np.arctan2(lowest[0], -lowest[2])) == pytest.approx(20.0, abs=15.0)
