"""Claim: paths are followed over limit points and branches, and a wheel that does not stand is told, with its mode.

Source: hinged cylindrical roof, h 6.35 mm, under a load at its centre (Sze, Liu & Lo 2004, table of case 38d, in
contracts/published/sze38d_hinged_roof_h6.35_isotropic.csv): snaps through and back. Tolerances beside the tests.
Controls: a roof 2 % thicker carries too much; an arch's symmetric path carries more than the one that branches off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, takewhile

import numpy as np
import pytest
from scipy.sparse import csc_array, csr_array, eye_array

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.wheel.mesh import build_ancf_wheel
from ancf_reduced.wheel.path import Contacts, Linear, PathPoint, follow
from ancf_reduced.wheel.stability import press_along, press_buckled, unstable_mode
from ancf_reduced.wheel.static import Equilibrium, WheelOnGround, press
from contracts.errors import ConvergenceError, InputError
from contracts.published import published_table
from contracts.terrain_ridges import HalfRound
from geometry.wheel import exomars_hoops
from tests.thin_plate_paths import Array, grid, metal, mirror
from tests.unit.test_ancf_thin_plates import arc

FULL_LOAD, RISE = 3000.0, 30.0
"""P of the table [N], and the deflection its points are scaled by [mm]."""
ROCK = HalfRound(radius=20e-3, base=-20e-3, position=0.0, yaw=0.0)


@dataclass(frozen=True, eq=False)
class Loaded:
    """Plates under a dead load that grows with the parameter, as `follow` takes them."""

    plates: ThinPlates
    kept: np.ndarray
    force: Array

    @cached_property
    def basis(self) -> csc_array:
        return csc_array(eye_array(self.plates.size, format="csc")[:, np.flatnonzero(self.kept.ravel())])

    @cached_property
    def places(self) -> csr_array:
        of_node = np.zeros(self.plates.reference.shape, dtype=bool)
        of_node[:, 0] = True
        return csr_array(self.basis[np.flatnonzero(of_node.ravel())])

    def moved(self, free: Array) -> Array:
        return np.asarray((self.basis @ free).reshape(self.plates.reference.shape))

    def linearised(self, free: Array, parameter: float, mixed: list[Array]) -> Linear:
        energy, local, blocks = self.plates.terms(self.plates.reference + self.moved(free), mixed)
        T, push = self.basis, self.basis.T @ self.force.ravel()
        none = np.zeros(0)
        return Linear(
            residual=T.T @ self.plates.gathered(local).ravel() - parameter * push,
            tangent=csc_array(T.T @ self.plates.assembled(blocks) @ T),
            rate=-push,
            energy=energy,
            contacts=Contacts(
                gaps=none, rate=none, slopes=csr_array((0, len(push))), stiffness=none, touching=none > 0.0
            ),
        )

    def extrapolated(self, free: Array, step: Array, gaps: Array, linear: Linear) -> list[Array]:
        return self.plates.stresses(self.plates.reference + self.moved(free), self.moved(step))

    def start(self) -> tuple[Array, float, list[Array]]:
        zeros = np.zeros(self.basis.shape[1])
        return zeros, 0.0, self.extrapolated(zeros, zeros, zeros, None)  # type: ignore[arg-type]


def roof(plates: int, thickness: float = 6.35) -> Loaded:
    """A quarter of the roof, in N and mm; the table's parameters are in its file."""
    layers = [[Layer(material=metal(3102.75, 0.3), thickness=thickness)]]
    body = ThinPlates(*arc(plates, plates, 2540.0, 0.1, 254.0), layers)
    i, j = grid(plates, plates)
    kept = np.ones(body.reference.shape, dtype=bool)
    mirror(kept, i == 0, 0, 1)
    mirror(kept, j == 0, 1, 2)
    kept[i == plates, 0] = kept[i == plates, 2] = False  # a hinge: its line stays
    force = np.zeros(body.reference.shape)
    force[0, 0, 2] = -0.25 * FULL_LOAD
    return Loaded(body, kept, force)


def path(body: Loaded, way: float) -> tuple[list[PathPoint], Array]:
    """Points up to the full load, and (P, W) of them, scaled."""
    points = list[PathPoint]()
    for point in follow(body, body.start(), way):
        points.append(point)
        if point.parameter > 1.03:
            return points, np.array([(p.parameter, -body.moved(p.free)[0, 0, 2] / RISE) for p in points])
        assert len(points) < 200
    raise AssertionError("a path without end ended")


def off_the_table(track: Array, below: float) -> float:
    """Largest distance of published points, loads up to ``below``, to a polyline of (P, W)."""
    table = published_table("sze38d_hinged_roof_h6.35_isotropic")
    track = np.vstack([[0.0, 0.0], track])
    at, along = track[:-1], np.diff(track, axis=0)
    found = list[float]()
    for load, way in zip(table["P_over_Pmax"], table["minus_W_C"], strict=True):
        off = np.array([load, way / RISE]) - at
        share = np.clip((off * along).sum(1) / (along * along).sum(1), 0.0, 1.0)
        if load <= below:
            found.append(float(np.linalg.norm(share[:, None] * along - off, axis=1).min()))
    return max(found)


def limits(loads: Array) -> tuple[float, float]:
    """First peak of the load and the lowest one behind it."""
    return float(loads[np.argmax(np.diff(loads) < 0.0)]), float(loads.min())


def test_a_hinged_roof_snaps_through_and_back_along_the_published_path() -> None:
    """Peak to 0.5 %, trough to 1.5 %; within 0.005 of the full load or 30 mm up to 0.35 of it, 0.015 at its end."""
    points, track = path(roof(8), 1.0)
    peak, trough = limits(np.array(published_table("sze38d_hinged_roof_h6.35_isotropic")["P_over_Pmax"]))
    assert limits(track[:, 0])[0] == pytest.approx(peak, rel=0.005)
    assert limits(track[:, 0])[1] == pytest.approx(trough, rel=0.015)
    assert off_the_table(track, 0.35) < 0.005
    assert off_the_table(track, 1.1) < 0.015
    assert (np.diff(track[:, 1]) < 0.0).any(), "snaps back"
    assert [p.negative > 0 for p in points] == [p.rate < 0.0 for p in points]
    assert sum(p.solves for p in points) < 4 * len(points)


def test_control_a_roof_two_per_cent_thicker_carries_too_much() -> None:
    """Its peak lies more than four tolerances above the table's."""
    peak, _ = limits(np.array(published_table("sze38d_hinged_roof_h6.35_isotropic")["P_over_Pmax"]))
    assert limits(path(roof(8, 1.02 * 6.35), 1.0)[1][:, 0])[0] > 1.02 * peak


def arch(position: float = 0.0) -> WheelOnGround:
    """A rim of titanium on three stiff leaves that ends on a rock midway between two of them: an arch."""
    base = exomars_hoops()
    leaves = replace(base.spring_sets[0], name="springs", count=3, phase=0.0, bands=((-60e-3, 60e-3),), thickness=2e-3)
    design = replace(base, name="arch", spring_sets=(leaves,), grousers=replace(base.grousers, count=3))
    wheel = build_ancf_wheel(design, element_size=8e-3, axial_size=60e-3, half_width=True, ground_spacing=0.5e-3)
    return WheelOnGround(wheel, math.pi / 3.0, terrain=replace(ROCK, position=position))


@pytest.fixture(scope="module")
def pressed() -> tuple[WheelOnGround, list[Equilibrium]]:
    """The arch and its symmetric path, 8 to 32 mm."""
    problem = arch()
    return problem, list(press(problem, [4e-3 * k for k in range(2, 9)]))


def test_an_arch_on_a_rock_tells_that_it_does_not_stand(pressed: tuple[WheelOnGround, list[Equilibrium]]) -> None:
    """One mode, from 26 mm on; the rim sways."""
    problem, states = pressed
    assert [s.negative for s in states] == [0, 0, 0, 0, 0, 1, 1]
    assert unstable_mode(problem, states[0]) is None
    mode = unstable_mode(problem, states[-1])
    assert mode is not None
    assert mode.growth > 0.0
    assert mode.part == "tire"
    assert abs(mode.angle_deg - 60.0) < 60.0, "between the two leaves"
    sway = problem.wheel.coordinates(mode.shape) - problem.wheel.plates.reference
    assert np.isfinite(sway).all()


@pytest.mark.long
def test_the_branch_of_an_arch_carries_less_and_stands(pressed: tuple[WheelOnGround, list[Equilibrium]]) -> None:
    """Released equilibria; 1 to 6 % below the symmetric path beyond 28 mm."""
    problem, states = pressed
    found = list(islice(press_buckled(problem, states[3], states[5], 6e-3), 14))
    beyond = [s for s in found if 28e-3 < s.deflection < 34e-3]
    assert len(beyond) >= 2
    symmetric = np.interp([s.deflection for s in beyond], [s.deflection for s in states], [s.load for s in states])
    for state, load in zip(beyond, symmetric, strict=True):
        assert state.negative == 0
        assert 0.01 < 1.0 - state.load / load < 0.06


def test_a_rock_off_the_middle_makes_an_arch_sway_over_a_limit_of_its_load() -> None:
    """The load's peak lies below that of the symmetric path; before it the same as `press` finds."""
    problem = arch(1e-3)
    first = next(press(problem, [8e-3]))
    found = list(takewhile(lambda s: s.deflection < 34e-3, press_along(problem, first, 2e-2)))
    loads = [s.load for s in found]
    assert max(loads) < 203.0
    assert loads[-1] < max(loads)
    early = next(s for s in found if s.deflection > 15e-3)
    again = next(press(problem, [early.deflection]))
    assert early.load == pytest.approx(again.load, rel=1e-6)
    assert early.energy == pytest.approx(again.energy, rel=1e-6)


def test_paths_that_cannot_be_followed_are_told(pressed: tuple[WheelOnGround, list[Equilibrium]]) -> None:
    """An arc that is not positive, a wheel that carries nothing, a pair that does not hold a branch between it."""
    problem, states = pressed
    with pytest.raises(InputError, match="arc length"):
        next(press_along(problem, states[0], 0.0))
    with pytest.raises(InputError, match="load at the start"):
        next(press_along(problem, problem.unloaded(), 1e-2))
    with pytest.raises(InputError, match="negative eigenvalues"):
        next(press_buckled(problem, states[0], states[1], 1e-2))


def test_a_path_that_cannot_be_found_again_keeps_its_last_point() -> None:
    """One Newton step a point is not enough for a tolerance that no rounding meets."""
    body = roof(2)
    with pytest.raises(ConvergenceError, match="no equilibrium found along the path"):
        next(follow(body, body.start(), 1.0, tolerance=1e-40))
